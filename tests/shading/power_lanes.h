#pragma once
#include <span>

namespace trueshade::testing {

/// The powers of the light kernels (shading/light/power-inl.h) on the SIMD target in force; lengths are multiples of 16.
/// `compiled`: as of a shape of lights whose exponent, 16, 30 or 32, is known to the compiler.
void raise(std::span<const float> x, float exponent, bool compiled, std::span<float> out);

/// A power a lane, integers from 0 to 8192.
void raise(std::span<const float> x, std::span<const float> exponents, std::span<float> out);

}  // namespace trueshade::testing
