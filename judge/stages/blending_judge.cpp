#include "judge/stages/blending_judge.h"

#include <algorithm>
#include <cstring>

#include "judge/stages/thresholds.h"
#include "scenes/pipeline/transparency.h"

namespace trueshade::oracle {

namespace {

constexpr size_t kBatchBytes = size_t(160) << 20;  // of targets that wait to be judged together
constexpr int kMostLights = 64;                    // that do

Texel texel_of(const Image& image, int x, int y) {
  const PlaneView view(&image);
  Texel t;
  for (int k = 0; k < view.channels; ++k) t[size_t(k)] = known_texel(view.stored(x, y, k));
  return t;
}

/// Whether rows hold the same bits.
bool same_row(const Image& a, const Image& b, int y) {
  return std::memcmp(a.texel(0, y), b.texel(0, y), a.row_bytes()) == 0;
}

}  // namespace

void PixelState::draw_likely(const Texel& t, const std::array<Range, 4>& source) {
  likely = t;
  for (size_t k = 0; k < 4; ++k) {
    value[k] += float(source[k].value);
    chance[k] += float(t[k].second_chance);
    drift[k] += float(t[k].second_chance) * float(t[k].second_side);
  }
}

LegalTexel PixelState::likely_channel(size_t k) const {
  LegalTexel t = likely[k];
  t.second_chance = std::min(1.0, double(chance[k]));
  t.second_side = drift[k] < 0 ? -1 : 1;
  return t;
}

BlendingJudge::BlendingJudge(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                             const Capture& capture, const JudgedRows& judged)
    : scene_(scene),
      judged_(judged),
      pipeline_(pipeline),
      profile_(profile),
      likely_(following(profile.likely, profile)),
      color_(target_of(capture, pipeline)),
      count_(plane_of(capture, pipeline, "light.count")),
      drawn_at_(capture.drawn_at),
      mask_(capture.mask),
      captured_(scene, pipeline, profile, capture),
      outputs_(scene, pipeline, profile),
      meshes_(pipeline.light_volumes),
      multipass_(pipeline.strategy == Strategy::forward_multipass),
      blend_(multipass_ ? kAddLight : pipeline.blend),
      codes_(color_.image->format, blend_),
      sees_thresholds_(converts_as_seen(color_, profile) && blend_.enabled && blend_.rgb == kAccumulate &&
                       blend_.mask[0] && blend_.mask[1] && blend_.mask[2]),
      keeps_dark_(!color_.layout.srgb && blend_.enabled && blend_.rgb == kAccumulate &&
                  (!blend_.mask[3] || color_.channels < 4)) {
  require_planes_of(outputs_.program(), capture);
  const size_t pixels = size_t(pipeline.width) * size_t(pipeline.height);
  covered_.resize(pixels);
  surfaces_.resize(pixels);
  pixels_.resize(pixels);
  if (sees_thresholds_) in_doubt_.resize(size_t(pipeline.height));
  rows_.resize(size_t(pipeline.height));
  each_row([&](int y) {
    for (int x = 0; x < pipeline_.width; ++x)
      if (!mask_.has(x, y) && (covered_[at(x, y)] = captured_.covered(x, y) ? 1 : 0) != 0) {
        surfaces_[at(x, y)] = captured_.at(x, y);
        ++rows_[size_t(y)].covered;
      }
  });
  if (multipass_) tied_ = std::make_unique<TiedSurfaces>(scene, pipeline, profile, capture, judged);
}

void BlendingJudge::start(const Image* given) {
  seen_ = given != nullptr;
  if (seen_) before_ = *given;
  const bool drawn = multipass_ ? scene_.lights.empty() : pipeline_.light_volumes.base;
  const auto cleared = [this](const Profile& by) {
    std::array<Range, 4> out;
    for (size_t k = 0; k < 4; ++k)
      out[k] = cleared_range(double(scene_.clear[int(k)]), color_.image->format, int(k), by);
    return out;
  };
  each_row([&](int y) {
    for (int x = 0; x < pipeline_.width; ++x) {
      if (mask_.has(x, y)) continue;
      LightOutput out;
      out.nominal = cleared(profile_);
      if (drawn && covered_[at(x, y)] != 0) out = outputs_.start(surfaces_[at(x, y)]);
      DrawnFragment only{out, 1, 1, 1, PixelClass::exact};
      if (!drawn || covered_[at(x, y)] == 0) only.likely = cleared(likely_);
      judge(x, y, -1, nullptr, given, {&only, 1}, BlendState{});
    }
  });
}

void BlendingJudge::light(int index, const Image* given) {
  if (batch_.empty()) first_ = index;
  batch_.push_back(given != nullptr ? *given : Image{});
  const bool alone = multipass_ && index == 0;  // the one that is stored, with what the sum starts from
  const size_t most = seen_ ? kBatchBytes / std::max<size_t>(1, before_.texels.size()) : size_t(kMostLights);
  if (alone || batch_.size() >= std::clamp<size_t>(most, 1, size_t(kMostLights))) judge_batch();
}

StageVerdict BlendingJudge::verdict(std::string_view stage, const Image* last) {
  if (!batch_.empty()) judge_batch();
  each_row([&](int y) {
    RowTally& row = rows_[size_t(y)];
    for (int x = 0; x < pipeline_.width; ++x) {
      if (mask_.has(x, y)) {
        row.leave_out();
        continue;
      }
      PixelState& p = pixels_[at(x, y)];
      if (layers_ && layers_->any(x, y)) cover(x, y);
      if (last != nullptr) judge_last(x, y, *last);
      check_count(x, y);
      row.classes.push_back(p.pixel_class);
      if (p.same >= 1) continue;
      ++row.ambiguous;
      row.predicted_other += 1 - p.same;
    }
  });
  return verdict_of(stage, profile_, pipeline_.width, pipeline_.height, rows_);
}

/// Judges the lights that wait, over all rows with every core, and keeps the target after the last of them for the next
/// batch.
void BlendingJudge::judge_batch() {
  const size_t count = batch_.size();
  const std::span<const Light> lights = std::span(scene_.lights).subspan(size_t(first_), count);
  extents_.assign(count, LightExtent::unbounded);
  outlines_.clear();
  outlines_.resize(count);
  if (multipass_ && outputs_.discards_beyond_extent())  // a pass leaves out what is beyond the light's range
    for (size_t k = 0; k < count; ++k)
      if (drawn_extent(lights[k], pipeline_.light_volumes) != LightExtent::unbounded) extents_[k] = LightExtent::range;
  if (!multipass_)
    parallel_for(int(count), 0, [&](int k) {
      const Light& light = lights[size_t(k)];
      const LightExtent extent = extents_[size_t(k)] = drawn_extent(light, pipeline_.light_volumes);
      if (is_mesh(extent))
        outlines_[size_t(k)] =
            std::make_unique<LightOutline>(scene_, pipeline_, profile_, drawn_at_, light, meshes_[extent]);
    });
  each_row([&](int y) {
    RowWork work;
    work.block.counts = bool(count_);
    judge_row(y, work);
  });
  if (seen_) before_ = std::move(batch_.back());
  batch_.clear();
}

/// Judges one row under all lights of the batch. Does nothing where none may draw and nothing changed.
void BlendingJudge::judge_row(int y, RowWork& work) {
  const size_t count = batch_.size();
  work.counts.resize(count), work.drawn.assign(count, 1), work.changed.assign(count, 0);
  bool any = false;
  for (size_t i = 0; i < count; ++i) {
    if (outlines_[i]) {
      work.counts[i].resize(size_t(pipeline_.width));
      outlines_[i]->count_row(pipeline_.height - 1 - y, work.counts[i]);
      work.drawn[i] =
          std::any_of(work.counts[i].begin(), work.counts[i].end(), [](const FragmentCount& c) { return c.most > 0; });
    }
    if (seen_) work.changed[i] = !same_row(before(i), batch_[i], y);
    any = any || work.drawn[i] != 0 || work.changed[i] != 0;
  }
  for (int x = 0; x < pipeline_.width && any; ++x)
    if (!mask_.has(x, y)) judge_pixel(x, y, work);
}

/// Judges one pixel under all lights of the batch, one after the other.
void BlendingJudge::judge_pixel(int x, int y, RowWork& work) {
  const std::span<const TiedSurface> tied = tied_at(x, y);
  const bool covered = covered_[at(x, y)] != 0, shown = covered || !tied.empty();
  work.lights.clear();
  for (size_t i = 0; i < batch_.size(); ++i) {
    if (shown && work.drawn[i] != 0 && count_at(work, i, x).most > 0)
      work.lights.push_back(uint32_t(first_) + uint32_t(i));
    else if (work.changed[i] != 0)
      unchanged(x, y, i);
  }
  if (multipass_ && first_ == 1) may_tie(x, y);
  if (work.lights.empty()) return;
  work.lit.resize(std::max(work.lit.size(), tied.size() + 1));
  const bool stored = multipass_ && first_ == 0;
  for (size_t t = 0; t < tied.size(); ++t) outputs_.terms(tied[t].surface, work.lights, work.block, work.lit[t]);
  if (covered && !stored) outputs_.terms(surfaces_[at(x, y)], work.lights, work.block, work.lit[tied.size()]);
  for (size_t j = 0; j < work.lights.size(); ++j) {
    const size_t i = work.lights[j] - size_t(first_);
    const FragmentCount count = count_at(work, i, x);
    const int light = first_ + int(i);
    if (count.least < count.most) may_be_other(x, y, light, count);
    if (count_) count_lights(x, y, i, j, count, work);
    if (!stored && as_predicted(x, y, i, j, count, work)) {
      if (color_.quantised()) rows_[size_t(y)].stored_values += uint64_t(color_.channels);
      continue;
    }
    fragments(x, y, i, j, count, work);
    judge(x, y, light, seen_ ? &before(i) : nullptr, seen_ ? &batch_[i] : nullptr, work.fragments,
          stored ? BlendState{} : blend_);
  }
}

/// Whether the light's draw is EXACT and has nothing to tell: no fragment adds anything and nothing changed, or the
/// only one there is added its nominal codes.
bool BlendingJudge::as_predicted(int x, int y, size_t i, size_t j, const FragmentCount& count,
                                 const RowWork& work) const {
  if (!seen_ || !keeps_dark_ || !outputs_.are_terms_outputs()) return false;
  const std::span<const TiedSurface> tied = tied_at(x, y);
  const bool covered = covered_[at(x, y)] != 0;
  const uint8_t *old = before(i).texel(x, y), *now = batch_[i].texel(x, y);
  const auto dark = [&](const LitApart& lit) {
    const Bounded3& c = lit.color[j];
    return lit.one_outcome[j] != 0 &&
           std::all_of(c.begin(), c.end(), [](const Bounded& b) { return b.value == 0 && b.error <= kSmallestFloat; });
  };
  bool all_dark = !covered || dark(work.lit[tied.size()]);
  for (size_t t = 0; t < tied.size() && all_dark; ++t) all_dark = dark(work.lit[t]);
  if (all_dark) return std::memcmp(old, now, size_t(color_.layout.bytes_per_texel())) == 0;
  if (!codes_.suit() || !tied.empty() || count.least != 1 || count.most != 1) return false;
  if (work.lit[0].one_outcome[j] == 0) return false;
  if (!codes_.as_predicted(work.lit[0].color[j], old, now)) return false;
  return extents_[i] != LightExtent::range || outputs_.in_range(surfaces_[at(x, y)], scene_light(i)).surely;
}

/// How often the visible surface is a fragment of the light: what covers it, or a comparison with the light's range.
FragmentCount BlendingJudge::visible_count(const ShadedSurface& surface, size_t i, const FragmentCount& count) const {
  if (multipass_ && first_ == 0) return count;
  if (outputs_.is_unlit(surface)) return {0, 0, 0};
  if (extents_[i] != LightExtent::range) return count;
  const LightOutputs::InRange in = outputs_.in_range(surface, scene_light(i));
  return {uint8_t(in.surely), uint8_t(in.perhaps), uint8_t(in.nominally)};
}

/// Adds what a light may add to light.count: once, or as often as it is drawn.
void BlendingJudge::count_lights(int x, int y, size_t i, size_t j, const FragmentCount& count, const RowWork& work) {
  PixelState& p = pixels_[at(x, y)];
  const auto add = [&](const LightOutputs::Lit& lit, int least, int most) {
    p.lights_low += lit.surely ? std::min(least, 1) : 0;
    p.lights_high += lit.perhaps ? most : 0;
  };
  const std::span<const TiedSurface> tied = tied_at(x, y);
  if (covered_[at(x, y)] != 0) {
    const ShadedSurface& surface = surfaces_[at(x, y)];
    const bool stored = multipass_ && first_ == 0;
    const FragmentCount drawn = visible_count(surface, i, count);
    add(stored ? outputs_.lit(surface, scene_light(i)) : outputs_.lit(work.lit[tied.size()], j), drawn.least,
        drawn.most);
  }
  for (size_t t = 0; t < tied.size(); ++t)  // once for the visible surface, or for each
    add(outputs_.lit(work.lit[t], j), 0, visible_count(tied[t].surface, i, {1, 1, 1}).most);
}

/// Holds light.count at a pixel, where it was captured, against the lights counted: makes the pixel a violation where
/// it is another.
void BlendingJudge::check_count(int x, int y) {
  PixelState& p = pixels_[at(x, y)];
  if (!count_ || covered_[at(x, y)] == 0 || p.pixel_class == PixelClass::undefined) return;
  const double lights = count_.stored(x, y, 0);
  if (lights >= p.lights_low && lights <= p.lights_high) return;
  Match m;
  m.note("light.count", 0, {double(p.lights_low), double(p.lights_low), double(p.lights_high)}, lights, 1);
  p.pixel_class = PixelClass::violation;
  rows_[size_t(y)].record(x, y, p.pixel_class, m, "after all lights");
}

/// Sets work.fragments to those of light i of the batch, which is work.lights[j], in order of submission: of the tied
/// surfaces and of the visible one.
void BlendingJudge::fragments(int x, int y, size_t i, size_t j, const FragmentCount& count, RowWork& work) const {
  work.fragments.clear();
  const std::span<const TiedSurface> tied = tied_at(x, y);
  const auto output = [&](const ShadedSurface& surface, const LitApart& lit) {
    return lit.one_outcome[j] != 0 ? outputs_.of_color(surface, lit.color[j]) : outputs_.term(surface, scene_light(i));
  };
  const auto add_tied = [&](bool before) {
    for (size_t t = 0; t < tied.size(); ++t)
      if (const int sure = tied[t].certain ? 1 : 0; tied[t].before == before) {
        const FragmentCount drawn = visible_count(tied[t].surface, i, {1, 1, 1});
        work.fragments.push_back({output(tied[t].surface, work.lit[t]), std::min<int>(sure, drawn.least), drawn.most,
                                  std::min<int>(sure, drawn.nominal), PixelClass::depth_tie});
      }
  };
  add_tied(true);
  if (covered_[at(x, y)] != 0) {
    const ShadedSurface& surface = surfaces_[at(x, y)];
    const bool stored = multipass_ && first_ == 0;
    const FragmentCount drawn = visible_count(surface, i, count);
    const PixelClass doubt = extents_[i] == LightExtent::range ? PixelClass::branch
                             : count.cut                       ? PixelClass::clip
                                                               : PixelClass::edge;
    const DrawnFragment f{stored ? outputs_.first(surface) : output(surface, work.lit[tied.size()]), drawn.least,
                          drawn.most, drawn.nominal, doubt};
    work.fragments.push_back(f);
  }
  add_tied(false);
}

/// Whether a texel is one that a way leaves. Adds what was found of its channels to `m`.
bool BlendingJudge::fits(const Way& way, const PlaneView& view, int x, int y, Match& m) const {
  for (int k = 0; k < view.channels; ++k) {
    const LegalTexel& t = way.texel[size_t(k)];
    const double value = view.quantised() ? way.value[k] : t.nominal;
    m.texel_is(view, "color", k, t, value, view.stored(x, y, k), uint32_t(at(x, y)), profile_);
  }
  return m.legal;
}

/// Sets m.choices to the roundings of a draw that went the nominal way: what its fragments make of a known texel by the
/// nominal rule, and what was stored. Equal sources on equal texels are one choice; of codes that are added the source
/// alone decides.
void BlendingJudge::choose(int x, int y, const Texel& before, std::span<const DrawnFragment> drawn,
                           const BlendState& blend, const PlaneView& view, Match& m) const {
  m.choices.clear();
  if (!view.quantised()) return;
  PixelState p;
  p.likely = before;
  for (const DrawnFragment& f : drawn)
    for (int i = 0; i < f.nominal; ++i)
      p.draw_likely(likely_texel(blend, color_.image->format, profile_, likely_, f.likely_source(), p.likely),
                    f.output.nominal);
  const bool codes_add = view.unorm() && !view.layout.srgb && blend.rgb == kAccumulate;
  for (size_t k = 0; k < size_t(view.channels); ++k) {
    const LegalTexel t = p.likely_channel(k);
    const double given = view.stored(x, y, int(k));
    if (given == t.nominal && !(t.second_chance > 0)) continue;
    const double value = double(p.value[k]), choice = codes_add || !blend.enabled ? value : value + before[k].nominal;
    m.choices.push_back(choice_of(view, int(k), uint32_t(at(x, y)), choice, t, given, profile_));
  }
}

/// Gives a pixel the worse of its class and c, and records what was found of a light's draw (below 0: before the
/// lights).
void BlendingJudge::keep(int x, int y, PixelClass c, const Match& m, int light) {
  PixelState& p = pixels_[at(x, y)];
  if (worse(c, p.pixel_class)) p.pixel_class = c;
  const bool told = c != PixelClass::exact && c != PixelClass::store_2;
  rows_[size_t(y)].record(x, y, c, m,
                          !told       ? std::string()
                          : light < 0 ? std::string("before the first light")
                                      : "light " + std::to_string(light));
}

/// Judges a pixel at which light i of the batch draws nothing: a changed texel is a violation.
void BlendingJudge::unchanged(int x, int y, size_t i) {
  const Image &old = before(i), &now = batch_[i];
  if (std::memcmp(now.texel(x, y), old.texel(x, y), size_t(color_.layout.bytes_per_texel())) == 0) return;
  Way way;
  way.texel = texel_of(old, x, y);
  Match m;
  if (!fits(way, PlaneView(&now), x, y, m)) keep(x, y, PixelClass::violation, m, first_ + int(i));
}

/// Judges one draw at a pixel by what the target held before it (null: nothing) and what it holds after it (`given`).
/// Where the latter is null, it was not seen, and what the pixel may hold is carried on.
void BlendingJudge::judge(int x, int y, int light, const Image* before, const Image* given,
                          std::span<const DrawnFragment> fragments, const BlendState& blend) {
  PixelState& p = pixels_[at(x, y)];
  if (given == nullptr) return carry(p, fragments, blend);
  std::vector<DrawnFragment> known;  // a fragment that may be absent, and says nothing: only where nothing else fits
  for (const DrawnFragment& f : fragments) {
    if (f.output.undefined && f.least > 0) return keep(x, y, PixelClass::undefined, {}, light);
    if (!f.output.undefined) known.push_back(f);
  }
  const Texel from = before != nullptr ? texel_of(*before, x, y) : Texel{};
  const std::vector<Way> list = ways_from(from, known, blend, color_.image->format, profile_);
  const PlaneView view(given);
  Match closest;
  for (size_t i = 0; i < list.size(); ++i) {
    Match m;
    if (fits(list[i], view, x, y, m)) {
      m.choices.clear();
      if (list.size() == 1 && known.size() == fragments.size())  // else another way may be the one that was gone
        choose(x, y, from, known, blend, view, m);
      const PixelClass c =
          list[i].pixel_class == PixelClass::exact && m.second ? PixelClass::store_2 : list[i].pixel_class;
      return keep(x, y, c, m, light);
    }
    if (i == 0 || m.excess < closest.excess) closest = m;
  }
  if (known.size() < fragments.size()) return keep(x, y, PixelClass::undefined, {}, light);
  closest.choices.clear();
  closest.stored_values = 0;
  keep(x, y, PixelClass::violation, closest, light);
}

}  // namespace trueshade::oracle
