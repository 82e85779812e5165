#pragma once
// One triangle at one sample as a possible surface, and which of a pixel's are kept: the rules that every search for
// possible surfaces follows.
#include <optional>
#include <span>
#include <vector>

#include "judge/legal/possible_surfaces.h"
#include "judge/legal/triangle_form.h"

namespace trueshade::oracle {

/// The surface that a piece may show at the sample (x, y), in pixels, y up, which it has or may have; nothing where the
/// alpha test is sure to drop it.
///   values: of the triangle; read where the material is masked, and may be null elsewhere
///   cover: what coverage_at() says there, not Cover::no
///   base: the surface's instance, triangle, piece and `cut`
///   order: of the triangle among all that are submitted
std::optional<PossibleSurface> possible_sample(const Projector& projector, const Piece& piece, const PieceShape& shape,
                                               const TriangleValues* values, const Coverage& cover,
                                               PossibleSurface base, double order, double x, double y);

/// Whether an opaque surface is kept that comes next at a pixel. Lowers `limit` to the surface's greatest key where the
/// surface is certain.
///   limit: in/out, the key that is sure to be in front; before the first surface clear_key()
/// Makes a surface uncertain that the depth test may drop, or whose order depth does not tell.
bool is_kept(const GeometryState& state, double clear, PossibleSurface& surface, double& limit);

/// As is_kept(), but keeps a surface that may have the depth which is left, be it seen or not (find_tied()).
bool may_be_left(const GeometryState& state, double clear, PossibleSurface& surface, double& limit);

/// Whether the depth test tells surfaces apart by which is nearer or farther: LESS, LEQUAL, GREATER, GEQUAL.
bool orders_depths(DepthFunc func);

/// The possible surfaces of single pixels under the projector's profile, from those under a profile that allows all of
/// it: the same as a search among all triangles finds. For one thread at a time.
class NarrowedSurfaces {
 public:
  /// Borrows both.
  NarrowedSurfaces(const Projector& projector, TriangleForms& forms)
      : projector_(projector), forms_(forms), clear_(clear_key(projector.pipeline().geometry)) {}

  /// The possible surfaces of the pixel (x, y), y up, out of the `wider` ones. Valid until the next call.
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
