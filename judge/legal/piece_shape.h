#pragma once
// What the planes through the vertices of a piece have in common at all samples.
#include <array>

#include "judge/bounds/window.h"

namespace trueshade::oracle {

/// What the interpolation of every attribute of a piece needs: gradients, extents and error bounds, the same at all
/// samples.
struct PieceShape {
  /// reach: Projector::window_reach(), pixels.
  PieceShape(const Piece& piece, const Profile& profile, const Pair& reach);

  /// A bound on the error of evaluating a plane through these three vertex values anywhere in the window; SurfacePoint
  /// says how it is made up. For attributes and 1 / w, whose planes follow PlaneForm.
  double plane_error(const std::array<double, 3>& vertex) const { return plane_error(vertex, weighted_); }

  bool points = true;                ///< the vertices are points, not boxes
  std::array<double, 3> dx{}, dy{};  ///< gradients of the barycentrics, 1/pixel
  double span_x = 0, span_y = 0;     ///< of the widest edge, pixels
  double area = 0;                   ///< twice the signed area, pixels^2; at 0 what follows is not set
  double condition = 0;
  double z_error = 0, u_error = 0;  ///< plane_error() of window depths and of 1 / w
  Pair window_reach;

 private:
  void find_setup(const Piece& piece);
  double plane_error(const std::array<double, 3>& vertex, bool weighted) const;

  /// The triangle from whose vertices planes are set up: the piece or, where PlaneForm says so, the triangle submitted.
  /// The plane through a piece's values has the values `from_piece` times these at the submitted triangle's vertices.
  struct Setup {
    std::array<double, 3> dx{}, dy{};
    double span_x = 0, span_y = 0, area = 0, condition = 0;
    double extent_x = 0, extent_y = 0;  ///< from a vertex in front of the eye to a sample
    std::array<std::array<double, 3>, 3> from_piece{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  } setup_;
  bool weighted_;
  double roundoff_, divide_;
};

/// An attribute's values at the three vertices of a piece, and how far each may be off.
struct VertexAttribute {
  std::array<double, 3> value{}, error{};
  double plane_error = 0;  ///< of value / w where the plane is smooth, else of the value
};

}  // namespace trueshade::oracle
