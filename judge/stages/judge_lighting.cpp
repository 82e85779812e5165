#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/threads/parallel_for.h"
#include "judge/bounds/program_bounds.h"
#include "judge/legal/allows.h"
#include "judge/stages/captured_surface.h"
#include "judge/stages/glass_deviations.h"
#include "judge/stages/judge.h"
#include "judge/stages/judge_blending.h"
#include "judge/stages/judge_transparency.h"
#include "judge/stages/thresholds.h"
#include "scenes/pipeline/transparency.h"

namespace trueshade::oracle {

namespace {

constexpr size_t kMostBranches = 8;  // 256 sums; beyond that the hull of all of them

class LightingJudge {
 public:
  /// settled: the verdict by a profile that allows more, where its EXACT pixels are no violations of this one; or null.
  LightingJudge(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
                const JudgedRows& rows, const StageVerdict* settled = nullptr)
      : scene_(scene),
        pipeline_(pipeline),
        profile_(profile),
        settled_(settled),
        mask_(capture.mask),
        surface_(scene, pipeline, profile, capture),
        color_(target_of(capture, pipeline)),
        count_(plane_of(capture, pipeline, "light.count")),
        lights_(scene, pipeline, profile.arithmetic) {
    require_planes_of(lights_, capture);
    if (draws_transparent(scene, pipeline) && pipeline.transparency.mode == TransparencyMode::after_lights)
      layers_.emplace(scene, pipeline, profile, capture, rows);
  }

  /// Judges the rows from y to before `end` into `rows`, tile by tile: pixels that are near each other have few lights.
  void judge_rows(int y, int end, std::vector<RowTally>& rows) const {
    Tile tile;
    tile.block.counts = bool(count_);
    for (int x = 0; x < pipeline_.width; x += kTile) {
      if (is_settled(x, y, end)) {
        for (int row = y; row < end; ++row)
          rows[size_t(row)].classes.resize(size_t(std::min(x + kTile, pipeline_.width)), PixelClass::exact);
        continue;
      }
      look_at(x, y, std::min(x + kTile, pipeline_.width), end, tile);
      for (int row = y; row < end; ++row)
        for (int column = x; column < tile.x1; ++column)
          if (mask_.has(column, row))
            rows[size_t(row)].leave_out();
          else
            judge_pixel(column, row, tile, rows[size_t(row)]);
    }
  }

  static constexpr int kTile = JudgedRows::kBand;

 private:
  /// The surfaces of some pixels, and the lights that may reach one of them.
  struct Tile {
    int x0 = 0, y0 = 0, x1 = 0;
    std::vector<ShadedSurface> surfaces;  ///< row by row; of pixels without one any
    std::vector<uint32_t> near;
    std::vector<LitRange> lit;  ///< as surfaces
    mutable ProgramBounds::Block block;
    const LitRange& lit_at(int x, int y) const { return lit[size_t((y - y0) * (x1 - x0) + x - x0)]; }
    const ShadedSurface& at(int x, int y) const { return surfaces[size_t((y - y0) * (x1 - x0) + x - x0)]; }
  };

  /// Whether all pixels of the tile at column x, rows y to `end`, are EXACT in the verdict `settled`; false without
  /// one.
  bool is_settled(int x, int y, int end) const {
    for (int row = y; row < end && settled_ != nullptr; ++row) {
      const auto first = settled_->classes.begin() + int64_t(pixel_at(x, row));
      const auto is_exact = [](PixelClass c) { return c == PixelClass::exact; };
      if (!std::all_of(first, first + std::min(kTile, pipeline_.width - x), is_exact)) return false;
    }
    return settled_ != nullptr;
  }
  void look_at(int x0, int y0, int x1, int y1, Tile& tile) const;
  void light_up(Tile& tile, int y1) const;
  uint32_t pixel_at(int x, int y) const { return uint32_t(y) * uint32_t(pipeline_.width) + uint32_t(x); }
  struct Output {
    std::array<Range, 4> color;
    bool undefined = false;
  };
  /// What a draw may output for the lights' sum `lit` once `change`, that of the other branches taken, is added to it.
  Output output(const LitRange& lit, const std::array<double, 3>& change, const ShadedSurface& surface,
                const Tile& tile) const;
  bool fits(const LitRange& lit, const Output& output, int x, int y, Match& m) const;
  void judge_pixel(int x, int y, const Tile& tile, RowTally& row) const;
  void keep_power(const Output& output, RowTally& row) const;
  void judge_uncovered(int x, int y, RowTally& row) const;
  void judge_layered(int x, int y, const Tile& tile, RowTally& row) const;
  bool count_is(const LitRange& lit, int x, int y, Match& m) const;

  const Scene& scene_;
  const Pipeline pipeline_;
  const Profile profile_;
  const StageVerdict* const settled_;
  const PixelMask& mask_;
  const CapturedSurface surface_;
  const PlaneView color_, count_;
  const uint32_t sampled_ = std::max(1u, uint32_t(pipeline_.width) * uint32_t(pipeline_.height) / 4096);  // one in
  const bool sees_thresholds_ = converts_as_seen(color_, profile_);
  const ProgramBounds lights_;
  std::optional<TransparentLayers> layers_;
};

bool LightingJudge::count_is(const LitRange& lit, int x, int y, Match& m) const {
  const double lights = count_ ? count_.stored(x, y, 0) : 0;
  if (count_ && (lights < lit.lights_low || lights > lit.lights_high))
    m.note("light.count", 0, {double(lit.lights_low), double(lit.lights_low), double(lit.lights_high)}, lights, 1);
  return m.legal;
}

/// Judges a pixel under transparent surfaces, from what the lights may have left there: nominally, and over all
/// branches.
void LightingJudge::judge_layered(int x, int y, const Tile& tile, RowTally& row) const {
  const bool covered = surface_.covered(x, y);
  Match counted;
  CarriedTexel at;
  std::array<double, 4> from{};
  bool branches = false;
  for (size_t k = 0; k < 4; ++k) {
    const Range c = cleared_range(double(scene_.clear[int(k)]), color_.image->format, int(k), profile_);
    at.nominal[k] = at.all[k] = legal_texel(c, color_.image->format, int(k), profile_);
    from[k] = c.value;
  }
  if (covered) {
    ++row.covered;
    const ShadedSurface surface = surface_.at(x, y);
    const LitRange& lit = tile.lit_at(x, y);
    LitRange hull = lit;
    for (const OtherBranch& b : lit.branches)
      for (size_t k = 0; k < 3; ++k) hull.color[k].error += std::fabs(b.change[k]);
    const Output as_real = output(lit, {}, surface, tile), any = output(hull, {}, surface, tile);
    if (lit.undefined || as_real.undefined || any.undefined) return row.take(x, y, PixelClass::undefined, {}, "");
    count_is(lit, x, y, counted);
    branches = !lit.branches.empty();
    for (size_t k = 0; k < 4; ++k) {
      at.nominal[k] = legal_texel(as_real.color[k], color_.image->format, int(k), profile_);
      at.all[k] = legal_texel(any.color[k], color_.image->format, int(k), profile_);
      from[k] = as_real.color[k].value;
    }
  }
  const TransparentPixel pixel = layers_->at(x, y);
  may_have_other_layers(pixel, pixel_at(x, y), row);
  LayeredVerdict v = judge_ways(layers_->ways(pixel, at.nominal), color_, "color", x, y, profile_);
  if (v.pixel_class == PixelClass::violation && branches) {
    v = judge_ways(layers_->ways(pixel, at.all), color_, "color", x, y, profile_);
    if (worse(PixelClass::branch, v.pixel_class)) v.pixel_class = PixelClass::branch;
  }
  if (!counted.legal) v = {PixelClass::violation, counted};
  if (v.pixel_class != PixelClass::violation && !branches) keep_glass(*layers_, pixel, from, color_, x, y, row);
  row.take(x, y, v.pixel_class, v.match, std::to_string(pixel.layers.size()) + " transparent fragments");
}

LightingJudge::Output LightingJudge::output(const LitRange& lit, const std::array<double, 3>& change,
                                            const ShadedSurface& surface, const Tile& tile) const {
  Output out;
  Bounded3 sum = lit.color;
  for (size_t k = 0; k < 3; ++k) sum[k].value += change[k];
  const ProgramBounds::Finished finished = lights_.finished(surface, sum, tile.block.registers);
  for (size_t k = 0; k < 4; ++k) out.color[k] = range_of(finished.color[k]);
  out.undefined = finished.undefined;
  return out;
}

bool LightingJudge::fits(const LitRange& lit, const Output& output, int x, int y, Match& m) const {
  const uint32_t pixel = pixel_at(x, y);
  for (int k = 0; k < color_.channels; ++k) {
    m.channel_is(color_, "color", k, output.color[size_t(k)], color_.stored(x, y, k), pixel, profile_);
    if (k == 3 || !sees_thresholds_ || !lit.branches.empty()) continue;
    const double largest = color_.layout.largest_code(k);
    if (std::optional<NearThreshold> s =
            near_threshold(output.color[size_t(k)], largest, profile_.likely.code_reach, 0, k)) {
      s->uppers = color_.stored(x, y, k) > s->threshold ? 1 : 0;
      m.near_thresholds.push_back(*s);
    }
  }
  return m.legal;
}

/// The least part by which light must be more than it is for the pixel to be in no legal set: of the channel that shows
/// it best. A pixel without light shows nothing.
void LightingJudge::keep_power(const Output& output, RowTally& row) const {
  double least = 1;
  bool is_lit = false;
  for (int k = 0; k < 3; ++k) {
    const Range& right = output.color[size_t(k)];
    if (!(right.value > 0)) continue;
    is_lit = true;
    const LegalTexel legal = legal_texel(right, color_.image->format, k, profile_);
    const auto shows = [&](double part) {
      const double more = right.value * (1 + part);
      return !legal.contains(legal_texel({more, more, more}, color_.image->format, k, profile_).nominal);
    };
    double part = 0x1p-22;
    while (part < least && !shows(part)) part *= 2;
    double low = part / 2;
    for (int i = 0; i < 5 && part < least; ++i) (shows((low + part) / 2) ? part : low) = (low + part) / 2;
    least = std::min(least, part);
  }
  if (is_lit) row.shown.push_back(float(least));
}

void LightingJudge::judge_uncovered(int x, int y, RowTally& row) const {
  Match m;
  const uint32_t pixel = pixel_at(x, y);
  for (int k = 0; k < color_.channels; ++k) {
    const Range c = cleared_range(double(scene_.clear[k]), color_.image->format, k, profile_);
    m.channel_is(color_, "color", k, c, color_.stored(x, y, k), pixel, profile_);
  }
  row.take(x, y,
           !m.legal   ? PixelClass::violation
           : m.second ? PixelClass::store_2
                      : PixelClass::exact,
           m, "nothing drawn");
}

void LightingJudge::look_at(int x0, int y0, int x1, int y1, Tile& tile) const {
  tile.x0 = x0, tile.y0 = y0, tile.x1 = x1;
  tile.surfaces.resize(size_t(x1 - x0) * size_t(y1 - y0));
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x)
      if (surface_.covered(x, y)) tile.surfaces[size_t((y - y0) * (x1 - x0) + x - x0)] = surface_.at(x, y);
  light_up(tile, y1);
}

/// The sums at all surfaces of the tile, by squares of pixels.
void LightingJudge::light_up(Tile& tile, int y1) const {
  constexpr int kSide = 8;
  static_assert(size_t(kSide * kSide) <= kIntervalLanes);
  std::vector<const ShadedSurface*> all;
  for (int y = tile.y0; y < y1; ++y)
    for (int x = tile.x0; x < tile.x1; ++x)
      if (surface_.covered(x, y)) all.push_back(&tile.at(x, y));
  lights_.take_near(all, tile.block, tile.near);
  tile.lit.resize(tile.surfaces.size());
  std::array<const ShadedSurface*, kIntervalLanes> surfaces;
  std::array<LitRange, kIntervalLanes> lit;
  for (int top = tile.y0; top < y1; top += kSide)
    for (int left = tile.x0; left < tile.x1; left += kSide) {
      size_t count = 0;
      for (int y = top; y < std::min(top + kSide, y1); ++y)
        for (int x = left; x < std::min(left + kSide, tile.x1); ++x)
          if (surface_.covered(x, y)) surfaces[count++] = &tile.at(x, y);
      if (count == 0) continue;
      lights_.at({surfaces.data(), count}, tile.near, tile.block, lit);
      for (size_t i = 0; i < count; ++i) tile.lit[size_t(surfaces[i] - tile.surfaces.data())] = std::move(lit[i]);
    }
}

void LightingJudge::judge_pixel(int x, int y, const Tile& tile, RowTally& row) const {
  if (layers_ && layers_->any(x, y)) return judge_layered(x, y, tile, row);
  if (!surface_.covered(x, y)) return judge_uncovered(x, y, row);
  ++row.covered;
  const ShadedSurface& surface = tile.at(x, y);
  const LitRange& lit = tile.lit_at(x, y);
  const Output as_real = output(lit, {}, surface, tile);
  if (lit.undefined || as_real.undefined) return row.take(x, y, PixelClass::undefined, {}, "");
  if (pixel_at(x, y) % sampled_ == 0) keep_power(as_real, row);
  if (!lit.branches.empty()) row.may_be_other(pixel_at(x, y), pixel_at(x, y), 0.5);
  Match nominal;
  fits(lit, as_real, x, y, nominal);
  count_is(lit, x, y, nominal);
  if (nominal.legal) return row.take(x, y, nominal.second ? PixelClass::store_2 : PixelClass::exact, nominal, "");
  const size_t count = lit.branches.size();
  if (count > 0 && count <= kMostBranches) {
    for (size_t set = 1; set < size_t(1) << count; ++set) {
      std::array<double, 3> change{};
      for (size_t i = 0; i < count; ++i)
        for (size_t k = 0; k < 3 && (set >> i & 1) != 0; ++k) change[k] += lit.branches[i].change[k];
      Match m;
      fits(lit, output(lit, change, surface, tile), x, y, m);
      count_is(lit, x, y, m);
      if (m.legal) return row.take(x, y, PixelClass::branch, m, std::to_string(count) + " lights at their threshold");
    }
  } else if (count > kMostBranches) {
    LitRange hull = lit;
    for (const OtherBranch& b : lit.branches)
      for (size_t k = 0; k < 3; ++k) hull.color[k].error += std::fabs(b.change[k]);
    Match m;
    fits(hull, output(hull, {}, surface, tile), x, y, m);
    count_is(hull, x, y, m);
    if (m.legal) return row.take(x, y, PixelClass::branch, m, std::to_string(count) + " lights at their threshold");
  }
  nominal.choices.clear(), nominal.near_thresholds.clear();
  nominal.stored_values = 0;
  row.take(x, y, PixelClass::violation, nominal, "");
}

StageVerdict verdict_by(const LightingJudge& judge, const Pipeline& pipeline, const Profile& profile,
                        const JudgedRows& judged) {
  std::vector<RowTally> rows(size_t(pipeline.height));
  constexpr int kRows = JudgedRows::kBand;
  parallel_for(JudgedRows::bands_of(pipeline.height), 0, [&](int i) {
    if (judged.has_band(i)) judge.judge_rows(i * kRows, std::min((i + 1) * kRows, pipeline.height), rows);
  });
  return verdict_of("lighting", profile, pipeline.width, pipeline.height, rows);
}

/// Whether a pixel that is EXACT by `wide` is no violation by `narrow`, which allows less. Its stores are the nominal
/// ones of values that do not depend on the profile; so they are legal wherever the same store of the same value is.
/// Both profiles are resolved. Floats of 32 bits have no such stores: a range of theirs may become narrower.
bool keeps_exact_pixels(const Profile& wide, const Profile& narrow, const Capture& capture, const Pipeline& pipeline) {
  const PlaneView color = target_of(capture, pipeline);
  const HalfStore nominal = wide.half == HalfStore::either ? wide.likely.half : wide.half;
  const bool is_half_alike = !color.layout.small_float() || narrow.half == HalfStore::either || narrow.half == nominal;
  const Format format = color.image->format;
  const bool has_mesa_codes = color.layout.srgb || format == Format::rgb10_a2 || format == Format::rgba16;
  const bool is_any_mesa =
      narrow.blend == BlendRule::mesa_codes || wide.blend == BlendRule::mesa_codes || wide.likely.mesa_codes;
  return color.quantised() && is_half_alike && !(has_mesa_codes && is_any_mesa) &&
         capture.plane("light.count") == nullptr;
}

}  // namespace

StageVerdict judge_lighting(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                            const Capture& capture, const JudgedRows& rows) {
  if (blends_lights(pipeline.strategy)) return judge_blended(scene, pipeline, profile, capture, rows);
  const Profile p = resolved(profile, pipeline);
  return verdict_by(LightingJudge(scene, pipeline, p, capture, rows), pipeline, p, rows);
}

StageVerdict lighting_violations(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                                 const Capture& capture, const JudgedRows& rows, const JudgedBefore* before) {
  if (blends_lights(pipeline.strategy)) return judge_blended(scene, pipeline, profile, capture, rows);
  const Profile p = resolved(profile, pipeline);
  const StageVerdict* settled = nullptr;
  if (before != nullptr && before->lighting != nullptr && !draws_transparent(scene, pipeline) &&
      allows_all_of(before->profile, profile) &&
      keeps_exact_pixels(resolved(before->profile, pipeline), p, capture, pipeline))
    settled = before->lighting;
  return verdict_by(LightingJudge(scene, pipeline, p, capture, rows, settled), pipeline, p, rows);
}

}  // namespace trueshade::oracle
