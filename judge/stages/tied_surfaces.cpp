#include "judge/stages/tied_surfaces.h"

#include <algorithm>
#include <cmath>

#include "core/threads/parallel_for.h"
#include "judge/legal/possible_sample.h"
#include "judge/legal/surface_values.h"
#include "judge/stages/tally.h"

namespace trueshade::oracle {

namespace {

class TieFinder {
 public:
  TieFinder(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
            const JudgedRows& rows)
      : pipeline_(pipeline),
        projector_(scene, pipeline_, profile, capture.drawn_at),
        object_(plane_of(capture, pipeline, "id.object")),
        primitive_(plane_of(capture, pipeline, "id.primitive")),
        depth_(plane_of(capture, pipeline, "depth")),
        position_(plane_of(capture, pipeline, "position")),
        normal_(plane_of(capture, pipeline, "normal")),
        possible_(find_tied(projector_, rows)) {}

  std::vector<TiedSurface> at(int x, int y_top) const {
    const int y = pipeline_.height - 1 - y_top;
    const std::span<const PossibleSurface> all = possible_.at(size_t(y) * size_t(pipeline_.width) + size_t(x));
    const bool covered = object_ ? object_.stored(x, y_top, 0) != 0
                                 : depth_ && !is_clear_depth(pipeline_.geometry, depth_.stored(x, y_top, 0));
    std::vector<TiedSurface> list;
    if (all.empty() || (covered && all.size() == 1)) return list;
    const PossibleSurface* seen = covered ? visible(all, x, y_top) : nullptr;
    if (covered && seen == nullptr) return list;  // shows what it cannot: the G-buffer's fault
    const double clear = depth_in_buffer(pipeline_.geometry, double(pipeline_.geometry.clear_depth));
    const Range left = seen != nullptr ? depth_of(*seen, x, y) : Range{clear, clear, clear};
    for (const PossibleSurface& c : all) {
      if (&c == seen) continue;
      const Range depth = depth_of(c, x, y);
      if (depth.low > left.high || depth.high < left.low) continue;
      const bool same = (left.low == left.high && depth.low == left.low && depth.high == left.low) ||
                        (seen != nullptr && same_vertices(*seen, c));
      const bool is_at_end = depth.low <= 0 || depth.high >= 1 || left.low <= 0 || left.high >= 1;
      list.push_back(
          {surface_of(c, x + 0.5, y + 0.5), same && c.certain, seen != nullptr && &c < seen, is_at_end ? 1.0f : 0.5f});
    }
    return list;
  }

 private:
  /// The possible surface that the capture shows at a pixel, by identifiers, and by difference() where several have
  /// them; null for none. Of two faces that meet at a silhouette both are at the edge's depth: the normal tells which
  /// one is seen. Of two that an offset takes to the end of the depth range, the position does.
  const PossibleSurface* visible(std::span<const PossibleSurface> all, int x, int y_top) const {
    const double object = object_ ? object_.stored(x, y_top, 0) : 0;
    const double primitive = primitive_ ? primitive_.stored(x, y_top, 0) : 0;
    const auto named = [&](const PossibleSurface& c) {
      return (!object_ || object == c.instance + 1.0) && (!primitive_ || primitive == c.triangle + 1.0);
    };
    const auto first = std::find_if(all.begin(), all.end(), named);
    if (first == all.end()) return nullptr;
    if (std::none_of(first + 1, all.end(), named)) return &*first;
    const PossibleSurface* best = nullptr;
    double least = HUGE_VAL;
    for (const PossibleSurface& c : all) {
      if (!named(c)) continue;
      const double off = difference(c, x, y_top);
      if (best == nullptr || off < least) best = &c, least = off;
    }
    return best;
  }

  /// How far the pixel's position, normal and depth are outside of what the possible surface's may be, and a little of
  /// how far from their middle: a normal map's texels may be far from it and legal, and stores round.
  double difference(const PossibleSurface& c, int x, int y_top) const {
    const SurfaceValues values(projector_, c, x + 0.5, pipeline_.height - 1 - y_top + 0.5);
    const GBufferState& planes = pipeline_.gbuffer;
    double off = 0;
    const auto add = [&off](const Range& legal, double stored) {
      off += std::max({0.0, legal.low - stored, stored - legal.high}) + std::fabs(legal.value - stored) / 64;
    };
    for (int k = 0; k < 3 && normal_; ++k)
      add(values.normal(k, planes.normal.interpolation), normal_.image->value(x, y_top, k));
    for (int k = 0; k < 3 && position_; ++k)
      add(values.attribute(kPosition + size_t(k), planes.position.interpolation), position_.image->value(x, y_top, k));
    if (depth_) add(values.depth(), depth_in_buffer(pipeline_.geometry, depth_.stored(x, y_top, 0)));
    return off;
  }

  /// The depth of a possible surface as the depth buffer may hold it.
  Range depth_of(const PossibleSurface& c, int x, int y) const {
    const DepthFunc func = pipeline_.geometry.depth_func;
    if (!orders_depths(func)) return SurfaceValues(projector_, c, x + 0.5, y + 0.5).depth();
    const bool far_first = func == DepthFunc::greater || func == DepthFunc::gequal;
    return far_first ? Range{-c.middle, -c.high, -c.low} : Range{c.middle, c.low, c.high};
  }

  /// Whether two surfaces have equal clip coordinates, and so equal depths (GL 4.6 core, appendix A, rule 5).
  bool same_vertices(const PossibleSurface& a, const PossibleSurface& b) const {
    return a.piece == b.piece &&
           projector_.clip_of(a.instance, a.triangle) == projector_.clip_of(b.instance, b.triangle);
  }

  ShadedSurface surface_of(const PossibleSurface& c, double x, double y) const {
    const SurfaceValues values(projector_, c, x, y);
    ShadedSurface surface = shaded_surface(values, pipeline_.gbuffer);
    surface.object = c.instance + 1, surface.pixel = {int(x), int(y)};
    surface.material = projector_.scene().instances[c.instance].material + 1;
    return surface;
  }

  const Pipeline pipeline_;
  const Projector projector_;
  const PlaneView object_, primitive_, depth_, position_, normal_;
  const PossibleSurfaces possible_;
};

}  // namespace

TiedSurfaces::TiedSurfaces(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
                           const JudgedRows& judged)
    : width_(pipeline.width) {
  const TieFinder finder(scene, pipeline, profile, capture, judged);
  std::vector<std::vector<std::vector<TiedSurface>>> rows(size_t(pipeline.height));
  parallel_for(pipeline.height, 0, [&](int y) {
    if (!judged.has(y)) return rows[size_t(y)].resize(size_t(pipeline.width));
    for (int x = 0; x < pipeline.width; ++x) rows[size_t(y)].push_back(finder.at(x, y));
  });
  first_.push_back(0);
  for (const auto& row : rows)
    for (const auto& pixel : row) {
      list_.insert(list_.end(), pixel.begin(), pixel.end());
      first_.push_back(list_.size());
    }
}

}  // namespace trueshade::oracle
