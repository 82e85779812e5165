#pragma once
// What a piece's planes may give at a sample: depth and attributes as ranges (docs/gl_rules.md section 9, "plane
// origin").
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "judge/bounds/window.h"
#include "judge/legal/piece_shape.h"
#include "judge/legal/store.h"
#include "oracle/scalar_renderer.h"

namespace trueshade::oracle {

/// Bounds the depth and the attributes that one piece may have at one sample (x, y).
///
/// Moving vertices v_i by d_i is moving the sample: the plane through (v_i + d_i, z_i) has at p the value that the
/// plane through (v_i, z_i) has at p - sum(b_i d_i), b_i the barycentrics of p in the moved triangle. So the values
/// that all vertices of the box allow are those of one plane over a box about p of half width sum |b_i| max|d_i|, with
/// |b_i| <= (|E_i| + dE_i) / (|A| - sum dE), dE_i what the box does to the edge function. A quotient of two affine
/// functions is monotone along every line where its divisor keeps its sign: the extremes are at the box's corners.
///
/// Float planes a0 + gx x + gy y of the driver's window, |x| <= X, |y| <= Y in pixels from its corner (where Mesa 22.3
/// has a0: llvmpipe/lp_state_setup.c, emit_coef4), add, with v the roundoff and N the largest vertex value:
///   setup      gx = (dN1 dy2 - dN2 dy1) / det: 4 v G + |gx| (3 K v + divide + v), G and K the same sums with | | in
///              place of - over |det|; it acts over the triangle's own extent, since a0 is made from the same gx
///   anchor     a0 = N - gx x - gy y: 3 v (|gx| X + |gy| Y) + 2 v N
///   evaluation 3 v (|gx| X + |gy| Y) + 2 v |a0|, |a0| <= N + |gx| X + |gy| Y
///   stepping from a tile's corner to its pixels: 2 v (|gx| X + |gy| Y)
/// and a perspective quotient N / D adds (dN + |a| dD) / D and the division.
///
/// Where the box allows a triangle without area no plane through its vertices is bounded. Yet a fragment is only there
/// if the snapped triangle covers the sample, and its values are then a mean of the vertices' (14.6.1: barycentrics in
/// [0, 1]): their hull, widened by its own width for the gradients of slivers, 8 v span^2 / |A| of the width, span <
/// 1/4 pixel, |A| at least 2^-24 (the finest grid known, 12 bits). A plane through vertices that are not snapped is
/// added where the profile has those.
class SurfacePoint {
 public:
  /// Which places of the vertices are taken into account: all that are legal (box), or the middle of their boxes alone,
  /// which costs less and gives a part of each range.
  enum class Within : uint8_t { box, middle };

  /// reach: the X and Y above, Projector::window_reach().
  SurfacePoint(const Piece& piece, const Profile& profile, const Pair& reach, double x, double y);

  /// Takes the piece's shape, which many samples of the piece share. Borrows the piece and its shape.
  SurfacePoint(const Piece& piece, const PieceShape& shape, const Profile& profile, double x, double y,
               Within within = Within::box);
  SurfacePoint(const SurfacePoint&) = delete;
  SurfacePoint& operator=(const SurfacePoint&) = delete;

  /// False where depth and attributes may be anything, because their planes go through vertices that are not snapped
  /// and have no area in float arithmetic (class UNDEFINED).
  bool bounded() const {
    return bounded_ || tiny_ == Tiny::hull || (tiny_ == Tiny::hull_and_plane && unsnapped_->bounded_);
  }

  /// The window depth at the sample, before polygon offset and clamping.
  Range depth() const;

  /// What glPolygonOffset adds to the depth (GL 4.6 core, 14.6.5): m factor + r units. m lies between the larger slope
  /// and the norm of both, of the plane through any vertices of the box, or of any three corners of what clipping
  /// leaves that may have the sample. r is the profile's; in float depth it follows from the vertices' largest |z|, or
  /// from that of the triangles that clipping may have cut the piece into.
  ///   largest: the vertices' largest |z|
  Range depth_offset(const GeometryState& state, double largest) const;

  /// An attribute at the sample; kAnyValue where nothing bounds it.
  ///   value, error: the attribute at the piece's three vertices, and how far it may be off there
  Range attribute(const std::array<double, 3>& value, const std::array<double, 3>& error,
                  Interpolation interpolation) const;
  /// An attribute at the sample, of which the vertex values and the error of their plane are known; kAnyValue where
  /// nothing bounds it.
  Range attribute(const VertexAttribute& vertices, Interpolation interpolation) const;

 private:
  enum class Tiny : uint8_t { anything, hull, hull_and_plane };
  struct Divisors;
  void find_samples(double x, double y, Within within);
  void no_plane(double x, double y);
  Range of_tiny(const std::array<double, 3>& value, const std::array<double, 3>& error, const Range& plane) const;
  template <size_t kSamples>
  Range affine(const VertexAttribute& vertices) const;
  Range affine(const VertexAttribute& vertices) const {
    return points_ == 1 ? affine<1>(vertices) : affine<6>(vertices);
  }
  template <size_t kSamples>
  Range quotient(const VertexAttribute& vertices, const Divisors& divisors) const;

  /// The sample, and the corners of its box; the sample again, so that there are as many as vectors hold.
  using Samples = std::array<double, 6>;

  /// What attributes are divided by, at each of the samples: the same for all that are interpolated alike.
  struct Divisors {
    bool above_zero = true;
    Samples value{}, least_value{};
    std::array<Samples, 3> weight{};      ///< of a vertex: its barycentric times its 1 / w
    std::array<Samples, 3> moves{};       ///< the same of sizes
    std::array<Samples, 3> moves_by_u{};  ///< the barycentric's size times the error of 1 / w
    double least = HUGE_VAL, error = 0;
  };
  void find_divisors(bool smooth, Divisors& out) const;

  double steepest() const;

  const Piece& piece_;
  Pair at_{};                                  ///< the sample
  const std::optional<PieceShape> own_shape_;  ///< where none was at hand
  const PieceShape& shape_;
  const Profile& profile_;
  bool bounded_ = true;
  Tiny tiny_ = Tiny::anything;               ///< what is known where bounded_ is not true
  std::unique_ptr<Piece> float_piece_;       ///< the piece with vertices not snapped, and
  std::unique_ptr<SurfacePoint> unsnapped_;  ///< its planes
  size_t points_ = 1;                        ///< 1 where the vertices are points, 5 otherwise
  std::array<Samples, 3> lambda_{};          ///< barycentrics at each of the samples
  mutable std::optional<Divisors> smooth_;   ///< once asked for
};

/// The attributes of a triangle's three vertices as floats, and how far a legal vertex shader may be off in each.
struct TriangleValues {
  std::array<VertexValues, 3> value{}, error{};
};

/// The attributes of a triangle's three vertices as its vertex shader may output them, with bounds on the error.
TriangleValues triangle_values(const Projector& projector, uint32_t instance, uint32_t triangle);

/// Sets `value` and `error` to attribute `index` (a ValueIndex plus a component) at the three vertices of a piece: sums
/// of the triangle's values by the vertices' weights, which are those that `interpolation` needs.
void piece_values(const Piece& piece, const TriangleValues& values, size_t index, Interpolation interpolation,
                  std::array<double, 3>& value, std::array<double, 3>& error);

/// The error of interpolating these vertex values over the piece, for VertexAttribute::plane_error. Not of flat ones.
double plane_error_of(const Piece& piece, const PieceShape& shape, const std::array<double, 3>& value,
                      Interpolation interpolation);

/// The depth that the depth buffer may hold for a fragment, after polygon offset, clamping to the depth range, and
/// rounding to the buffer's format; in fixed point as a number from 0 to 1, code over largest code.
///   largest: the piece's largest |z| of a vertex
Range stored_depth(const SurfacePoint& point, const GeometryState& state, const Profile& profile, double largest);

/// The value that the depth buffer holds for a depth that was read back or cleared to: in fixed point the nearest code
/// over the largest code, otherwise `depth`.
double depth_in_buffer(const GeometryState& state, double depth);

/// Whether a depth that was read back is what the buffer was cleared to. In fixed point this is either code beside
/// clear_depth.
bool is_clear_depth(const GeometryState& state, double depth);

}  // namespace trueshade::oracle
