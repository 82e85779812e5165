// The last image of strategies that blend: what a pixel may hold, carried through all draws.
#include <algorithm>

#include "judge/stages/blending_judge.h"
#include "judge/stages/judge_blending.h"
#include "judge/stages/thresholds.h"
#include "scenes/pipeline/transparency.h"

namespace trueshade::oracle {

void BlendingJudge::find_layers(const Capture& capture) {
  if (draws_transparent(scene_, pipeline_) && pipeline_.transparency.mode == TransparencyMode::after_lights)
    layers_.emplace(scene_, pipeline_, profile_, capture, judged_);
}

/// A fragment blended into a sum that is kept in floats: of fixed-point targets one between 0 and 1, but for what is
/// stored without blending (softpipe).
Texel BlendingJudge::kept_in_floats(const DrawnFragment& f, const BlendState& blend, const Texel& sum) const {
  std::array<Range, 4> source = f.output.nominal;
  const auto clamp = [&](double& v) {
    if (color_.unorm() && blend.enabled) v = std::clamp(v, 0.0, 1.0);
  };
  for (Range& s : source) clamp(s.value), clamp(s.low), clamp(s.high);
  Texel t = blended_texel(blend, Format::rgba32f, likely_, source, sum);
  const bool has_sign = color_.image->format != Format::r11g11b10f;
  const auto keep = [&](double& v) {
    clamp(v);
    if (!has_sign) v = std::max(v, 0.0);
  };
  for (LegalTexel& c : t) keep(c.nominal), keep(c.low), keep(c.high);
  return t;
}

/// Notes those of a fragment's conversions to codes that may give either of two codes.
///   added: the fragment is blended over the target; otherwise it replaces what was noted
void BlendingJudge::see_thresholds(const PixelState& p, const DrawnFragment& f, bool added) {
  const auto pixel = size_t(&p - pixels_.data()), width = size_t(pipeline_.width);
  const int x = int(pixel % width);
  ConversionsInDoubt& row = in_doubt_[pixel / width];
  for (int k = 0; k < 3; ++k) {
    if (!added) row.replace(x, k);
    const uint32_t before = added ? uint32_t(p.likely[size_t(k)].nominal) : 0;
    const std::optional<NearThreshold> s = near_threshold(f.output.nominal[size_t(k)], color_.layout.largest_code(k),
                                                          profile_.likely.code_reach, before, k);
    if (s) row.add(x, *s);
  }
}

/// Adds the pixel's conversions in doubt to the match, with how many of them gave the upper code by the last image.
void BlendingJudge::tell_conversions(const PixelState& p, int x, int y, const PlaneView& view, Match& m) {
  constexpr size_t kMost = 32;  // of one sum
  for (int k = 0; k < 3; ++k) {
    const std::span<const NearThreshold> doubts = in_doubt_[size_t(y)].at(x, k);
    const double nominal = p.likely[size_t(k)].nominal;
    if (doubts.empty() || doubts.size() > kMost) continue;
    if (nominal >= color_.layout.largest_code(k) - double(doubts.size())) continue;  // it may have been clamped
    const auto lower = nominal - double(std::count_if(doubts.begin(), doubts.end(),
                                                      [](const NearThreshold& s) { return s.nominal_above; }));
    const double uppers = view.stored(x, y, k) - lower;
    if (uppers < 0 || uppers > double(doubts.size())) continue;
    for (size_t i = 0; i < doubts.size(); ++i) {
      NearThreshold s = doubts[i];
      s.sum_of = uint8_t(doubts.size() - i), s.uppers = uint8_t(uppers);
      m.near_thresholds.push_back(s);
    }
  }
}

/// Carries p.likely, what the likely rule leaves, through a fragment's nominal draws.
void BlendingJudge::carry_likely(PixelState& p, const DrawnFragment& f, const BlendState& blend) {
  const bool in_floats = profile_.likely.sums_in_floats;
  if (in_floats && color_.unorm() && !blend.enabled)
    for (int k = 0; k < color_.channels; ++k) {
      const Range& s = f.output.nominal[size_t(k)];
      p.is_clamped = p.is_clamped || s.low < 0 || s.high > 1;
    }
  for (int i = 0; i < f.nominal; ++i) {
    if (sees_thresholds_) see_thresholds(p, f, blend.enabled);
    p.draw_likely(in_floats ? kept_in_floats(f, blend, p.likely)
                            : likely_texel(blend, color_.image->format, profile_, likely_, f.likely_source(), p.likely),
                  f.output.nominal);
  }
}

/// Sets m.choices of the last image: for each channel, whether it was stored as the likely rule leaves it after all
/// draws. Sums of equal sources are one choice. Adds nothing where the draws themselves are in doubt.
void BlendingJudge::choose_last(const PixelState& p, int x, int y, const PlaneView& view, Match& m) {
  m.choices.clear();
  if (!view.quantised() || p.split || p.is_clamped || (layers_ && layers_->any(x, y))) return;
  for (int k = 0; k < view.channels; ++k) {
    LegalTexel t = p.likely_channel(size_t(k));
    if (profile_.likely.sums_in_floats) {
      const Range sum{t.nominal, t.low, t.high};
      t = legal_texel(sum, color_.image->format, k, likely_);
    }
    const double given = view.stored(x, y, k);
    if (given == t.nominal && !(t.second_chance > 0)) continue;
    StoreChoice c = choice_of(view, k, uint32_t(at(x, y)), double(p.value[size_t(k)]), t, given, profile_);
    if (given >= t.low && given <= t.high) c.chance = float(std::max(t.second_chance, 1e-3));
    m.choices.push_back(c);
  }
  if (sees_thresholds_) tell_conversions(p, x, y, view, m);
}

/// Carries what the pixel may hold through fragments, for draws that were not seen: p.nominal, p.all and p.likely.
void BlendingJudge::carry(PixelState& p, std::span<const DrawnFragment> fragments, const BlendState& blend) {
  const Format format = color_.image->format;
  for (const DrawnFragment& f : fragments) {
    if (!f.output.undefined && color_.quantised()) carry_likely(p, f, blend);
    if (f.output.undefined) {
      if (f.least > 0)
        p.pixel_class = PixelClass::undefined;
      else
        p.open = true;
      continue;
    }
    const auto drawn = [&](Texel t, const std::array<Range, 4>& source, int times) {
      for (int i = 0; i < times; ++i) t = blended_texel(blend, format, profile_, source, t);
      return t;
    };
    const bool doubt = f.least < f.most || f.output.either_way;
    const Texel nominal = drawn(p.nominal, f.output.nominal, f.nominal);
    if (doubt && (!p.split || worse(f.least < f.most ? f.doubt : PixelClass::branch, p.doubt)))
      p.doubt = f.least < f.most ? f.doubt : PixelClass::branch;
    if (!p.split && !doubt) {
      p.nominal = p.all = nominal;
      continue;
    }
    p.split = true;
    std::optional<Texel> all;
    for (int times = f.least; times <= f.most; ++times)
      for (const bool other : {false, true}) {
        if (other && (!f.output.either_way || times == 0)) continue;
        const Texel t = drawn(p.all, other ? f.output.other : f.output.nominal, times);
        for (size_t k = 0; k < 4 && all; ++k) (*all)[k] = hull((*all)[k], t[k]);
        if (!all) all = t;
      }
    p.nominal = nominal, p.all = *all;
  }
}

/// Draws the transparent surfaces over what the pixel may hold.
void BlendingJudge::cover(int x, int y) {
  PixelState& p = pixels_[at(x, y)];
  const TransparentPixel pixel = layers_->at(x, y);
  if (pixel.layers.empty()) return;
  CarriedTexel carried{p.nominal, p.split ? p.all : p.nominal, p.split, p.open, p.doubt};
  layers_->carry(pixel, carried);
  p.nominal = carried.nominal, p.all = carried.all, p.split = carried.split, p.open = carried.open;
  p.doubt = carried.doubt;
  for (const TransparentLayer& layer : pixel.layers)
    if (!layer.certain) p.same *= 1 - double(layer.chance_other);
}

/// Judges what the last image holds at a pixel by what it may hold, unless the pixel is UNDEFINED already, and records
/// it.
void BlendingJudge::judge_last(int x, int y, const Image& last) {
  PixelState& p = pixels_[at(x, y)];
  if (p.pixel_class == PixelClass::undefined) return;
  const PlaneView view_of_last(&last);
  const auto judged = [&](const Texel& texel, Match& m) {
    Way way;
    way.texel = texel;
    for (size_t k = 0; k < 4; ++k) way.value[k] = texel[k].nominal;
    return fits(way, view_of_last, x, y, m);
  };
  Match m;
  if (judged(p.nominal, m)) {
    p.pixel_class = m.second ? PixelClass::store_2 : PixelClass::exact;
  } else if (Match other; p.split && judged(p.all, other)) {
    p.pixel_class = p.doubt;
    m = other;
  } else if (p.open) {
    p.pixel_class = PixelClass::undefined;
  } else {
    p.pixel_class = PixelClass::violation;
  }
  if (p.pixel_class == PixelClass::exact || p.pixel_class == PixelClass::store_2)
    choose_last(p, x, y, view_of_last, m);
  else
    m.choices.clear();
  rows_[size_t(y)].record(x, y, p.pixel_class, m, "after all lights");
}

StageVerdict judge_blended(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
                           const JudgedRows& rows) {
  BlendingJudge judge(scene, pipeline, resolved(profile, pipeline), capture, rows);
  judge.start(nullptr);
  for (size_t i = 0; i < scene.lights.size(); ++i) judge.light(int(i), nullptr);
  judge.find_layers(capture);
  return judge.verdict("lighting", &capture.color);
}

}  // namespace trueshade::oracle
