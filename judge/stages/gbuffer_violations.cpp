#include <algorithm>
#include <cmath>

#include "judge/legal/allows.h"
#include "judge/stages/gbuffer_judge.h"

namespace trueshade::oracle {

/// The surface that is nominally seen, told by the middles of depths alone; nothing where that is not easy. Each of the
/// others that may cover the sample is behind it by these, so the profile lets it be seen.
std::optional<PossibleSurface> GBufferJudge::nominally_seen(std::span<const PossibleSurface> all, double x, double y,
                                                            TriangleForms& forms) const {
  const GeometryState& state = pipeline_.geometry;
  const bool is_less = state.depth_func == DepthFunc::less || state.depth_func == DepthFunc::lequal;
  if (!is_less && state.depth_func != DepthFunc::greater && state.depth_func != DepthFunc::gequal) return std::nullopt;
  double least = clear_key(state);
  std::optional<PossibleSurface> front;
  for (size_t i = 0; i < all.size(); ++i) {
    PossibleSurface c = all[i];
    if (c.masked) return std::nullopt;
    // The pieces of a triangle follow each other. By a profile that allows more they may be others than here.
    if (i > 0 && all[i - 1].instance == c.instance && all[i - 1].triangle == c.triangle) continue;
    const std::shared_ptr<const TriangleForm>& form = forms.of(c.instance, c.triangle);
    const std::vector<Piece>& pieces = form->pieces();
    for (size_t k = 0; k < pieces.size(); ++k) {
      Coverage cover;
      if (!c.certain || pieces.size() > 1)
        cover = coverage_at(pieces[k], profile_, state.clip_origin, x, y);
      else
        cover.cover = Cover::certain;
      if (cover.cover == Cover::no) continue;
      if (all.size() == 1 && pieces.size() == 1 && c.high < least) {  // whatever its depth is
        if (!cover.nominal) return std::nullopt;
        c.piece = 0;
        return c;
      }
      const SurfacePoint point(pieces[k], form->shape(k), profile_, x, y, SurfacePoint::Within::middle);
      double largest = 0;
      for (const WindowVertex& v : pieces[k].v) largest = std::max(largest, std::fabs(v.z));
      const double z = stored_depth(point, state, profile_, largest).value, key = is_less ? z : -z;
      if (key > least && front) continue;
      if (!(key < least) || !cover.nominal) return std::nullopt;
      least = key, c.piece = uint8_t(k), front = c;
    }
  }
  return front;
}

/// Whether what a pixel shows is legal, told where that is easy.
bool GBufferJudge::is_surely_legal(std::span<const PossibleSurface> all, int x, int y_top,
                                   GBufferMemory& memory) const {
  if (layers_) return false;
  if (all.empty()) return is_clear(x, y_top);
  if (is_clear(x, y_top)) return false;
  const auto seen = nominally_seen(all, x + 0.5, pipeline_.height - 1 - y_top + 0.5, memory.forms);
  return seen && fits_middle(*seen, x, y_top, memory);
}

void GBufferJudge::find_violation(int x, int y_top, GBufferMemory& memory, RowTally& row) const {
  const std::span<const PossibleSurface> all = (wider_ != nullptr ? *wider_ : possible_).at(pixel_of(x, y_top));
  if (is_surely_legal(all, x, y_top, memory)) {
    row.classes.push_back(PixelClass::exact);
    return;
  }
  RowTally aside;
  const int y = pipeline_.height - 1 - y_top;
  judge_pixel(wider_ != nullptr ? memory.narrowed.at(all, x, y) : all, x, y_top, memory, aside);
  const bool is_violation = aside.classes.back() == PixelClass::violation;
  row.classes.push_back(is_violation ? PixelClass::violation : PixelClass::exact);
}

StageVerdict gbuffer_violations(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                                const Capture& capture, const JudgedRows& rows, const JudgedBefore* before) {
  const Profile p = resolved(profile, pipeline);
  const bool is_within =
      before != nullptr && !before->found.surfaces.first.empty() && allows_all_of(before->profile, profile);
  const GBufferJudge judge(scene, pipeline, p, capture, rows, Asked::violations,
                           is_within ? &before->found.surfaces : nullptr,
                           before != nullptr ? before->found.level_hulls : nullptr);
  return verdict_by(judge, pipeline, p, rows);
}

}  // namespace trueshade::oracle
