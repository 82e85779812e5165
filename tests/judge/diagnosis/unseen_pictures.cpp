// What goes wrong after the lights: tones, filters, scaling, compression. The G-buffer is right.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "tests/judge/diagnosis/unseen_frames.h"

namespace trueshade::testing {
namespace {

using oracle::Capture;

template <class Change>
Capture each_texel(const Subject& s, Change change) {
  return pictured_with(s, [&](FloatPicture& picture, const Capture&) {
    for (glm::dvec3& texel : picture.texels) texel = change(glm::clamp(texel, 0.0, 1e6));
  });
}

/// Every texel is made of the right picture's: `change` takes that and the place.
template <class Change>
Capture each_place(const Subject& s, Change change) {
  return pictured_with(s, [&](FloatPicture& picture, const Capture& right) {
    FloatPicture source = picture;
    for (glm::dvec3& texel : source.texels) texel = glm::clamp(texel, 0.0, 1.0);
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x) picture.at(x, y) = change(source, x, y, right);
  });
}

/// K. Narkowicz, "ACES Filmic Tone Mapping Curve", 2016.
Capture aces(const Subject& s) {
  return each_texel(s, [](const glm::dvec3& x) { return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14); });
}

Capture gamma_encoded(const Subject& s) {
  return each_texel(s, [](const glm::dvec3& x) { return glm::pow(glm::min(x, 1.0), glm::dvec3(1 / 2.2)); });
}

Capture video_levels(const Subject& s) {
  return each_texel(s, [](const glm::dvec3& x) { return (16.0 + 219.0 * glm::min(x, 1.0)) / 255.0; });
}

Capture blurred(const Subject& s) {
  return each_place(s, [](const FloatPicture& source, int x, int y, const Capture&) {
    glm::dvec3 sum(0.0);
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) sum += source.near(x + dx, y + dy);
    return sum / 9.0;
  });
}

glm::dvec3 half_texel(const FloatPicture& source, int x, int y) {
  x = std::clamp(x, 0, source.width / 2 - 1), y = std::clamp(y, 0, source.height / 2 - 1);
  return 0.25 * (source.at(2 * x, 2 * y) + source.at(2 * x + 1, 2 * y) + source.at(2 * x, 2 * y + 1) +
                 source.at(2 * x + 1, 2 * y + 1));
}

/// Halved, and scaled up again by linear filtering.
Capture half_size(const Subject& s) {
  return each_place(s, [](const FloatPicture& source, int x, int y, const Capture&) {
    const int near_x = x / 2, near_y = y / 2, far_x = near_x + (x % 2 ? 1 : -1), far_y = near_y + (y % 2 ? 1 : -1);
    return (9.0 * half_texel(source, near_x, near_y) + 3.0 * half_texel(source, far_x, near_y) +
            3.0 * half_texel(source, near_x, far_y) + half_texel(source, far_x, far_y)) /
           16.0;
  });
}

/// JPEG's 4:2:0: colour differences are averages over 2x2 pixels.
Capture chroma_halved(const Subject& s) {
  return each_place(s, [](const FloatPicture& source, int x, int y, const Capture&) {
    const glm::dvec3 luma(0.299, 0.587, 0.114);
    const glm::dvec3 mean = half_texel(source, x / 2, y / 2);
    return mean + glm::dot(luma, source.at(x, y)) - glm::dot(luma, mean);
  });
}

Capture fog(const Subject& s) {
  const glm::dvec3 eye(s.scene.camera.eye);
  const double length = glm::distance(eye, glm::dvec3(s.scene.camera.target));
  return each_place(s, [=](const FloatPicture& source, int x, int y, const Capture& right) {
    const Image& p = *right.plane("position");
    if (right.plane("id.object")->value(x, y, 0) == 0) return source.at(x, y);
    const double d = glm::distance(eye, glm::dvec3(p.value(x, y, 0), p.value(x, y, 1), p.value(x, y, 2)));
    return glm::mix(glm::dvec3(0.5, 0.55, 0.6), source.at(x, y), std::exp(-0.3 * d / length));
  });
}

Capture vignette(const Subject& s) {
  return each_place(s, [](const FloatPicture& source, int x, int y, const Capture&) {
    const double u = 2 * (x + 0.5) / source.width - 1, v = 2 * (y + 0.5) / source.height - 1;
    return source.at(x, y) * (1 - 0.2 * (u * u + v * v));
  });
}

}  // namespace

std::vector<UnseenFault> unseen_faults_of_pictures() {
  const std::string_view some = "city cornell atrium";
  return {
      {"aces", "the picture is tone-mapped by a filmic curve", "- picture-tone-mapped", some, aces},
      {"gamma-encoded", "the picture is raised to 1 / 2.2", "picture-gamma picture-srgb-encoded", some, gamma_encoded},
      {"video-levels", "codes run from 16 to 235", "- picture-offset picture-exposure", some, video_levels},
      {"blurred", "pixels are means of 3x3", "- edges-averaged", some, blurred},
      {"half-size", "the picture is drawn at half its size and scaled up", "- edges-averaged", some, half_size},
      {"chroma-halved", "colour differences are means of 2x2, as JPEG has them", "-", some, chroma_halved},
      {"fog", "fog is laid over the picture", "-", some, fog},
      {"vignette", "the picture darkens towards its corners", "-", some, vignette},
  };
}

}  // namespace trueshade::testing
