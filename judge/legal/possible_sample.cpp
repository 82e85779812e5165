#include "judge/legal/possible_sample.h"

#include <algorithm>
#include <cmath>

#include "judge/legal/map_range.h"

namespace trueshade::oracle {

namespace {

void key_range(const GeometryState& state, const Range& z, double order, PossibleSurface& c) {
  switch (state.depth_func) {
    case DepthFunc::less:
    case DepthFunc::lequal:
      c.low = z.low, c.middle = z.value, c.high = z.high;
      return;
    case DepthFunc::greater:
    case DepthFunc::gequal:
      c.low = -z.high, c.middle = -z.value, c.high = -z.low;
      return;
    case DepthFunc::always:
      c.low = c.middle = c.high = -order;
      return;
    case DepthFunc::equal:
    case DepthFunc::notequal:
    case DepthFunc::never:
      c.low = c.middle = c.high = 0;
      return;
  }
}

/// Whether near and far, which float arithmetic places with an error, may cut here after all.
bool near_a_limit(const GeometryState& state, const Range& z) {
  if (state.depth_clamp) return false;
  const double near = double(state.depth_near), far = double(state.depth_far);
  return z.low <= std::min(near, far) || z.high >= std::max(near, far);
}

bool passes_equal(DepthFunc func) { return func == DepthFunc::lequal || func == DepthFunc::gequal; }

/// What the alpha test leaves of a possible surface; false: nothing.
bool test_alpha(const Projector& p, const Piece& piece, const SurfacePoint& point, const TriangleValues& values,
                double x, double y, PossibleSurface& c) {
  const Material& material = p.scene().materials[p.scene().instances[c.instance].material];
  if (!material.masked()) return true;
  const AlphaVerdict verdict = alpha_verdict(p, material, piece, point, values, x, y);
  if (!verdict.may_keep) return false;
  if (!verdict.may_drop) return true;
  c.certain = false, c.masked = true, c.chance_other = 0.5f;
  c.nominal = c.nominal && verdict.nominal_keeps;
  return true;
}

}  // namespace

std::optional<PossibleSurface> possible_sample(const Projector& projector, const Piece& piece, const PieceShape& shape,
                                               const TriangleValues* values, const Coverage& cover, PossibleSurface c,
                                               double order, double x, double y) {
  const Profile& profile = projector.profile();
  const GeometryState& state = projector.pipeline().geometry;
  const bool offset = state.polygon_offset_factor != 0 || state.polygon_offset_units != 0;
  double largest = 0;
  for (const WindowVertex& v : piece.v) largest = std::max(largest, std::fabs(v.z));
  const SurfacePoint point(piece, shape, profile, x, y);
  const Range z = stored_depth(point, state, profile, largest);
  c.certain = cover.cover == Cover::certain && point.bounded();
  c.chance_other = float(cover.chance_other);
  c.nominal = cover.nominal;
  if (!profile.exact_planes && near_a_limit(state, offset ? point.depth() : z))
    c.certain = false, c.cut = true, c.chance_other = 0.5f;
  if (values != nullptr && !test_alpha(projector, piece, point, *values, x, y, c)) return std::nullopt;
  key_range(state, z, order, c);
  return c;
}

bool is_kept(const GeometryState& state, double clear, PossibleSurface& surface, double& limit) {
  if (!(surface.low <= limit)) return false;
  const bool equal_passes = passes_equal(state.depth_func);
  const bool ordered = orders_depths(state.depth_func) || state.depth_func == DepthFunc::always;
  const auto passes = [&](double key) { return key < clear || (key == clear && equal_passes); };
  if (!passes(surface.low)) return false;
  if (!passes(surface.high) || !ordered) {
    // How depths lie in their range is the driver's secret: one rule may take all of them to the same side.
    surface.certain = false, surface.chance_other = 1;
    surface.nominal = surface.nominal && passes(surface.middle);
  }
  if (surface.certain) limit = std::min(limit, surface.high);
  return true;
}

bool orders_depths(DepthFunc func) {
  return passes_equal(func) || func == DepthFunc::less || func == DepthFunc::greater;
}

bool may_be_left(const GeometryState& state, double clear, PossibleSurface& surface, double& limit) {
  if (!orders_depths(state.depth_func)) return true;
  if (surface.low <= limit && surface.low == clear && !passes_equal(state.depth_func)) return true;
  return is_kept(state, clear, surface, limit);
}

void NarrowedSurfaces::add(const PossibleSurface& wider, double x, double y) {
  const GeometryState& state = projector_.pipeline().geometry;
  const std::shared_ptr<const TriangleForm>& form = forms_.of(wider.instance, wider.triangle);
  const Scene& scene = projector_.scene();
  const bool masked = scene.materials[scene.instances[wider.instance].material].masked();
  const double order = -wider.low;  // read where the key is the order alone
  PossibleSurface base;
  base.instance = wider.instance, base.triangle = wider.triangle;
  for (size_t k = 0; k < form->pieces().size(); ++k) {
    const Piece& piece = form->pieces()[k];
    const Coverage cover = coverage_at(piece, projector_.profile(), state.clip_origin, x, y);
    if (cover.cover == Cover::no) continue;
    base.piece = uint8_t(k), base.cut = piece.cut || piece.leaves_view;
    std::optional<PossibleSurface> c = possible_sample(projector_, piece, form->shape(k),
                                                       masked ? &form->values() : nullptr, cover, base, order, x, y);
    if (c && is_kept(state, clear_, *c, limit_)) found_.push_back(*c);
  }
}

std::span<const PossibleSurface> NarrowedSurfaces::at(std::span<const PossibleSurface> wider, int x, int y) {
  found_.clear();
  limit_ = clear_;
  const PossibleSurface* before = nullptr;
  for (const PossibleSurface& w : wider) {
    // The pieces of a triangle follow each other, and one look at the triangle finds all of them.
    if (before == nullptr || before->instance != w.instance || before->triangle != w.triangle) add(w, x + 0.5, y + 0.5);
    before = &w;
  }
  std::erase_if(found_, [this](const PossibleSurface& c) { return c.low > limit_; });
  return found_;
}

}  // namespace trueshade::oracle
