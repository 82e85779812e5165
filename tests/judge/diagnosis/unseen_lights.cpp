// What goes wrong between a scene's lights and the light pass. The G-buffer is right.
#include <cmath>
#include <glm/geometric.hpp>
#include <set>

#include "tests/judge/diagnosis/unseen_frames.h"

namespace trueshade::testing {
namespace {

using oracle::Capture;
constexpr double kPi = 3.14159265358979323846;

Capture colours_changed(const Subject& s, double (*change)(double)) {
  return lit_with(s, [&](Scene& scene, Pipeline&) {
    for (Light& light : scene.lights)
      for (int c = 0; c < 3; ++c) light.color[c] = float(change(double(light.color[c])));
  });
}

Capture half_of_one(const Subject& s) {
  const size_t one = strongest_light(s);
  return lit_with(s, [&](Scene& scene, Pipeline&) { scene.lights[one].color *= 0.5f; });
}

/// 1 - d / range once more: a window that the engineer meant to be smooth.
Capture window_squared(const Subject& s) {
  return weighted_with(s, [&](size_t i, const glm::dvec3& p, int, int) {
    const Light& light = s.scene.lights[i];
    if (light.type == LightType::ambient || std::isinf(light.range)) return 1.0;
    return std::max(0.0, 1.0 - glm::distance(p, glm::dvec3(light.position)) / double(light.range));
  });
}

/// Lists of lights of tiles of 16x16 pixels have room for four.
Capture lists_of_four(const Subject& s) {
  const std::vector<FloatPicture> terms = terms_of(s);
  const int tiles_across = (s.pipeline.width + 15) / 16, tiles_down = (s.pipeline.height + 15) / 16;
  std::vector<std::set<size_t>> lists(size_t(tiles_across * tiles_down));
  const auto tile = [&](int x, int y) { return size_t(y / 16 * tiles_across + x / 16); };
  for (size_t i = 0; i < terms.size(); ++i)
    for (int y = 0; y < s.pipeline.height; ++y)
      for (int x = 0; x < s.pipeline.width; ++x)
        if (terms[i].at(x, y) != glm::dvec3(0.0) && lists[tile(x, y)].size() < 4) lists[tile(x, y)].insert(i);
  return weighted_with(
      s, [&](size_t i, const glm::dvec3&, int x, int y) { return lists[tile(x, y)].count(i) != 0 ? 1.0 : 0.0; });
}

/// One light has a shadow map, in which everything to the right of it lies in shadow.
Capture one_shadowed(const Subject& s) {
  const size_t one = strongest_light(s);
  const glm::dvec3 place(s.scene.lights[one].position);
  return weighted_with(s,
                       [=](size_t i, const glm::dvec3& p, int, int) { return i == one && p.x > place.x ? 0.0 : 1.0; });
}

Capture places_in_yards(const Subject& s) {
  return lit_with(s, [](Scene& scene, Pipeline&) {
    for (Light& light : scene.lights) light.position *= 1.0936f;
  });
}

Capture lights_late(const Subject& s) {
  return lit_with(s, [](Scene& scene, Pipeline&) {
    Scene before = scene;
    set_time(before, 0.75);
    scene.lights = before.lights;
  });
}

Capture colours_of_next(const Subject& s) {
  return lit_with(s, [](Scene& scene, Pipeline&) {
    const std::vector<Light> right = scene.lights;
    for (size_t i = 0; i < right.size(); ++i) scene.lights[i].color = right[(i + 1) % right.size()].color;
  });
}

/// A buffer of vec3 that is filled as if each took 12 bytes, and read as if each took 16.
Capture buffer_stride(const Subject& s) {
  return lit_with(s, [](Scene& scene, Pipeline&) {
    std::vector<float> packed;
    for (const Light& light : scene.lights)
      for (int c = 0; c < 3; ++c) packed.push_back(light.position[c]);
    packed.resize(packed.size() * 2);
    for (size_t i = 0; i < scene.lights.size(); ++i)
      scene.lights[i].position = {packed[4 * i], packed[4 * i + 1], packed[4 * i + 2]};
  });
}

Capture cones_whole(const Subject& s) {
  return lit_with(s, [](Scene& scene, Pipeline&) {
    for (Light& light : scene.lights) light.cone_rad *= 0.5f, light.penumbra_rad *= 0.5f;
  });
}

Capture eye_forgotten(const Subject& s) {
  return lit_with(s, [](Scene& scene, Pipeline& pipeline) {
    const Matrix4 m = clip_from_world(scene.camera, double(pipeline.width) / pipeline.height);
    scene.camera.clip_from_world.emplace();
    for (size_t i = 0; i < 16; ++i) (*scene.camera.clip_from_world)[i] = float(m[i]);
    scene.camera.matrix_has_gl_range = true;
    scene.camera.eye = glm::vec3(0.0f);
  });
}

Capture exponent_of_phong(const Subject& s) {
  return lit_with(s, [](Scene& scene, Pipeline& pipeline) {
    pipeline.light_model.shininess *= 4;
    for (Material& material : scene.materials) material.shininess *= 4;
  });
}

Capture highlights_tinted(const Subject& s) {
  return lit_with(s, [](Scene&, Pipeline& p) { p.light_model.specular_source = SpecularSource::albedo; });
}

}  // namespace

std::vector<UnseenFault> unseen_faults_of_lights() {
  const std::string_view all = "city cornell lecture";
  return {
      {"one-lamp-at-half", "the strongest light has half its colour", "light-colored", all, half_of_one},
      {"watts-for-candela", "all lights are divided by 4 pi", "light-intensity lights-colored picture-exposure", all,
       [](const Subject& s) { return colours_changed(s, [](double c) { return c / (4 * kPi); }); }},
      {"light-colours-encoded", "the lights' colours are raised to 1 / 2.2", "- lights-colored", all,
       [](const Subject& s) { return colours_changed(s, [](double c) { return std::pow(c, 1 / 2.2); }); }},
      {"window-squared", "the falloff is multiplied by 1 - d / range once more", "- falloff-other", all,
       window_squared},
      {"lists-of-four", "tiles of 16 pixels keep their first four lights", "- light-count-pixel", all, lists_of_four},
      {"one-lamp-shadowed", "half of the world lies in the shadow of the strongest light", "- light-missing", all,
       one_shadowed},
      {"yards-for-metres", "the lights' positions are 1.0936 times what they should be", "light-position", all,
       places_in_yards},
      {"lights-late", "the lights are those of a quarter of a second ago", "- lights-moved light-moved light-turned",
       all, lights_late},
      {"colours-of-the-next", "each light has the colour of the next", "- light-colored", all, colours_of_next},
      {"stride-12-for-16", "positions of lights are packed by 12 bytes and read by 16", "-", all, buffer_stride},
      {"cones-whole-for-half", "whole angles of cones are taken for half ones", "light-cones", "lecture", cones_whole},
      {"eye-forgotten", "the viewer of highlights stands at the origin", "lighting-eye", "city box", eye_forgotten},
      {"exponent-of-phong", "shininess is four times what it should be", "shininess", "city cornell box",
       exponent_of_phong},
      {"highlights-tinted", "the specular colour is the albedo", "- specular-factor", "city cornell",
       highlights_tinted},
  };
}

}  // namespace trueshade::testing
