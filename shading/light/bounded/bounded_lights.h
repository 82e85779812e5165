#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "raster/fixed_point.h"
#include "scenes/pipeline/light_model.h"
#include "shading/light/fast/compiled_models.h"
#include "shading/light/light_table.h"

namespace trueshade {

/// A light that falls off by 1 / (1 + k1 d + k2 d^2) and no other way.
struct PlainLight {
  float position[3], k1, k2, color[3];
};

/// A light that falls off by 1 - d / range, as sums estimate it: half a cache line.
struct alignas(32) WindowLight {
  float position[3], cut2;
  float color[3];
  float half_share;  ///< 0.5 / range
};

/// The lights of a table as sums by bounds read them, in scene order: those of docs/arithmetic.md section 16
/// (shading/light/bounded/bounded_sum-inl.h) and of section 19 (shading/light/bounded/bounded_blinn_sum-inl.h); empty where the model or one of the
/// lights is not of the kind whose errors that section bounds.
struct PlainLights {
  std::vector<PlainLight> light;
  std::vector<float> k1, k2, strongest;  ///< side by side; `strongest`: the largest of the colour; padded with 0
  float relative = 0.0f;                 ///< error of a sum, as a share of it
  std::vector<WindowLight> window;       ///< of section 19; last, one that lights nothing
  float most_color = 0.0f;               ///< the largest of theirs
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

constexpr float kMostWindowColor = 0x1p6f;

/// Lights of a sum that are added up before they are added to it.
inline constexpr size_t kPlainPart = 32;

/// Shapes whose sums may be settled by bounds.
constexpr bool is_plain(const LightShape& s) {
  return s.falloff == Falloff::quadratic && s.cone == Cone::none && s.diffuse == Diffuse::clamped &&
         s.specular == Specular::blinn_phong && s.source == SpecularSource::model && s.squared && s.power > 0 &&
         s.power <= 16 && (s.order == TermOrder::factored || s.order == TermOrder::separate);
}

/// The same under lights with a linear window.
constexpr bool is_window(const LightShape& s) {
  return s.falloff == Falloff::linear_range && s.cone == Cone::none && s.diffuse == Diffuse::clamped &&
         s.specular == Specular::blinn_phong && s.source == SpecularSource::model && s.specular_masked && s.squared &&
         s.power == 16 && s.order == TermOrder::factored;
}

PlainLights make_plain_lights(const LightTable& lights, const LightModel& model);
/// The same in the memory of others.
void make_plain_lights(const LightTable& lights, const LightModel& model, PlainLights& out);

}  // namespace trueshade
