#pragma once
#include <cstdint>

#include "shading/light_table.h"

namespace trueshade::testing {

/// Where the kernels' estimate of 1 / sqrt(d2) comes from: the CPU, or the value itself times 1 + 2^-14 of this.
enum class RootSource : uint8_t { cpu, low, right, high };

constexpr int kSettledPixels = 16;

/// A vector of pixels: position, normal, direction to the eye, albedo, x y z each.
struct SettledPixels {
  alignas(64) float number[12][kSettledPixels];
};

/// What the kernels of settled codes (docs/arithmetic.md sections 17, 18) make of one light, in units of 2^-14 of a
/// code; 0 where nothing is estimated.
struct SettledErrors {
  double share[kSettledPixels];   ///< the largest |estimate - 255 T| of the channels, as a share of the proof's bound
  double window[kSettledPixels];  ///< the proof's bound as a share of what the kernel's window holds
  int settled;                    ///< pixels that add codes
  int wrong;                      ///< pixels that are not left open but do not count as their terms do
  double edge;                    ///< the proof's bound of a cone's t as a share of the kernel's; 0: no cone
};

/// Whether the SIMD target in force has these kernels.
bool settles_lanes();

/// Errors of the first light of the table, in Lambert's or Phong's model as kCompiledShapes has them.
void settled_errors(const LightTable& lights, const LightModel& model, bool phong, RootSource root,
                    const SettledPixels& pixels, SettledErrors& errors);

}  // namespace trueshade::testing
