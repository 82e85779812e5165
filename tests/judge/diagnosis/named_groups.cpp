// Each group of faults, by some that are planted in the scene that is judged fastest: named first, and by its plane.
#include "tests/catch.hpp"
#include "tests/judge/diagnosis/planted.h"

namespace trueshade::testing {

namespace {

/// On the first ground of the scene on which the fault changes 100 pixels.
void check_named(std::string_view name, std::string_view scene, Format target, Strategy strategy) {
  for (const Plant& plant : plants()) {
    if (plant.name != name) continue;
    for (int variant = 0; variant < plant.variants; ++variant) {
      const Ground ground{std::string(scene), std::string(plant.presets[0]), strategy, target, 0};
      const PlantedTry t = planted_try(ground, plant, variant);
      if (t.changed < 100) continue;
      CAPTURE(name, variant, t.changed, t.found);
      CHECK(t.convicted);
      CHECK(t.first);
      return;
    }
  }
  FAIL("no try of " << name << " changes 100 pixels of " << scene);
}

void check_all(std::initializer_list<std::string_view> names, std::string_view scene = "cornell") {
  for (const std::string_view name : names) check_named(name, scene, Format::rgba8, Strategy::deferred_loop);
}

}  // namespace

TEST_CASE("An object that is moved, turned, of another size, wound wrongly or incomplete is named with its numbers") {
  check_all({"an object moved", "an object turned", "an object of another size", "an object wound the other way",
             "an object of another material", "triangles missing"});
}

TEST_CASE("A wrong vertex is named with the way that it is moved") { check_all({"a vertex wrong"}); }

TEST_CASE("A camera that is elsewhere or sees another angle, and a viewport that is another, are named") {
  check_all({"the camera moved", "the eye moved", "the camera turned", "another field of view", "another near plane",
             "jitter below half a pixel", "another viewport", "a viewport elsewhere"});
}

TEST_CASE("Edges that are means of samples are named") { check_all({"edges as means of samples"}); }

TEST_CASE("One light of another range, cone or attenuation, and all lights elsewhere, are named") {
  check_all({"one light's range", "one light's cone", "one light's attenuation", "light positions as halves"});
}

TEST_CASE("Positions by another near plane, and normals and alpha that are decoded wrongly, are named") {
  check_all({"positions rebuilt by another near plane", "positions stored by another near plane",
             "normals written as unorm, read as snorm", "normals written as snorm, read as unorm",
             "normals by the model matrix", "alpha encoded as sRGB"});
}

TEST_CASE("Maps that are read wrongly are named") {
  check_all({"a normal map's green turned", "a normal map decoded as sRGB", "one object's colour"});
}

TEST_CASE("Planes of what materials reflect and emit that are encoded wrongly are named") {
  check_all({"specular colours encoded as sRGB", "specular colours as BGR", "specular colours with a gain",
             "shininess in the plane off", "emission encoded as sRGB", "emission with a gain"});
}

TEST_CASE("An anisotropic filter that is left on is named, not as a bias of levels") {
  check_all({"an anisotropic filter left on"});
}

TEST_CASE("Tiles whose lists of lights are full are named with their size and how many lights they hold") {
  check_all({"tiles whose lists are full"});
}

TEST_CASE("Glass that is missing, out of order or blended wrongly is named") {
  check_all({"glass missing", "glass in the opposite order", "glass not multiplied by its alpha", "glass added"});
}

}  // namespace trueshade::testing
