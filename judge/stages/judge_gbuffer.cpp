#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/threads/parallel_for.h"
#include "judge/legal/patch.h"
#include "judge/legal/possible_surfaces.h"
#include "judge/legal/surface_values.h"
#include "judge/stages/judge.h"
#include "judge/stages/judge_transparency.h"
#include "judge/stages/tally.h"
#include "scenes/pipeline/transparency.h"

namespace trueshade::oracle {

namespace {

struct AttributePlane {
  const char* name;
  PlaneView view;
  size_t first;    ///< index in VertexValues
  int count;       ///< channels interpolated; those after them are constants
  double rest[2];  ///< channels 2 and 3 where they are not interpolated
  Interpolation interpolation;
};

class GBufferJudge {
 public:
  GBufferJudge(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
               const JudgedRows& rows)
      : projector_(scene, pipeline, profile, capture.drawn_at),
        pipeline_(pipeline),
        profile_(profile),
        depth_(plane_of(capture, pipeline, "depth")),
        object_(plane_of(capture, pipeline, "id.object")),
        material_(plane_of(capture, pipeline, "id.material")),
        specular_(reads_specular_plane(pipeline.light_model) ? plane_of(capture, pipeline, "specular") : PlaneView{}),
        emission_(pipeline.light_model.emission ? plane_of(capture, pipeline, "emission") : PlaneView{}) {
    const GBufferState& g = pipeline.gbuffer;
    const AttributePlane all[] = {
        {"position", plane_of(capture, pipeline, "position"), kPosition, 3, {0, 1}, g.position.interpolation},
        {"normal", plane_of(capture, pipeline, "normal"), kNormal, 3, {0, 1}, g.normal.interpolation},
        {"albedo", plane_of(capture, pipeline, "albedo"), kAlbedo, 4, {0, 0}, g.albedo.interpolation},
        {"uv", plane_of(capture, pipeline, "uv"), kUv, 2, {0, 1}, g.uv.interpolation}};
    for (const AttributePlane& p : all)
      if (p.view && !(g.position_from_depth && p.first == kPosition)) planes_.push_back(p);
    if (planes_.empty() && !depth_ && !object_ && !material_)
      throw Error(ErrorKind::bad_input, capture.name, "has no G-buffer plane",
                  "capture depth, position, normal, albedo, uv or ids");
    possible_ = possible_surfaces(projector_, rows);
    if (draws_transparent(scene, pipeline) && pipeline.transparency.mode == TransparencyMode::into_albedo &&
        capture.plane("albedo") != nullptr)
      layers_.emplace(scene, pipeline, profile, capture, rows);
  }

  /// Rows of a band, tile by tile: pixels that are near each other show the same triangles.
  void judge_band(int y, int end, std::vector<RowTally>& rows) const {
    TriangleForms forms(projector_);
    for (int x = 0; x < pipeline_.width; x += kTile)
      for (int row = y; row < end; ++row)
        for (int column = x; column < std::min(x + kTile, pipeline_.width); ++column)
          judge_pixel(column, row, forms, rows[size_t(row)]);
  }

 private:
  static constexpr int kTile = 16;
  size_t pixel_of(int x, int y_top) const {
    return size_t(pipeline_.height - 1 - y_top) * size_t(pipeline_.width) + size_t(x);
  }

  /// Whether a depth key is sure to pass the test against the clear value.
  bool passes_clear(double key) const {
    const GeometryState& g = pipeline_.geometry;
    const bool equal_passes = g.depth_func == DepthFunc::lequal || g.depth_func == DepthFunc::gequal;
    const double clear = clear_key(g);
    return key < clear || (equal_passes && key == clear);
  }

  bool is_clear(int x, int y) const {
    if (object_ && object_.stored(x, y, 0) != 0) return false;
    if (material_ && material_.stored(x, y, 0) != 0) return false;
    if (depth_ && !is_clear_depth(pipeline_.geometry, depth_.stored(x, y, 0))) return false;
    for (const AttributePlane& p : planes_)
      for (int c = 0; c < p.view.channels; ++c)
        if (p.view.stored(x, y, c) != 0 && !(p.first == kAlbedo && is_layered(p.view, x, y))) return false;
    return true;
  }

  /// Whether an albedo without a surface is what transparent surfaces may have left on the clear value.
  bool is_layered(const PlaneView& view, int x, int y) const {
    if (!layers_ || !layers_->any(x, y)) return false;
    return judge_ways(layers_->ways(layers_->at(x, y), Texel{}), view, "albedo", x, y, profile_).pixel_class !=
           PixelClass::violation;
  }

  /// The albedo of a surface under transparent ones.
  void judge_layered(const AttributePlane& plane, const SurfaceValues& surface, int x, int y_top, Match& m) const {
    Texel stored;
    for (int k = 0; k < plane.view.channels; ++k) {
      const Range base = surface.base_color(k, plane.interpolation);
      stored[size_t(k)] = legal_texel(k < 3 ? surface.albedo(base) : base, plane.view.image->format, k, profile_);
    }
    const TransparentPixel pixel = layers_->at(x, y_top);
    std::vector<LayeredTexel> ways{LayeredTexel{PixelClass::exact, stored, {}, false, false}};
    if (!pixel.layers.empty()) ways = layers_->ways(pixel, stored);
    for (LayeredTexel& way : ways) way.looked_up = way.looked_up || surface.textured();
    const LayeredVerdict v = judge_ways(ways, plane.view, "albedo", x, y_top, profile_);
    if (v.pixel_class == PixelClass::violation)
      return m.note("albedo", v.match.channel, v.match.legal_value, v.match.given, 1);
    m.second = m.second || v.match.second, m.tex = m.tex || v.pixel_class == PixelClass::tex;
    m.worst_error = std::max(m.worst_error, v.match.worst_error);
    if (worse(v.pixel_class, PixelClass::tex)) m.layered = v.pixel_class;
  }

  /// The values that a plane may hold where what was packed is in `packed`.
  static Range widened(const Range& packed, const PlaneView& view, int x, int y_top) {
    const double error = view.packing_error(x, y_top);
    return {packed.value, packed.low - error, packed.high + error};
  }

  /// What a plane may hold of a normal's component.
  Range held_normal(const AttributePlane& plane, const SurfaceValues& surface, int k, int x, int y_top) const {
    const Range n = surface.normal(k, plane.interpolation);
    if (plane.view.unorm()) return halved_normal(n, profile_);
    if (plane.view.decoded == nullptr || !plane.view.decoded->unit_length) return widened(n, plane.view, x, y_top);
    const auto component = [&](int c) { return surface.normal(c, plane.interpolation); };
    return widened(normalized(component(0), component(1), component(2), k, profile_), plane.view, x, y_top);
  }

  Match match(const PossibleSurface& c, int x, int y_top, TriangleForms& forms, bool& bounded) const {
    Match m;
    const uint32_t pixel = uint32_t(y_top) * uint32_t(pipeline_.width) + uint32_t(x);
    const double sx = x + 0.5, sy = pipeline_.height - 1 - y_top + 0.5;
    const Instance& instance = projector_.scene().instances[c.instance];
    const auto identifier = [&](const PlaneView& view, const char* name, double expected) {
      if (view && view.stored(x, y_top, 0) != expected)
        m.note(name, 0, {expected, expected, expected}, view.stored(x, y_top, 0), 1);
    };
    identifier(object_, "id.object", c.instance + 1.0);
    identifier(material_, "id.material", instance.material + 1.0);
    if (!m.legal && object_) return m;
    const SurfaceValues surface(projector_, forms.of(c.instance, c.triangle), c, sx, sy);
    bounded = surface.bounded();
    if (depth_)
      m.channel_is(depth_, "depth", 0, widened(surface.depth(), depth_, x, y_top),
                   depth_in_buffer(pipeline_.geometry, depth_.stored(x, y_top, 0)), pixel, profile_);
    if (!m.legal && m.excess > 1e3) return m;  // another surface altogether
    const auto judge_channel = [&](const PlaneView& view, const char* name, int k, const Range& range, double stored,
                                   bool looked_up) {
      if (looked_up)
        m.lookup_is(view, name, k, range, stored, pixel, profile_);
      else
        m.channel_is(view, name, k, range, stored, pixel, profile_);
    };
    const bool layered = layers_ && layers_->any(x, y_top);
    for (const AttributePlane& p : planes_) {
      if (layered && p.first == kAlbedo) judge_layered(p, surface, x, y_top, m);
      for (int k = 0; k < p.view.channels; ++k) {
        const double stored = p.view.stored(x, y_top, k);
        if (k >= p.count) {
          const double rest = p.view.constant(p.rest[k - 2], k);
          if (stored != rest) m.note(p.name, k, {rest, rest, rest}, stored, 1);
          continue;
        }
        if (p.first == kNormal) {
          judge_channel(p.view, p.name, k, held_normal(p, surface, k, x, y_top), stored, surface.bumpy());
          continue;
        }
        if (p.first != kAlbedo) {
          const Range range = surface.attribute(p.first + size_t(k), p.interpolation);
          m.channel_is(p.view, p.name, k, widened(range, p.view, x, y_top), stored, pixel, profile_);
          continue;
        }
        const Range base = surface.base_color(k, p.interpolation);
        if (specular_ && k < 3)
          judge_channel(specular_, "specular", k, surface.specular(base, k), specular_.stored(x, y_top, k),
                        surface.glossy());
        if (!layered) judge_channel(p.view, p.name, k, k < 3 ? surface.albedo(base) : base, stored, surface.textured());
      }
    }
    if (specular_ && specular_.channels > 3)
      judge_shininess(surface.shininess(), specular_.stored(x, y_top, 3), pixel, surface.rough(), m);
    for (int k = 0; k < 4 && emission_; ++k) {
      if (k >= emission_.channels) continue;
      const Range range = k < 3 ? surface.emission(surface.base_color(k, pipeline_.gbuffer.albedo.interpolation), k)
                          : info(pipeline_.gbuffer.emission).channels > 3 ? surface.ambient_share()
                                                                          : Range{1, 1, 1};  // another format stands in
      judge_channel(emission_, "emission", k, range, emission_.stored(x, y_top, k),
                    k < 3 ? surface.glowing() : surface.shaded());
    }
    return m;
  }

  /// An integer of the range.
  void judge_shininess(const Range& range, double stored, uint32_t pixel, bool looked_up, Match& m) const {
    if (!looked_up) return m.channel_is(specular_, "specular", 3, range, stored, pixel, profile_);
    m.lookup_is(specular_, "specular", 3, range, stored, pixel, profile_);
    if (stored != std::nearbyint(stored)) m.note("specular", 3, {range.value, range.low, range.high}, stored, 1);
  }

  /// Possible surfaces that may be seen, the nominal one first.
  std::vector<const PossibleSurface*> legal_surfaces(std::span<const PossibleSurface> all,
                                                     const PossibleSurface*& nominal, bool& certain) const;
  void judge_pixel(int x, int y_top, TriangleForms& forms, RowTally& row) const;
  PixelClass class_of(const Match& m, bool bounded, const PossibleSurface* seen, const PossibleSurface* nominal) const;

  Projector projector_;
  const Pipeline pipeline_;
  const Profile profile_;
  PlaneView depth_, object_, material_, specular_, emission_;
  std::vector<AttributePlane> planes_;
  PossibleSurfaces possible_;
  std::optional<TransparentLayers> layers_;  ///< blended into the albedo
};

std::string name_of(const PossibleSurface* c) {
  if (c == nullptr) return "nothing drawn";
  return "instance " + std::to_string(c->instance) + ", triangle " + std::to_string(c->triangle);
}

/// Whether `later` loses to `earlier`, which is sure to be drawn first with the very same depth.
bool ruled_out(const Projector& p, const PossibleSurface& earlier, const PossibleSurface& later, bool last_wins) {
  const PossibleSurface &winner = last_wins ? later : earlier, &loser = last_wins ? earlier : later;
  if (!winner.certain) return false;
  const bool points = winner.low == winner.high && loser.low == loser.high && winner.low == loser.low;
  return points || (p.clip_of(earlier.instance, earlier.triangle) == p.clip_of(later.instance, later.triangle) &&
                    earlier.piece == later.piece);
}

std::vector<const PossibleSurface*> GBufferJudge::legal_surfaces(std::span<const PossibleSurface> all,
                                                                 const PossibleSurface*& nominal, bool& certain) const {
  const DepthFunc func = pipeline_.geometry.depth_func;
  const bool last_wins = func == DepthFunc::lequal || func == DepthFunc::gequal;
  std::vector<const PossibleSurface*> legal;
  certain = false;
  double bound = HUGE_VAL;
  for (const PossibleSurface& c : all)
    if (c.certain) certain = true, bound = std::min(bound, c.high);
  for (size_t i = 0; i < all.size(); ++i) {
    bool out = all[i].low > bound;
    // Ties matter only between possible surfaces that are both in front.
    for (size_t j = 0; j < all.size() && !out; ++j) {
      if (i == j || all[j].low > bound || all[j].low > all[i].high || all[i].low > all[j].high) continue;
      const bool earlier = j < i;
      if (earlier != last_wins) out = ruled_out(projector_, all[std::min(i, j)], all[std::max(i, j)], last_wins);
    }
    if (!out) legal.push_back(&all[i]);
  }
  nominal = nullptr;
  for (const PossibleSurface* c : legal) {
    if (!c->nominal && !c->certain) continue;
    if (nominal == nullptr || c->middle < nominal->middle || (last_wins && c->middle == nominal->middle)) nominal = c;
  }
  std::stable_sort(legal.begin(), legal.end(), [&](const PossibleSurface* a, const PossibleSurface* b) {
    if ((a == nominal) != (b == nominal)) return a == nominal;
    return a->middle < b->middle;
  });
  return legal;
}

PixelClass GBufferJudge::class_of(const Match& m, bool bounded, const PossibleSurface* seen,
                                  const PossibleSurface* nominal) const {
  if (seen == nominal) {
    if (!bounded) return PixelClass::undefined;
    if (m.layered != PixelClass::exact) return m.layered;
    return m.tex ? PixelClass::tex : m.second ? PixelClass::store_2 : PixelClass::exact;
  }
  if ((seen != nullptr && seen->masked) || (nominal != nullptr && nominal->masked)) return PixelClass::tex;
  const bool doubt = (seen != nullptr && !seen->certain) || (nominal != nullptr && !nominal->certain);
  if (!doubt) return PixelClass::depth_tie;
  const bool cut =
      (seen != nullptr && !seen->certain && seen->cut) || (nominal != nullptr && !nominal->certain && nominal->cut);
  return cut ? PixelClass::clip : PixelClass::edge;
}

/// Predicted probability that not the nominal surface is seen: some edge is on the other side of the sample, or of two
/// depths spread evenly over [a0, a1] and [b0, b1] the farther comes first, which is overlap^2 / 2 over both widths.
double chance_of_other(const std::vector<const PossibleSurface*>& legal, const PossibleSurface* nominal) {
  double same = nominal != nullptr ? 1 - double(nominal->chance_other) : 1;
  for (const PossibleSurface* c : legal) {
    if (c == nominal) continue;
    double before = 1;
    if (nominal != nullptr) {
      const double overlap = std::max(0.0, std::min(nominal->high, c->high) - std::max(nominal->low, c->low));
      const double widths = (nominal->high - nominal->low) * (c->high - c->low);
      before = c->middle < nominal->middle ? 1 : widths > 0 ? std::min(0.5, overlap * overlap / (2 * widths)) : 0.5;
    }
    same *= 1 - before * (c->nominal ? 1 : double(c->chance_other));
  }
  return 1 - same;
}

void GBufferJudge::judge_pixel(int x, int y_top, TriangleForms& forms, RowTally& row) const {
  const std::span<const PossibleSurface> all = possible_.at(pixel_of(x, y_top));
  const PossibleSurface* nominal = nullptr;
  bool certain = false;
  const std::vector<const PossibleSurface*> legal = legal_surfaces(all, nominal, certain);
  if (nominal != nullptr) ++row.covered;
  const bool clear_legal = !certain;
  if (legal.size() + (clear_legal ? 1 : 0) > 1) {
    const PossibleSurface* first = nominal != nullptr ? nominal : legal.front();
    row.may_be_other(uint32_t(y_top) * uint32_t(pipeline_.width) + uint32_t(x),
                     uint64_t(first->instance) << 32 | first->triangle, chance_of_other(legal, nominal));
  }
  const double sx = x + 0.5, sy = pipeline_.height - 1 - y_top + 0.5;
  if (is_clear(x, y_top)) {
    Match none;
    const bool hidden = !clear_legal || passes_clear(patch_key(projector_, all, sx, sy));
    if (hidden) none.note("id.object", 0, {1, 1, 1}, 0, 1);
    const PixelClass c = hidden ? PixelClass::violation : class_of(none, true, nullptr, nominal);
    row.take(x, y_top, c, none, is_told(c) ? name_of(nominal) : std::string());
    return;
  }
  Match closest;
  bool first = true;
  std::optional<double> patch;
  for (const PossibleSurface* c : legal) {
    bool bounded = true;
    Match m = match(*c, x, y_top, forms, bounded);
    if (m.legal && c != nominal) {
      if (!patch) patch = patch_key(projector_, all, sx, sy);
      if (c->low > *patch) m.note("depth", 0, {*patch, -HUGE_VAL, *patch}, c->middle, 1);
    }
    if (m.legal) {
      const PixelClass shown = class_of(m, bounded, c, nominal);
      row.take(x, y_top, shown, m, is_told(shown) ? name_of(c) : std::string());
      return;
    }
    if (first || m.excess < closest.excess) closest = m;
    first = false;
  }
  if (legal.empty()) closest.note("id.object", 0, {0, 0, 0}, object_ ? object_.stored(x, y_top, 0) : 1, 1);
  closest.choices.clear();
  closest.stored_values = 0;
  row.take(x, y_top, PixelClass::violation, closest, name_of(legal.empty() ? nullptr : legal.front()));
}

}  // namespace

StageVerdict judge_gbuffer(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
                           const JudgedRows& judged) {
  const Profile p = resolved(profile, pipeline);
  const GBufferJudge judge(scene, pipeline, p, capture, judged);
  std::vector<RowTally> rows(size_t(pipeline.height));
  parallel_for(JudgedRows::bands_of(pipeline.height), 0, [&](int band) {
    const int y = band * JudgedRows::kBand;
    if (judged.has_band(band)) judge.judge_band(y, std::min(y + JudgedRows::kBand, pipeline.height), rows);
  });
  return verdict_of("gbuffer", p, pipeline.width, pipeline.height, rows);
}

}  // namespace trueshade::oracle
