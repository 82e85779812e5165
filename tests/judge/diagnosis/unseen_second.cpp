// A second list of faults, written by somebody who had read the search, before any of them was tried.
#include <algorithm>
#include <cmath>

#include "tests/judge/diagnosis/unseen_frames.h"

namespace trueshade::testing {
namespace {

using oracle::Capture;

/// Every second pixel was drawn in the frame before, from elsewhere, and is filled from the left.
Capture checkerboard_left(const Subject& s) {
  return pictured_with(s, [](FloatPicture& picture, const Capture&) {
    const FloatPicture source = picture;
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x)
        if ((x + y) % 2 == 1) picture.at(x, y) = source.near(x - 1, y);
  });
}

/// B. Bayer's matrix of 4 by 4, 1973, as wide as a code.
Capture bayer_dithered(const Subject& s) {
  return pictured_with(s, [](FloatPicture& picture, const Capture&) {
    constexpr int kRanks[4][4] = {{0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}};
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x) picture.at(x, y) += ((kRanks[y % 4][x % 4] + 0.5) / 16 - 0.5) / 255;
  });
}

Capture half_a_stop(const Subject& s) {
  return pictured_with(s, [](FloatPicture& picture, const Capture&) {
    for (glm::dvec3& texel : picture.texels) texel *= std::sqrt(2.0);
  });
}

Capture phong_exponent(const Subject& s) {
  return lit_with(s, [](Scene& scene, Pipeline& pipeline) {
    pipeline.light_model.shininess /= 4;
    for (Material& material : scene.materials) material.shininess /= 4;
  });
}

Capture camera_late(const Subject& s) {
  return drawn_with(s, [](Scene& scene, Pipeline&) {
    const glm::vec3 step = 0.01f * (scene.camera.target - scene.camera.eye);
    const glm::vec3 aside(step.z, 0.0f, -step.x);
    scene.camera.eye += aside, scene.camera.target += aside;
  });
}

/// From a program whose x runs the other way.
Capture mirrored_import(const Subject& s) {
  const size_t object = seen_object(s, 1);
  return drawn_with(s, [=](Scene& scene, Pipeline&) {
    Instance& instance = scene.instances[object];
    instance.world_from_object[0] *= -1.0f, instance.mirrored = !instance.mirrored;
  });
}

Capture offset_left_on(const Subject& s) {
  return drawn_with(s, [](Scene&, Pipeline& pipeline) {
    pipeline.geometry.polygon_offset_factor = 1, pipeline.geometry.polygon_offset_units = 1;
  });
}

Capture normals_at_half_size(const Subject& s) {
  return stored_with(s, "normal", [](const glm::dvec3&, int x, int y, const Capture& right) {
    const Image& normals = *right.plane("normal");
    return glm::dvec3(normals.value(x & ~1, y & ~1, 0), normals.value(x & ~1, y & ~1, 1),
                      normals.value(x & ~1, y & ~1, 2));
  });
}

/// The distance's square is compared with the range.
Capture ranges_not_squared(const Subject& s) {
  return weighted_with(s, [&](size_t i, const glm::dvec3& p, int, int) {
    const Light& light = s.scene.lights[i];
    if (light.type == LightType::ambient || light.type == LightType::directional || std::isinf(light.range)) return 1.0;
    const glm::dvec3 to_light = glm::dvec3(light.position) - p;
    return to_light.x * to_light.x + to_light.y * to_light.y + to_light.z * to_light.z < double(light.range) ? 1.0
                                                                                                             : 0.0;
  });
}

/// Tiles of 16 by 16 pixels are culled by a quarter of the range, against the box about their surfaces.
Capture lists_too_short(const Subject& s) {
  constexpr int kSide = 16;
  const Capture right = right_of(s);
  const FloatPicture positions = floats_of(*right.plane("position"));
  const Image& ids = *right.plane("id.object");
  const int across = (s.pipeline.width + kSide - 1) / kSide, down = (s.pipeline.height + kSide - 1) / kSide;
  std::vector<glm::dvec3> low(size_t(across * down), glm::dvec3(1e30)), high(low.size(), glm::dvec3(-1e30));
  const auto tile = [&](int x, int y) { return size_t(y / kSide * across + x / kSide); };
  for (int y = 0; y < positions.height; ++y)
    for (int x = 0; x < positions.width; ++x)
      for (int c = 0; c < 3 && ids.code(x, y, 0) > 0; ++c) {
        low[tile(x, y)][c] = std::min(low[tile(x, y)][c], positions.at(x, y)[c]);
        high[tile(x, y)][c] = std::max(high[tile(x, y)][c], positions.at(x, y)[c]);
      }
  return weighted_with(s, [&](size_t i, const glm::dvec3&, int x, int y) {
    const Light& light = s.scene.lights[i];
    if (light.type == LightType::ambient || light.type == LightType::directional || std::isinf(light.range)) return 1.0;
    double squared = 0;
    for (int c = 0; c < 3; ++c) {
      const double p = double(light.position[c]);
      const double outside = std::max({0.0, low[tile(x, y)][c] - p, p - high[tile(x, y)][c]});
      squared += outside * outside;
    }
    return std::sqrt(squared) < 0.25 * double(light.range) ? 1.0 : 0.0;
  });
}

}  // namespace

std::vector<UnseenFault> unseen_faults_of_the_second_list() {
  const std::string_view all = "city cornell lecture";
  return {
      {"checkerboard-left", "every second pixel is that to its left", "-", "city cornell atrium", checkerboard_left},
      {"bayer-dithered", "an ordered dither of a code is added", "picture-dithered", all, bayer_dithered},
      {"half-a-stop", "the picture is the root of two times as bright",
       "picture-exposure light-intensity lights-colored", all, half_a_stop},
      {"phong-exponent", "shininess is a quarter of what it should be", "shininess", "city cornell box",
       phong_exponent},
      {"camera-late", "the camera stands a frame behind, to the side", "camera-moved", all, camera_late},
      {"mirrored-import", "an object's x runs the other way", "object-scaled", all, mirrored_import},
      {"offset-left-on", "a polygon offset is left on", "polygon-offset", all, offset_left_on},
      {"normals-at-half-size", "normals are read from a plane of half the size", "-", all, normals_at_half_size},
      {"ranges-not-squared", "squares of distances are compared with ranges", "- light-range", "city cornell lecture",
       ranges_not_squared},
      {"lists-too-short", "tiles of 16 pixels are culled by a quarter of the range", "- light-range", "city lecture",
       lists_too_short},
  };
}

}  // namespace trueshade::testing
