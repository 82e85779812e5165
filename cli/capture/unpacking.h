#pragma once
#include <array>
#include <optional>

// Unpacks normals that are stored in few numbers, in double. u = 2^-23 is one rounding of a shader's float arithmetic
// in any direction (GLSL 4.60, 4.7.1), a division 2.5 u, an inverse square root 2 u.
namespace trueshade {

/// A number as a file holds it, with how far off packing and reading may make it.
struct PackedNumber {
  double value = 0;
  double step = 0;   ///< distance to the next number that the storage holds; 0 of 32-bit floats
  double fetch = 0;  ///< bound on |value - what a shader reads|: 2.5 u of a code, 0 of a float
};

/// A vector that was unpacked, and bounds on how far each component, rounded to float, may be off.
struct UnpackedVector {
  std::array<double, 3> value{};
  double reading_error = 0;  ///< from what the engine's shader unpacks from the same numbers
  double packing_error = 0;  ///< from what was packed: a store may have taken either neighbouring number
};

/// 2 c - 1, the number in [-1, 1] that an unorm number c stands for, with its step and error: doubling is exact, the
/// difference is rounded once.
PackedNumber signed_number(const PackedNumber& c);

/// A vector of three stored components, not made unit length. Each bound is the largest of the components' bounds.
UnpackedVector unpacked_components(const std::array<PackedNumber, 3>& n);

/// Unpacks an octahedral direction:
/// v = (x, y, 1 - |x| - |y|); where v.z < 0, v.xy = (1 - |v.yx|) sign(v.xy); n = v / |v|.
/// Nothing where x or y is NaN, or outside [-1, 1] by more than its fetch. Quirin Meyer et al., "On Floating-Point
/// Normal Vectors", EGSR 2010; Zina H. Cigolle et al., "A Survey of Efficient Representations for Independent Unit
/// Vectors", JCGT 3 (2), 2014.
std::optional<UnpackedVector> unpacked_octahedral(const PackedNumber& x, const PackedNumber& y);

/// Unpacks a direction from Lambert's azimuthal equal-area projection of the sphere:
/// f = 4 c - 2, n.xy = f sqrt(1 - f.f / 4), n.z = 1 - f.f / 2; packed as c = n.xy / sqrt(8 n.z + 8) + 1/2.
/// Nothing where c is NaN, or farther from the middle than any direction is packed to. Martin Mittring, "A bit more
/// Deferred - CryEngine 3", Triangle Game Conference 2009; Aras Pranckevicius, "Compact Normal Storage for small
/// G-Buffers", 2010, method 4.
std::optional<UnpackedVector> unpacked_spheremap(const PackedNumber& x, const PackedNumber& y);

}  // namespace trueshade
