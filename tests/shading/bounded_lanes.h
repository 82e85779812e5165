#pragma once
#include <cstdint>

#include "shading/light/light_table.h"
#include "shading/sum/bounded/bounded_lights.h"

namespace trueshade::testing {

/// Where the kernels' estimate of 1 / sqrt(d2) comes from: the CPU, or the value itself times 1 + this of what the
/// estimate may be off by, 2^-14 for codes and 1.5 * 2^-12 for sums.
enum class RootSource : uint8_t { cpu, low, right, high };

constexpr int kBoundedPixels = 16;

/// A vector of pixels: position, normal, direction to the eye, albedo, x y z each.
struct BoundedPixels {
  alignas(64) float number[12][kBoundedPixels];
};

/// What the kernels of bounded codes (docs/proofs.md sections 17, 18) make of one light, in units of 2^-14 of a
/// code; 0 where nothing is estimated.
struct BoundedErrors {
  double share[kBoundedPixels];   ///< the largest |estimate - 255 T| of the channels, as a share of the proof's bound
  double window[kBoundedPixels];  ///< the proof's bound as a share of what the kernel's window holds
  int proved;                     ///< pixels that add proved codes
  int wrong;                      ///< pixels that are not left undecided but do not count as their terms do
  double edge;                    ///< the proof's bound of a cone's t as a share of the kernel's; 0: no cone
};

/// Whether the SIMD target in force has these kernels.
bool bounds_codes();

/// Errors of the first light of the table, in Lambert's or Phong's model the shapes that sections 17 and 18 bound.
void bounded_errors(const LightTable& lights, const LightModel& model, bool phong, RootSource root,
                    const BoundedPixels& pixels, BoundedErrors& errors);

/// Whether the SIMD target in force has the kernel of bounded sums under lights with a linear window (section 19).
bool bounds_windows();

/// Errors of the sums of a table's lights, in the model of section 19: `share` of the largest
/// |estimate - sum| of the channels, in what the proof has for each term of it.
void window_errors(const LightTable& lights, const BoundedLights& bounded, const LightModel& model, RootSource root,
                   const BoundedPixels& pixels, BoundedErrors& errors);

}  // namespace trueshade::testing
