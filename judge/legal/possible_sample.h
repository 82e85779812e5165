#pragma once
// One triangle at one sample as a possible surface, and which of a pixel's are kept: the rules that every search for
// possible surfaces follows.
#include <optional>
#include <span>
#include <vector>

#include "judge/legal/possible_surfaces.h"
#include "judge/legal/triangle_form.h"

namespace trueshade::oracle {

/// The surface that a piece may show at the sample (x, y), in pixels, y up: `base` with its doubts and its depth key
/// added. The sample lies in the piece, surely or perhaps. Nothing where the alpha test surely drops the surface.
///   values: of the triangle; read where the material is masked, and may be null elsewhere
///   cover: what coverage_at() returned for the sample, not Cover::no
///   base: the surface's instance, triangle, piece and `cut`
///   order: the triangle's place among all that are submitted, which is the key under ALWAYS
std::optional<PossibleSurface> possible_sample(const Projector& projector, const Piece& piece, const PieceShape& shape,
                                               const TriangleValues* values, const Coverage& cover,
                                               PossibleSurface base, double order, double x, double y);

/// Whether the next opaque surface at a pixel may be seen: it is not surely hidden, and may pass the depth test against
/// the clear depth.
///   surface: becomes uncertain where the depth test may drop it, and under depth functions that do not order depths
///   limit: in/out, the key behind which all is surely hidden; clear_key() before the first surface. Falls to the
///          surface's greatest key where the surface is certain
bool is_kept(const GeometryState& state, double clear, PossibleSurface& surface, double& limit);

/// As is_kept(), but keeps each surface, seen or not, whose depth may be the one that is left in the depth buffer; all
/// surfaces where the depth function does not order depths. For find_tied().
bool may_be_left(const GeometryState& state, double clear, PossibleSurface& surface, double& limit);

/// Whether a depth test keeps the nearer or the farther fragment: LESS, LEQUAL, GREATER, GEQUAL.
bool orders_depths(DepthFunc func);

/// Finds the surfaces that single pixels may show under the projector's profile. It looks only among those that were
/// found under a looser profile, which gives the same as a search of all triangles. For one thread at a time.
class NarrowedSurfaces {
 public:
  /// Borrows the projector and the cache of triangles.
  NarrowedSurfaces(const Projector& projector, TriangleForms& forms)
      : projector_(projector), forms_(forms), clear_(clear_key(projector.pipeline().geometry)) {}

  /// The surfaces that pixel (x, y), y up, may show. Valid until the next call.
  ///   wider: those that it may show under a profile that allows all that the projector's profile allows
  std::span<const PossibleSurface> at(std::span<const PossibleSurface> wider, int x, int y);

 private:
  void add(const PossibleSurface& wider, double x, double y);

  const Projector& projector_;
  TriangleForms& forms_;
  const double clear_;
  double limit_ = 0;
  std::vector<PossibleSurface> found_;
};

}  // namespace trueshade::oracle
