#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "raster/fixed_point.h"
#include "scenes/light_model.h"
#include "shading/light_shape.h"
#include "shading/light_table.h"

namespace trueshade {

/// A light that falls off by 1 / (1 + k1 d + k2 d^2) and no other way.
struct PlainLight {
  float position[3], k1, k2, color[3];
};

/// The lights of a table as sums by bounds read them (shading/settled_sum-inl.h), in scene order; empty where the model
/// or one of the lights is not of the kind whose errors docs/arithmetic.md section 16 bounds.
struct PlainLights {
  std::vector<PlainLight> light;
  std::vector<float> k1, k2, strongest;  ///< side by side; `strongest`: the largest of the colour; padded with 0
  float relative = 0.0f;                 ///< error of a sum, as a share of it
};

/// Of a region, by what of them may matter.
struct PlainLists {
  std::vector<uint32_t> matte, shiny;  ///< those whose specular term does not count, and all others that light
  std::vector<uint64_t> matte_bits, shiny_bits;  ///< the same
  float left_out = 0.0f;                         ///< what has been left out of any pixel comes to at most this
};

/// Pixels of a tile in groups for which the same lights matter.
struct PixelGroups {
  static constexpr uint16_t kMost = 16;
  uint16_t pixel[kMaxTilePixels];
  std::vector<uint16_t> first;  ///< of each group, and one more
};

/// Numbers in the ranges that section 16 asks for.
constexpr bool plain_place(float x) {
  const float size = x < 0.0f ? -x : x;
  return size == 0.0f || (size >= 0x1p-40f && size <= 0x1p30f);
}
constexpr float kMostPlainFalloff = 0x1p16f, kMostPlainColor = 0x1p20f, kMostPlainAlbedo = 0x1p10f,
                kMostPlainNormal = 2.0f;

/// Lights of a sum that are added up before they are added to it.
inline constexpr size_t kPlainPart = 32;

/// Shapes whose sums may be settled by bounds.
constexpr bool is_plain(const LightShape& s) {
  return s.falloff == Falloff::quadratic && s.cone == Cone::none && s.diffuse == Diffuse::clamped &&
         s.specular == Specular::blinn_phong && s.source == SpecularSource::model && s.squared && s.power > 0 &&
         s.power <= 16 && (s.order == TermOrder::factored || s.order == TermOrder::separate);
}

PlainLights make_plain_lights(const LightTable& lights, const LightModel& model);

}  // namespace trueshade
