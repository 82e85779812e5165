#include <algorithm>
#include <cmath>

#include "core/threads/parallel_for.h"
#include "judge/legal/patch.h"
#include "judge/stages/gbuffer_judge.h"
#include "judge/stages/glass_deviations.h"

namespace trueshade::oracle {

namespace {

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

/// The integral from -infinity to x of the share of [low, high] below a number.
double share_below(double low, double high, double x) {
  if (x <= low) return 0;
  return x < high ? (x - low) * (x - low) / (2 * (high - low)) : (high - low) / 2 + (x - high);
}

/// Predicted probability that `other` is in front of the nominal surface, though it is not where both are in the middle
/// of their ranges: that of two numbers spread evenly over these. 1 where one has a range so much wider that it says
/// little of where its depths are: one and the same error may bring all of them to the same side.
double chance_before(const PossibleSurface& nominal, const PossibleSurface& other) {
  constexpr double kMuchWider = 4;
  if (other.middle < nominal.middle) return 1;
  if (other.low > nominal.high) return 0;
  const double width = nominal.high - nominal.low, others = other.high - other.low;
  const bool within = other.low <= nominal.middle || nominal.high >= other.middle;
  if (within && std::max(width, others) > kMuchWider * std::min(width, others)) return 1;
  if (within) return 0.5;
  return (share_below(other.low, other.high, nominal.high) - share_below(other.low, other.high, nominal.low)) / width;
}

/// Predicted probability that not the nominal surface is seen: some edge is on the other side of the sample, or the
/// farther of two depths comes first.
double chance_of_other(const std::vector<const PossibleSurface*>& legal, const PossibleSurface* nominal) {
  double same = nominal != nullptr ? 1 - double(nominal->chance_other) : 1;
  for (const PossibleSurface* c : legal) {
    if (c == nominal) continue;
    const double before = nominal != nullptr ? chance_before(*nominal, *c) : 1;
    same *= 1 - before * (c->nominal ? 1 : double(c->chance_other));
  }
  return 1 - same;
}

}  // namespace

void GBufferJudge::find_legal(std::span<const PossibleSurface> all, std::vector<const PossibleSurface*>& legal,
                              const PossibleSurface*& nominal, bool& certain) const {
  const DepthFunc func = pipeline_.geometry.depth_func;
  const bool last_wins = func == DepthFunc::lequal || func == DepthFunc::gequal;
  legal.clear();
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
  if (legal.size() < 2) return;
  std::stable_sort(legal.begin(), legal.end(), [&](const PossibleSurface* a, const PossibleSurface* b) {
    if ((a == nominal) != (b == nominal)) return a == nominal;
    return a->middle < b->middle;
  });
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

void GBufferJudge::judge_pixel(std::span<const PossibleSurface> all, int x, int y_top, GBufferMemory& memory,
                               RowTally& row) const {
  const PossibleSurface* nominal = nullptr;
  bool certain = false;
  std::vector<const PossibleSurface*>& legal = memory.legal;
  find_legal(all, legal, nominal, certain);
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
    Match m;
    if (asked_ == Asked::classes || !fits_middle(*c, x, y_top, memory))
      m = match(*c, x, y_top, memory, bounded, row.worst_error);
    if (m.legal && c != nominal) {
      if (!patch) patch = patch_key(projector_, all, sx, sy);
      if (c->low > *patch) m.note("depth", 0, {*patch, -HUGE_VAL, *patch}, c->middle, 1);
    }
    if (m.legal) {
      const PixelClass shown = class_of(m, bounded, c, nominal);
      if (c == nominal && bounded && m.layered == PixelClass::exact) keep_for_materials(*c, x, y_top, memory, row);
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

void GBufferJudge::keep_for_materials(const PossibleSurface& shown, int x, int y_top, GBufferMemory& memory,
                                      RowTally& row) const {
  const uint32_t pixel = uint32_t(y_top) * uint32_t(pipeline_.width) + uint32_t(x);
  if (asked_ != Asked::classes || !is_sampled(pixel, pipeline_.width, pipeline_.height)) return;
  const Scene& scene = projector_.scene();
  const bool is_textured = scene.materials[scene.instances[shown.instance].material].textured();
  if (!layers_ || !layers_->any(x, y_top)) {
    if (is_textured) row.textured.push_back({pixel, shown});
    return;
  }
  const auto albedo =
      std::find_if(planes_.begin(), planes_.end(), [](const AttributePlane& p) { return p.first == kAlbedo; });
  if (is_textured || albedo == planes_.end()) return;
  const SurfaceValues surface(projector_, memory.forms.of(shown.instance, shown.triangle), shown, x + 0.5,
                              pipeline_.height - 1 - y_top + 0.5, SurfacePoint::Within::middle);
  std::array<double, 4> opaque{};
  for (int k = 0; k < 4; ++k) {
    const Range base = surface.base_color(k, albedo->interpolation);
    opaque[size_t(k)] = (k < 3 ? surface.albedo(base) : base).value;
  }
  keep_glass(*layers_, layers_->at(x, y_top), opaque, albedo->view, x, y_top, row);
}

void GBufferJudge::judge_band(int y, int end, std::vector<RowTally>& rows) const {
  GBufferMemory memory(projector_);
  for (int x = 0; x < pipeline_.width; x += kTile)
    for (int row = y; row < end; ++row)
      for (int column = x; column < std::min(x + kTile, pipeline_.width); ++column)
        if (mask_.has(column, row))
          rows[size_t(row)].leave_out();
        else if (asked_ == Asked::classes)
          judge_pixel(possible_.at(pixel_of(column, row)), column, row, memory, rows[size_t(row)]);
        else
          find_violation(column, row, memory, rows[size_t(row)]);
}

StageVerdict verdict_by(const GBufferJudge& judge, const Pipeline& pipeline, const Profile& profile,
                        const JudgedRows& judged) {
  std::vector<RowTally> rows(size_t(pipeline.height));
  parallel_for(JudgedRows::bands_of(pipeline.height), 0, [&](int band) {
    const int y = band * JudgedRows::kBand;
    if (judged.has_band(band)) judge.judge_band(y, std::min(y + JudgedRows::kBand, pipeline.height), rows);
  });
  return verdict_of("gbuffer", profile, pipeline.width, pipeline.height, rows);
}

StageVerdict judge_gbuffer(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
                           const JudgedRows& rows, FoundSurfaces* found) {
  const Profile p = resolved(profile, pipeline);
  GBufferJudge judge(scene, pipeline, p, capture, rows, Asked::classes, nullptr, nullptr);
  StageVerdict verdict = verdict_by(judge, pipeline, p, rows);
  if (found != nullptr) *found = judge.take_found();
  return verdict;
}

}  // namespace trueshade::oracle
