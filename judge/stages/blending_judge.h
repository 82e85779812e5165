#pragma once
// One profile's judgement of a target into which lights are blended one by one. Light by light, where the target was
// seen after each (blending_judge.cpp); or of the last image alone (blended_image.cpp).
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/threads/parallel_for.h"
#include "judge/legal/blend_ways.h"
#include "judge/legal/light_cover.h"
#include "judge/stages/captured_surface.h"
#include "judge/stages/conversions_in_doubt.h"
#include "judge/stages/tied_surfaces.h"
#include "judge/stages/transparent_layers.h"
#include "scenes/pipeline/light_mesh.h"

namespace trueshade::oracle {

/// What is known of a pixel so far: its class, and under judge_blended() also what it may hold.
struct PixelState {
  PixelClass pixel_class = PixelClass::exact;
  double same = 1;     ///< predicted probability that every light drew as nominal
  Texel nominal, all;  ///< by the nominal draws; by any
  Texel likely;        ///< by the nominal draws, rounded as the likely rule has it; floats where it keeps them
  std::array<float, 4> value{}, chance{}, drift{};  ///< sums over the draws: sources, chances of other roundings, with
                                                    ///< their signs
  bool split = false;                               ///< whether the two may differ
  bool is_clamped = false;  ///< a sum kept in floats began beyond 0 and 1, which some keep until they blend (softpipe)
  bool open = false;        ///< a fragment that may be absent could have left anything
  PixelClass doubt = PixelClass::branch;
  int lights_low = 0, lights_high = 0;  ///< fragments of lights in range and facing so far: light.count

  /// Notes that one more draw outputs `source` and leaves `t` by the likely rule. Adds the chance of another rounding
  /// of that draw.
  void draw_likely(const Texel& t, const std::array<Range, 4>& source);
  /// What channel k holds after all draws by the likely rule, with the chance that any of them rounded otherwise.
  LegalTexel likely_channel(size_t k) const;
};

/// Judges one target by one profile. Call in this order: start(), light() for each light, find_layers() if only the
/// last image is judged, verdict().
class BlendingJudge {
 public:
  /// Borrows all but the profile. Throws as CapturedSurface does.
  BlendingJudge(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
                const JudgedRows& judged = {});

  /// Judges the target as it was before the first light: the clear value or, where the pipeline draws one, the base.
  /// Called once, before light().
  ///   given: the target as captured then; null: it was not captured, and what it may hold is carried on to the last
  ///          image
  void start(const Image* given);

  /// Judges one more light; indices come in order from 0. Lights are judged many at a time, so that what a pixel's
  /// lights share is computed once.
  ///   given: the target as captured after the light; null exactly where start() had null
  void light(int index, const Image* given);

  /// Finds the transparent surfaces, which verdict() then blends over what the lights may leave. Only judge_blended()
  /// calls it. It finds nothing where the pipeline blends no surfaces after the lights.
  void find_layers(const Capture& capture);

  /// Judges the lights that are left, and returns what was found in all of them. Called once.
  ///   last: the final image, which is judged too, where the target was not captured light by light; else null
  StageVerdict verdict(std::string_view stage, const Image* last);

 private:
  /// What one row needs, light by light of the batch.
  struct RowWork {
    std::vector<std::vector<FragmentCount>> counts;  ///< of lights with a mesh
    std::vector<uint8_t> drawn, changed;             ///< whether any pixel of the row is
    std::vector<uint32_t> lights;                    ///< of the scene: those that may draw at the pixel at hand
    std::vector<LitApart> lit;                       ///< by its surfaces: tied ones, then the visible one
    std::vector<DrawnFragment> fragments;
    ProgramBounds::Block block;
  };

  template <class Job>
  void each_row(const Job& job) {
    parallel_for(pipeline_.height, 0, [&](int y) {
      if (judged_.has(y)) job(y);
    });
  }
  size_t at(int x, int y) const { return size_t(y) * size_t(pipeline_.width) + size_t(x); }
  const Image& before(size_t i) const { return i == 0 ? before_ : batch_[i - 1]; }
  uint32_t scene_light(size_t i) const { return uint32_t(first_) + uint32_t(i); }  ///< of the batch's light i
  FragmentCount count_at(const RowWork& work, size_t i, int x) const {
    return work.counts[i].empty() ? FragmentCount{1, 1, 1} : work.counts[i][size_t(x)];
  }
  std::span<const TiedSurface> tied_at(int x, int y) const {
    return tied_ != nullptr && first_ > 0 ? tied_->at(x, y) : std::span<const TiedSurface>{};
  }

  void may_be_other(int x, int y, int light, const FragmentCount& count) {
    pixels_[at(x, y)].same *= 1 - double(count.chance_other);
    rows_[size_t(y)].surface_choices.push_back(
        {uint64_t(uint32_t(light)) << 32 | count.triangle, uint32_t(at(x, y)), count.chance_other});
  }

  /// Notes that surfaces may share the visible one's depth at the pixel: such depths are equal for all lights or for
  /// none.
  void may_tie(int x, int y) {
    for (const TiedSurface& t : tied_->at(x, y)) {
      if (t.certain) continue;
      pixels_[at(x, y)].same *= 1 - double(t.chance);
      rows_[size_t(y)].surface_choices.push_back({uint64_t(at(x, y)), uint32_t(at(x, y)), t.chance});
    }
  }

  void judge_batch();
  void judge_row(int y, RowWork& work);
  void judge_pixel(int x, int y, RowWork& work);
  bool as_predicted(int x, int y, size_t i, size_t j, const FragmentCount& count, const RowWork& work) const;
  void fragments(int x, int y, size_t i, size_t j, const FragmentCount& count, RowWork& work) const;
  void judge(int x, int y, int light, const Image* before, const Image* given, std::span<const DrawnFragment> fragments,
             const BlendState& blend);
  void carry(PixelState& p, std::span<const DrawnFragment> fragments, const BlendState& blend);
  Texel kept_in_floats(const DrawnFragment& f, const BlendState& blend, const Texel& sum) const;
  void see_thresholds(const PixelState& p, const DrawnFragment& f, bool added);
  void carry_likely(PixelState& p, const DrawnFragment& f, const BlendState& blend);
  void tell_conversions(const PixelState& p, int x, int y, const PlaneView& view, Match& m);
  void choose_last(const PixelState& p, int x, int y, const PlaneView& view, Match& m);
  void choose(int x, int y, const Texel& before, std::span<const DrawnFragment> drawn, const BlendState& blend,
              const PlaneView& view, Match& m) const;
  void unchanged(int x, int y, size_t i);
  void judge_last(int x, int y, const Image& last);
  void cover(int x, int y);
  void count_lights(int x, int y, size_t i, size_t j, const FragmentCount& count, const RowWork& work);
  FragmentCount visible_count(const ShadedSurface& surface, size_t i, const FragmentCount& count) const;
  void check_count(int x, int y);
  bool fits(const Way& way, const PlaneView& view, int x, int y, Match& m) const;
  void keep(int x, int y, PixelClass c, const Match& m, int light);

  const Scene& scene_;
  const JudgedRows judged_;
  const Pipeline pipeline_;
  const Profile profile_, likely_;
  const PlaneView color_, count_;  ///< the target, and light.count where it was captured
  const std::array<int, 2> drawn_at_;
  const PixelMask& mask_;
  const CapturedSurface captured_;
  LightOutputs outputs_;
  const LightMeshes meshes_;
  const bool multipass_;
  const BlendState blend_;
  const AddedCodes codes_;
  const bool sees_thresholds_;  ///< conversions to codes are looked at: each light's is added to the target's
  const bool keeps_dark_;       ///< a fragment that adds nothing leaves the texel as it is
  std::unique_ptr<TiedSurfaces> tied_;
  std::optional<TransparentLayers> layers_;
  std::vector<uint8_t> covered_;
  std::vector<ShadedSurface> surfaces_;
  std::vector<PixelState> pixels_;
  std::vector<ConversionsInDoubt> in_doubt_;  ///< by row; empty where they are not looked at
  std::vector<RowTally> rows_;
  bool seen_ = false;         ///< targets are handed over
  Image before_;              ///< the first of the batch
  std::vector<Image> batch_;  ///< the target after light first_ and those that follow; empty images where not seen
  int first_ = 0;
  std::vector<LightExtent> extents_;
  std::vector<std::unique_ptr<LightOutline>> outlines_;
};

}  // namespace trueshade::oracle
