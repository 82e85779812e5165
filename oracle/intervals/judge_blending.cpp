#include "oracle/intervals/judge_blending.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>

#include "core/error.h"
#include "core/fp_env.h"
#include "oracle/intervals/blend_range.h"
#include "oracle/intervals/captured_surface.h"
#include "oracle/intervals/light_cover.h"
#include "oracle/intervals/light_output.h"
#include "oracle/intervals/tied_surfaces.h"
#include "oracle/intervals/transparent_layers.h"
#include "scenes/light_mesh.h"
#include "scenes/transparency.h"

namespace trueshade::oracle {

namespace {

constexpr size_t kMostWays = 64;  // of drawing a pixel that are tried apart

/// One fragment of a light's draw at a pixel, as often as it may be there.
struct DrawnFragment {
  LightOutput output;
  int least = 1, most = 1, nominal = 1;
  PixelClass doubt = PixelClass::edge;  ///< of another number of them than the nominal one
};

/// How a pixel got from one texel to the next: how often each fragment was there, and which way a comparison went.
struct Way {
  PixelClass pixel_class = PixelClass::exact;
  Texel texel;
  double value[4] = {};  ///< of the last fragment
};

/// What a pixel was found to be so far; under judge_blended() also what it may hold.
struct PixelState {
  PixelClass pixel_class = PixelClass::exact;
  double same = 1;     ///< predicted probability that every light drew as nominal
  Texel nominal, all;  ///< by the nominal draws; by any
  bool split = false;  ///< whether the two may differ
  bool open = false;   ///< a fragment that may be absent could have left anything
  PixelClass doubt = PixelClass::branch;
};

class BlendingJudge {
 public:
  BlendingJudge(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture)
      : scene_(scene),
        pipeline_(pipeline),
        profile_(profile),
        color_(target_of(capture, pipeline)),
        drawn_at_(capture.drawn_at),
        captured_(scene, pipeline, profile, capture),
        outputs_(scene, pipeline, profile),
        meshes_(pipeline.light_volumes),
        multipass_(pipeline.strategy == Strategy::forward_multipass),
        blend_(multipass_ ? kAddLight : pipeline.blend) {
    const size_t pixels = size_t(pipeline.width) * size_t(pipeline.height);
    covered_.resize(pixels);
    surfaces_.resize(pixels);
    pixels_.resize(pixels);
    rows_.resize(size_t(pipeline.height));
    each_row([&](int y) {
      for (int x = 0; x < pipeline_.width; ++x)
        if ((covered_[at(x, y)] = captured_.covered(x, y) ? 1 : 0) != 0) {
          surfaces_[at(x, y)] = captured_.at(x, y);
          ++rows_[size_t(y)].covered;
        }
    });
    if (multipass_) tied_ = std::make_unique<TiedSurfaces>(scene, pipeline, profile, capture);
  }

  /// The target before the first light. `given`: what it was seen to be; null: not seen.
  void start(const Image* given) {
    before_ = given != nullptr ? *given : Image{};
    const bool drawn = multipass_ ? scene_.lights.empty() : pipeline_.light_volumes.base;
    each_row([&](int y) {
      for (int x = 0; x < pipeline_.width; ++x) {
        LightOutput out;
        for (size_t k = 0; k < 4; ++k) {
          const double c = double(scene_.clear[int(k)]);
          out.nominal[k] = {c, c, c};
        }
        if (drawn && covered_[at(x, y)] != 0) out = outputs_.start(surfaces_[at(x, y)]);
        judge(x, y, given, -1, {DrawnFragment{out, 1, 1, 1, PixelClass::exact}}, BlendState{});
      }
    });
  }

  void light(int index, const Image* given) {
    const Light& light = scene_.lights[size_t(index)];
    outputs_.set_light(light);
    const LightExtent extent = multipass_ ? LightExtent::unbounded : drawn_extent(light, pipeline_.light_volumes);
    std::optional<LightOutline> outline;
    if (is_mesh(extent)) outline.emplace(scene_, pipeline_, profile_, drawn_at_, light, meshes_[extent]);
    each_row([&](int y) {
      std::vector<FragmentCount> counts(size_t(pipeline_.width), FragmentCount{1, 1, 1});
      if (outline) outline->count_row(pipeline_.height - 1 - y, counts);
      for (int x = 0; x < pipeline_.width; ++x) {
        if (covered_[at(x, y)] == 0 && !(multipass_ && index > 0)) {
          unchanged(x, y, given, index);
          continue;
        }
        const FragmentCount& count = counts[size_t(x)];
        if (count.most == 0) {
          unchanged(x, y, given, index);
          continue;
        }
        if (count.least < count.most) may_be_other(x, y, index, count);
        const bool first = multipass_ && index == 0;
        if (multipass_ && index == 1) may_tie(x, y);
        judge(x, y, given, index, fragments(x, y, index, count, extent), first ? BlendState{} : blend_);
      }
    });
    if (given != nullptr) before_ = *given;
  }

  /// Surfaces blended over what the lights may leave: of judge_blended().
  void find_layers(const Capture& capture) {
    if (draws_transparent(scene_, pipeline_) && pipeline_.transparency.mode == TransparencyMode::after_lights)
      layers_.emplace(scene_, pipeline_, profile_, capture);
  }

  StageVerdict verdict(std::string_view stage, const Image* last) {
    each_row([&](int y) {
      RowTally& row = rows_[size_t(y)];
      for (int x = 0; x < pipeline_.width; ++x) {
        PixelState& p = pixels_[at(x, y)];
        if (layers_ && layers_->any(x, y)) cover(x, y);
        if (last != nullptr) judge_last(x, y, *last);
        row.classes.push_back(p.pixel_class);
        if (p.same >= 1) continue;
        ++row.ambiguous;
        row.predicted_other += 1 - p.same;
      }
    });
    return verdict_of(stage, profile_, pipeline_.width, pipeline_.height, rows_);
  }

 private:
  template <class Job>
  void each_row(const Job& job) {
    parallel_for(pipeline_.height, 0, [&](int y) { job(y); });
  }
  size_t at(int x, int y) const { return size_t(y) * size_t(pipeline_.width) + size_t(x); }

  void may_be_other(int x, int y, int light, const FragmentCount& count) {
    pixels_[at(x, y)].same *= 1 - double(count.chance_other);
    rows_[size_t(y)].surface_choices.push_back({uint64_t(uint32_t(light)) << 32 | count.triangle, count.chance_other});
  }

  /// Depths that may be equal are so for all lights or for none.
  void may_tie(int x, int y) {
    for (const TiedSurface& t : tied_->at(x, y)) {
      if (t.certain) continue;
      pixels_[at(x, y)].same *= 0.5;
      rows_[size_t(y)].surface_choices.push_back({uint64_t(at(x, y)), 0.5f});
    }
  }

  std::vector<DrawnFragment> fragments(int x, int y, int light, const FragmentCount& count, LightExtent extent);
  void ways(const Texel& from, std::span<const DrawnFragment> fragments, const BlendState& blend,
            std::vector<Way>& out) const;
  void judge(int x, int y, const Image* given, int light, std::span<const DrawnFragment> fragments,
             const BlendState& blend);
  void judge(int x, int y, const Image* given, int light, const std::vector<DrawnFragment>& list,
             const BlendState& blend) {
    judge(x, y, given, light, std::span<const DrawnFragment>(list), blend);
  }
  void carry(PixelState& p, std::span<const DrawnFragment> fragments, const BlendState& blend) const;
  void unchanged(int x, int y, const Image* given, int light);
  void judge_last(int x, int y, const Image& last);
  void cover(int x, int y);
  bool fits(const Way& way, const PlaneView& view, int x, int y, Match& m) const;
  void keep(int x, int y, PixelClass c, const Match& m, int light);

  const Scene& scene_;
  const Pipeline pipeline_;
  const Profile profile_;
  const PlaneView color_;
  const std::array<int, 2> drawn_at_;
  const CapturedSurface captured_;
  LightOutputs outputs_;
  const LightMeshes meshes_;
  const bool multipass_;
  const BlendState blend_;
  std::unique_ptr<TiedSurfaces> tied_;
  std::optional<TransparentLayers> layers_;
  std::vector<uint8_t> covered_;
  std::vector<ShadedSurface> surfaces_;
  std::vector<PixelState> pixels_;
  std::vector<RowTally> rows_;
  Image before_;
};

Texel texel_of(const Image& image, int x, int y) {
  const PlaneView view(&image);
  Texel t;
  for (int k = 0; k < view.channels; ++k) t[size_t(k)] = known_texel(view.stored(x, y, k));
  return t;
}

std::vector<DrawnFragment> BlendingJudge::fragments(int x, int y, int light, const FragmentCount& count,
                                                    LightExtent extent) {
  std::vector<DrawnFragment> list;
  const auto visible = [&] {
    const ShadedSurface& surface = surfaces_[at(x, y)];
    DrawnFragment f{multipass_ && light == 0 ? outputs_.first(surface) : outputs_.term(surface), count.least,
                    count.most, count.nominal, count.cut ? PixelClass::clip : PixelClass::edge};
    if (extent == LightExtent::range) {
      const LightOutputs::InRange in = outputs_.in_range(surface);
      f.least = in.surely, f.most = in.perhaps, f.nominal = in.nominally, f.doubt = PixelClass::branch;
    }
    list.push_back(f);
  };
  const std::span<const TiedSurface> tied =
      tied_ != nullptr && light > 0 ? tied_->at(x, y) : std::span<const TiedSurface>{};
  const auto add_tied = [&](bool before) {
    for (const TiedSurface& t : tied)
      if (t.before == before)
        list.push_back({outputs_.term(t.surface), t.certain ? 1 : 0, 1, t.certain ? 1 : 0, PixelClass::depth_tie});
  };
  add_tied(true);
  if (covered_[at(x, y)] != 0) visible();
  add_tied(false);
  return list;
}

/// Every way from a known texel on, the nominal one first; more than kMostWays of them: the nominal one and the hull of
/// all.
void BlendingJudge::ways(const Texel& from, std::span<const DrawnFragment> fragments, const BlendState& blend,
                         std::vector<Way>& out) const {
  out.clear();
  size_t count = 1;
  for (const DrawnFragment& f : fragments) count *= size_t(f.most - f.least + 1) * (f.output.either_way ? 2 : 1);
  std::vector<Way> list{Way{PixelClass::exact, from, {}}}, next;
  const Format format = color_.image->format;
  for (const DrawnFragment& f : fragments) {
    next.clear();
    for (const Way& way : list)
      for (int turn = 0; turn <= f.most - f.least; ++turn) {
        const int times = turn == 0 ? f.nominal : f.least + turn - (f.least + turn <= f.nominal ? 1 : 0);
        for (int branch = 0; branch < (f.output.either_way ? 2 : 1); ++branch) {
          Way w = way;
          if (times != f.nominal && worse(f.doubt, w.pixel_class)) w.pixel_class = f.doubt;
          if (branch == 1 && worse(PixelClass::branch, w.pixel_class)) w.pixel_class = PixelClass::branch;
          const std::array<Range, 4>& source = branch == 1 ? f.output.other : f.output.nominal;
          for (int i = 0; i < times; ++i) w.texel = blended_texel(blend, format, profile_, source, w.texel);
          for (size_t k = 0; k < 4 && times > 0; ++k) w.value[k] = source[k].value;
          next.push_back(w);
          if (times == 0) break;
        }
      }
    if (count > kMostWays && next.size() > 2) {
      for (size_t i = 2; i < next.size(); ++i) {
        for (size_t k = 0; k < 4; ++k) next[1].texel[k] = hull(next[1].texel[k], next[i].texel[k]);
        if (worse(next[i].pixel_class, next[1].pixel_class)) next[1].pixel_class = next[i].pixel_class;
      }
      next.resize(2);
    }
    std::swap(list, next);
  }
  out = std::move(list);
}

bool BlendingJudge::fits(const Way& way, const PlaneView& view, int x, int y, Match& m) const {
  for (int k = 0; k < view.channels; ++k) {
    const LegalTexel& t = way.texel[size_t(k)];
    const double value = view.quantised() ? way.value[k] : t.nominal;
    m.texel_is(view, "color", k, t, value, view.stored(x, y, k), uint32_t(at(x, y)), profile_);
  }
  return m.legal;
}

void BlendingJudge::keep(int x, int y, PixelClass c, const Match& m, int light) {
  PixelState& p = pixels_[at(x, y)];
  if (worse(c, p.pixel_class)) p.pixel_class = c;
  rows_[size_t(y)].record(x, y, c, m, light < 0 ? "before the first light" : "light " + std::to_string(light));
}

void BlendingJudge::unchanged(int x, int y, const Image* given, int light) {
  if (given == nullptr) return;
  const size_t bytes = size_t(color_.layout.bytes_per_texel());
  if (std::memcmp(given->texel(x, y), before_.texel(x, y), bytes) == 0) return;
  Way way;
  way.texel = texel_of(before_, x, y);
  Match m;
  if (!fits(way, PlaneView(given), x, y, m)) keep(x, y, PixelClass::violation, m, light);
}

/// What the pixel may hold after the fragments, from what it may hold before them.
void BlendingJudge::carry(PixelState& p, std::span<const DrawnFragment> fragments, const BlendState& blend) const {
  const Format format = color_.image->format;
  for (const DrawnFragment& f : fragments) {
    if (f.output.undefined) {
      if (f.least > 0) p.pixel_class = PixelClass::undefined;
      if (f.least == 0) {
        p.open = true;
        continue;
      }
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

void BlendingJudge::judge(int x, int y, const Image* given, int light, std::span<const DrawnFragment> fragments,
                          const BlendState& blend) {
  PixelState& p = pixels_[at(x, y)];
  if (given == nullptr) return carry(p, fragments, blend);
  std::vector<DrawnFragment> known;  // a fragment that may be absent, and says nothing: only where nothing else fits
  for (const DrawnFragment& f : fragments) {
    if (f.output.undefined && f.least > 0) return keep(x, y, PixelClass::undefined, {}, light);
    if (!f.output.undefined) known.push_back(f);
  }
  const Texel from = light < 0 ? Texel{} : texel_of(before_, x, y);
  std::vector<Way> list;
  ways(from, known, blend, list);
  const PlaneView view(given);
  Match closest;
  for (size_t i = 0; i < list.size(); ++i) {
    Match m;
    if (fits(list[i], view, x, y, m)) {
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

void BlendingJudge::judge_last(int x, int y, const Image& last) {
  PixelState& p = pixels_[at(x, y)];
  if (p.pixel_class == PixelClass::undefined) return;
  const PlaneView view(&last);
  const auto judged = [&](const Texel& texel, Match& m) {
    Way way;
    way.texel = texel;
    for (size_t k = 0; k < 4; ++k) way.value[k] = texel[k].nominal;
    return fits(way, view, x, y, m);
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
  m.choices.clear();
  rows_[size_t(y)].record(x, y, p.pixel_class, m, "after all lights");
}

}  // namespace

StageVerdict judge_blending(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                            const Capture& capture, const LightSteps& steps) {
  BlendingJudge judge(scene, pipeline, resolved(profile, pipeline), capture);
  int expected = -1;
  steps([&](int light, const Image& target) {
    if (light != expected || target.width != pipeline.width || target.height != pipeline.height ||
        target.format != capture.color.format)
      throw Error(ErrorKind::bad_input, "target after light " + std::to_string(light), "is not the one that comes next",
                  "hand over -1 and then each light, in the capture's size and format");
    if (light < 0)
      judge.start(&target);
    else
      judge.light(light, &target);
    ++expected;
  });
  if (expected != int(scene.lights.size()))
    throw Error(ErrorKind::bad_input, "capture", "ends after " + std::to_string(expected) + " lights",
                "hand over the target after each light");
  return judge.verdict("blending", nullptr);
}

StageVerdict judge_blended(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                           const Capture& capture) {
  BlendingJudge judge(scene, pipeline, resolved(profile, pipeline), capture);
  judge.start(nullptr);
  for (size_t i = 0; i < scene.lights.size(); ++i) judge.light(int(i), nullptr);
  judge.find_layers(capture);
  return judge.verdict("lighting", &capture.color);
}

}  // namespace trueshade::oracle
