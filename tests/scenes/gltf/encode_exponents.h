#pragma once
#include <meshoptimizer.h>

#include <cstddef>

namespace trueshade::testing {

/// meshopt_encodeFilterExp() with one exponent for all components of a vector, which is what it did before
/// meshoptimizer 0.19 gave it a mode. `stride` is in bytes; `bits` are those of the mantissa.
inline void encode_exponents(void* out, size_t count, size_t stride, int bits, const float* values) {
#if MESHOPTIMIZER_VERSION >= 190
  meshopt_encodeFilterExp(out, count, stride, bits, values, meshopt_EncodeExpSharedVector);
#else
  meshopt_encodeFilterExp(out, count, stride, bits, values);
#endif
}

}  // namespace trueshade::testing
