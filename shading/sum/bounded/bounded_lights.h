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
struct QuadraticLight {
  float position[3], k1, k2, color[3];
};

/// A light that falls off by 1 - d / range, as sums estimate it: half a cache line.
struct alignas(32) WindowLight {
  float position[3], cut2;
  float color[3];
  float half_share;  ///< 0.5 / range
};

/// The lights of a table as sums by bounds read them, in scene order. `quadratic` is empty where the model or a light
/// is not of the kind that docs/proofs.md section 16 bounds, `window` where section 19 does not.
struct BoundedLights {
  std::vector<QuadraticLight> quadratic;
  std::vector<float> k1, k2,
      strongest;                    ///< of these, side by side; `strongest`: the largest of the colour; padded with 0
  float relative = 0.0f;            ///< error of a sum, as a share of it
  std::vector<WindowLight> window;  ///< the last one lights nothing
  float most_color = 0.0f;          ///< the largest of theirs
};

/// The quadratic lights that light some pixels, by whether their specular terms may matter.
struct LightsByGloss {
  std::vector<uint32_t> matte, shiny;  ///< those whose specular term does not count, and all others that light
  std::vector<uint64_t> matte_bits, shiny_bits;  ///< the same
  float left_out = 0.0f;                         ///< bound of what the terms left out add up to at any pixel
};

/// Pixels of a tile in groups for which the same lights matter.
struct PixelGroups {
  static constexpr uint16_t kMost = 16;
  uint16_t pixel[kMaxTilePixels];
  std::vector<uint16_t> first;  ///< of each group, and one more
};

/// Whether a coordinate is in the range that sections 16 and 19 ask for.
constexpr bool coordinate_in_proof_range(float x) {
  const float size = x < 0.0f ? -x : x;
  return size == 0.0f || (size >= 0x1p-40f && size <= 0x1p30f);
}
constexpr float kMostProvenFalloff = 0x1p16f, kMostProvenColor = 0x1p20f, kMostProvenAlbedo = 0x1p10f,
                kMostProvenNormal = 2.0f;

constexpr float kMostWindowColor = 0x1p6f;

/// How many lights are added up to a part before the part is added to the sum.
inline constexpr size_t kSumPart = 32;

/// The shape whose sums section 16 bounds: Blinn-Phong not masked, 1 / (1 + k1 d + k2 d^2), shininess 32.
struct QuadraticBlinn {
  static constexpr LightShape shape = kQuadraticBlinn;
  static constexpr bool compiled = true;
};

/// The shape whose sums section 19 bounds: Blinn-Phong, shininess 32, a linear window.
struct WindowBlinn {
  static constexpr LightShape shape = kWindowBlinn;
  static constexpr bool compiled = true;
};

BoundedLights make_bounded_lights(const LightTable& lights, const LightModel& model);

/// The same, kept by the calling thread until it asks for those of another table.
const BoundedLights& kept_bounded_lights(const LightTable& lights, const LightModel& model);

}  // namespace trueshade
