#pragma once
// Pixels in planes, and blend_pixels() on a chosen SIMD target.
#include <hwy/aligned_allocator.h>

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "core/simd/simd_target.h"
#include "shading/blend/blend.h"
#include "tests/catch.hpp"

namespace trueshade::testing {

inline constexpr NumericProfile kMesa = NumericProfile::mesa_llvmpipe_22_3;
inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

/// The same bits, or both NaN.
inline bool same(float a, float b) {
  return (a != a && b != b) || std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b);
}

using Rgba = std::array<float, 4>;
inline Rgba grey(float x) { return {x, x, x, x}; }

/// Calls body(simd) for each SIMD target of this machine.
template <typename Body>
void on_every_simd(const Body& body) {
  for (const std::string_view simd : simd_targets()) {
    INFO(simd);
    body(simd);
  }
}

/// Planes R, G, B, A, aligned as kernels want them, their length rounded up to a multiple of 16.
struct PixelPlanes {
  explicit PixelPlanes(size_t pixels);
  size_t count;
  hwy::AlignedFreeUniquePtr<float[]> plane[4];

  void set(size_t i, const Rgba& pixel);
  Rgba at(size_t i) const;
  std::array<const float*, 4> read() const;
  std::array<float*, 4> write();
};

void blend(const BlendState& state, const BlendTarget& target, const PixelPlanes& source, PixelPlanes& stored,
           std::string_view simd = "best");

/// One pixel, alone.
Rgba blend(const BlendState& state, const BlendTarget& target, const Rgba& source, const Rgba& stored,
           std::string_view simd = "best");

/// Blending of all four channels alike.
BlendState blending(BlendTerm term, const Rgba& constant = {});

/// Modes that engines use, for exhaustive runs: nine of them.
struct NamedMode {
  std::string_view name;
  BlendTerm term;
};
const std::array<NamedMode, 9>& usual_modes();

/// The state as text, for messages.
std::string text_of(const BlendState& state);

}  // namespace trueshade::testing
