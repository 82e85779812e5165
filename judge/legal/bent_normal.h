#pragma once
// What a texel of a normal map may make of a surface's normal (docs/arithmetic.md section 13).
#include "judge/legal/surface.h"

namespace trueshade::oracle {

/// The directions along which a surface's u and v grow, in world space, of any length. They are those of the triangle,
/// both 0 where its uv has no area; or, where `side` is not 0, u is that of the vertices' tangents, and v is not used.
struct TangentFrame {
  Bounded3 u, v;
  int side = 0;              ///< B is along N x u where it is above 0, against it where it is below
  bool either_side = false;  ///< or the other way: the matrix may mirror or not, as far as float arithmetic tells
};

/// The frame of a triangle whose vertices have tangents. Sets `side`, by the tangents' w and by whether the instance's
/// matrix mirrors, and `either_side`, where a shader may be unable to tell the matrix's determinant from 0. Leaves `u`
/// to the caller, who interpolates it at the pixel.
TangentFrame vertex_frame(const Projector& projector, uint32_t instance, uint32_t triangle);

/// The frame that a normal map is read in, of a triangle whose vertices have no tangents. It is made from positions in
/// the world, in double (docs/arithmetic.md). Unless the profile has exact vertices, a shader may also make it from
/// positions in the object and turn it into the world, and the bounds hold that too: three products of a row with one
/// rounding each, two sums, and the rounding of the matrix element and of the direction, 5 v sum |m| |u|.
///   uv_set: the set that the normal map reads
TangentFrame tangent_frame(const Projector& projector, uint32_t instance, uint32_t triangle,
                           const TriangleValues& values, size_t uv_set);

/// The ranges of the bent normal: (T x + B y) + N z, of N as interpolated and x, y, z = 2 t - 1, x and y times `scale`.
///
/// Roundings are carried operation by operation for the N in the middle of its ranges. Another N, e away, is turned by
/// theta <= e / (|N| - e). With phi the angle from N to U, the unit vectors T and B move by dtheta / sin phi
/// (T = U's part across N: dT = -N (d.T) - cot(phi) (d.B) B for a turn d; B = N x T), and sin phi >= sin phi_0 - theta
/// on the way: so by theta / (sin phi_0 - theta) in all. Where that may be 0 both may be any unit vectors; where C.V
/// may be of either sign, B may be turned.
std::array<Range, 3> bent_normal(const std::array<Range, 3>& normal, const TangentFrame& frame,
                                 const std::array<Range, 4>& texel, double scale, const Profile& profile);

}  // namespace trueshade::oracle
