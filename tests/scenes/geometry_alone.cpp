#include <cmath>

#include "scenes/lights_of_ours.h"
#include "scenes/pipeline/fit_lights.h"
#include "scenes/pipeline/presets.h"
#include "scenes/scene.h"
#include "scenes/trig.h"
#include "tests/catch.hpp"
#include "tests/scratch_folder.h"

// What a geometry file gets that comes without a scene.
namespace trueshade {
namespace {

Scene loaded_obj(const std::string& obj) {
  const ScratchFolder folder;
  return load_scene(folder.write("m.obj", obj));
}

/// A box from (x, y, z) on, of a size, as six faces.
std::string box(double x, double y, double z, double size) {
  std::string text;
  for (int corner = 0; corner < 8; ++corner)
    text += "v " + std::to_string(x + size * (corner & 1)) + ' ' + std::to_string(y + size * (corner >> 1 & 1)) + ' ' +
            std::to_string(z + size * (corner >> 2)) + '\n';
  return text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
}

TEST_CASE("geometry alone: the ground lies just below, faces up, is wide, and ends before the far plane") {
  for (const double size : {1e-3, 1.0, 700.0}) {
    const Scene scene = loaded_obj(box(3.0 * size, -2.0 * size, size, size));
    REQUIRE(scene.instances.size() == 2);
    const Mesh& ground = scene.meshes[scene.instances[1].mesh];
    const double radius = 0.5 * std::sqrt(3.0) * size;
    double farthest = 0.0;
    for (size_t v = 0; v < ground.vertex_count(); ++v) {
      const glm::dvec3 at(ground.position[0][v], ground.position[1][v], ground.position[2][v]);
      CHECK(at.y < -2.0 * size);
      CHECK(at.y > -2.0 * size - 0.01 * radius);
      CHECK(ground.normal[1][v] == 1.0f);
      const glm::dvec3 from_eye = at - glm::dvec3(scene.camera.eye);
      farthest =
          std::max(farthest, std::sqrt(from_eye.x * from_eye.x + from_eye.y * from_eye.y + from_eye.z * from_eye.z));
    }
    CHECK(farthest < double(scene.camera.far));
    CHECK(double(ground.position[0][1]) - 3.5 * size == Approx(8.0 * radius));
    CHECK(double(scene.camera.eye.y) > -2.0 * size);  // above it
    for (size_t t = 0; t < ground.indices.size(); t += 3) {
      double x[3], z[3];
      for (size_t k = 0; k < 3; ++k) {
        x[k] = ground.position[0][ground.indices[t + k]];
        z[k] = ground.position[2][ground.indices[t + k]];
      }
      CHECK((z[1] - z[0]) * (x[2] - x[0]) - (x[1] - x[0]) * (z[2] - z[0]) > 0.0);  // counter-clockwise from above
    }
  }
}

TEST_CASE("geometry alone: nothing to stand on the ground, or no room for it, gives none") {
  CHECK(loaded_obj(box(3e17, 0.0, 0.0, 1.1e17)).instances.size() == 1);
  CHECK(loaded_obj("v 0 0 0\nf 1 1 1\n").instances.size() == 2);
}

TEST_CASE("geometry alone: reflectance is that of materials and vertices, each object by its triangles") {
  Scene scene;
  scene.materials = {{"", {0.5f, 0.5f, 0.5f, 1.0f}}, {"", {1.0f, 0.0f, 0.0f, 1.0f}}};
  Mesh mesh;
  for (int k = 0; k < 3; ++k) mesh.position[size_t(k)] = mesh.normal[size_t(k)] = {0.0f, 1.0f};
  mesh.indices = {0, 1, 1};
  scene.meshes = {mesh, mesh};
  scene.meshes[1].color = {std::vector<float>{0.0f, 1.0f}, {0.0f, 1.0f}, {0.0f, 1.0f}, {1.0f, 1.0f}};
  scene.meshes[1].indices = {0, 1, 1, 0, 0, 1, 1, 1, 0};
  CHECK(mean_reflectance(scene) == 0.0);
  scene.instances = {{0, 0}};
  CHECK(mean_reflectance(scene) == Approx(0.5));
  scene.instances = {{0, 0}, {1, 1}};
  CHECK(mean_reflectance(scene) == Approx((0.5 + 3.0 * 0.5 * 0.2126) / 4.0));
}

TEST_CASE("geometry alone: lights are up to five times as bright on dark surfaces") {
  constexpr double kKey = 1.45;  // red of the key light on grey
  const auto key_light = [](const std::string& color) {
    return loaded_obj("v 0 0 0 " + color + "\nv 1 0 0 " + color + "\nv 0 1 0 " + color + "\nf 1 2 3\n")
        .lights.at(0)
        .color.x;
  };
  CHECK(key_light("1 1 1") == Approx(kKey));  // the material is grey
  CHECK(key_light("0.5 0.5 0.5") == Approx(2.0 * kKey));
  CHECK(key_light("0.01 0.01 0.01") == Approx(5.0 * kKey));
  CHECK(key_light("0 0 0") == Approx(kKey));
  CHECK(key_light("1 0.05 0.05") == Approx(1.5 * kKey));  // its red would be cut off at 1 by more
}

TEST_CASE("geometry alone: where light spreads by the inverse square, a model of any size is as bright") {
  Pipeline spreading;
  spreading.light_model.falloff = Falloff::inverse_square;
  const auto key_at_model = [&](double size) {
    Scene scene = loaded_obj(box(0.0, 0.0, 0.0, size));
    const Light before = scene.lights.at(0);
    fit_lights_of_ours(scene, Pipeline{});
    CHECK(scene.lights.at(0).color == before.color);
    fit_lights_of_ours(scene, spreading);
    const glm::dvec3 way = glm::dvec3(scene.lights.at(0).position) - glm::dvec3(0.5 * size);
    return double(scene.lights.at(0).color.x) / ((way.x * way.x + way.y * way.y) + way.z * way.z);
  };
  const double one = key_at_model(1.0);
  CHECK(one == Approx(0.4 * 1.45));
  for (const double size : {1e-3, 0.2, 700.0}) CHECK(key_at_model(size) == Approx(one));
  Scene scene = loaded_obj(box(0.0, 0.0, 0.0, 1.0));
  const glm::vec3 ambient = scene.lights.at(3).color;
  fit_lights_of_ours(scene, spreading);
  CHECK(scene.lights.at(3).color == ambient);
  scene.lights_of_ours = false;
  const glm::vec3 stated = scene.lights.at(0).color;
  fit_lights_of_ours(scene, spreading);
  CHECK(scene.lights.at(0).color == stated);
}

TEST_CASE("geometry alone: lamps so near that no float holds their falloff shine as from far away") {
  const auto box_of = [](const char* size) {
    std::string text;
    for (int corner = 0; corner < 8; ++corner) {
      text += 'v';
      for (int k = 0; k < 3; ++k) text += std::string(" ") + (corner >> k & 1 ? size : "0");
      text += '\n';
    }
    return text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  };
  Pipeline spreading;
  spreading.light_model.falloff = Falloff::inverse_square;
  const Scene one = loaded_obj(box_of("1"));
  for (const char* size : {"1e-20", "1e-10", "1e-8", "1e17"}) {
    INFO(size);
    Scene scene = loaded_obj(box_of(size));
    REQUIRE(scene.lights.size() == one.lights.size());
    for (size_t i = 0; i + 1 < one.lights.size(); ++i) {
      const Light &lamp = scene.lights[i], &usual = one.lights[i];
      const double k = std::strtod(size, nullptr);
      const glm::dvec3 way = glm::dvec3(usual.position) - glm::dvec3(0.5);
      const double distance2 = (way.x * way.x + way.y * way.y) + way.z * way.z;
      const double there = 1.0 + double(usual.attenuation.z) * distance2;  // at the model's middle
      if (k <= 1e-10) {
        CHECK(lamp.type == LightType::directional);
        for (int c = 0; c < 3; ++c) {
          CHECK(double(lamp.direction[c]) == Approx(-way[c] / std::sqrt(distance2)));
          CHECK(double(lamp.color[c]) == Approx(double(usual.color[c]) / there));
        }
      } else {
        CHECK(lamp.type == LightType::point);
        CHECK(lamp.color == usual.color);
        CHECK(double(lamp.attenuation.z) * k * k == Approx(double(usual.attenuation.z)));
      }
    }
    fit_lights_of_ours(scene, spreading);
    if (std::strtod(size, nullptr) <= 1e-10) CHECK(double(scene.lights[0].color.x) == Approx(0.4 * 1.45));
  }
}

TEST_CASE("geometry alone: where a light program divides diffuse light by pi, lamps have pi times as much") {
  Scene formula = loaded_obj(box(0.0, 0.0, 0.0, 1.0)), program = formula;
  fit_lights_of_ours(formula, *preset_pipeline("punctual"));
  fit_lights_of_ours(program, *preset_pipeline("gltf"));
  REQUIRE(program.lights.size() == formula.lights.size());
  for (size_t i = 0; i < program.lights.size(); ++i) {
    const bool is_lamp = program.lights[i].type != LightType::ambient;
    for (int c = 0; c < 3; ++c)
      CHECK(program.lights[i].color[c] == Approx((is_lamp ? kPi : 1.0) * double(formula.lights[i].color[c])));
  }
  Pipeline ends = Pipeline{};  // behind a preset whose light falls off otherwise
  ends.light_program = preset_pipeline("gltf")->light_program;
  Scene same = loaded_obj(box(0.0, 0.0, 0.0, 1.0));
  fit_lights_of_ours(same, ends);
  CHECK(same.lights.at(0).color == program.lights.at(0).color);
}

}  // namespace
}  // namespace trueshade
