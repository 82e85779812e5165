#include "judge/stages/infer.h"

#include <algorithm>

#include "judge/stages/tally.h"

namespace trueshade::oracle {

namespace {

constexpr const char* kNamed = "profile";  // the knob that named profiles are guesses of

class Inquiry {
 public:
  Inquiry(const Scene& scene, const Pipeline& pipeline, const Capture& capture)
      : scene_(scene), pipeline_(pipeline), capture_(capture) {
    const auto look = [&](const Image& image) {
      if (image.width == 0) return;
      const FormatInfo f = info(image.format);
      unorm_ = unorm_ || f.number_class == NumberClass::unorm;
      half_ = half_ || f.small_float();
    };
    look(capture.color);
    for (const NamedImage& p : capture.planes) look(p.image);
    lit_ = capture.color.width > 0 && capture.plane("normal") != nullptr && capture.plane("albedo") != nullptr &&
           capture.plane(pipeline.gbuffer.position_from_depth ? "depth" : "position") != nullptr;
    loose_.subpixel_bits = 8;
  }

  Inference run() {
    find_grid();
    find_origin();
    find_stores();
    find_name();
    rank();
    result_.tightest = loose_;
    result_.tightest.name = result_.known_as.empty() ? "inferred" : result_.known_as;
    if (const auto known = profile_named(result_.known_as)) result_.tightest = *known;
    return std::move(result_);
  }

 private:
  /// What a guess bears on. The target is judged by the capture's own surfaces, which no grid changes.
  enum class Bears : uint8_t { on_surfaces, on_all_stages };

  /// Counts the pixels of all stages, also where the first one fails: only so can guesses be ranked.
  uint64_t against(const Profile& profile, Bears bears, const char* knob, const std::string& value) {
    Hypothesis guess{knob, value, judge_gbuffer(scene_, pipeline_, profile, capture_).count(PixelClass::violation), {}};
    if (bears == Bears::on_all_stages && lit_)
      guess.lights = judge_lighting(scene_, pipeline_, profile, capture_).count(PixelClass::violation);
    result_.tried.push_back(guess);
    return guess.violations();
  }

  /// Sorts the guesses of each knob; of guesses that are equally good, the likelier one, tried first, stays first.
  void rank() {
    auto& tried = result_.tried;
    for (auto first = tried.begin(); first != tried.end();) {
      const auto end = std::find_if(first, tried.end(), [&](const Hypothesis& h) { return h.knob != first->knob; });
      std::stable_sort(first, end, [](const auto& a, const auto& b) { return a.violations() < b.violations(); });
      if (first->knob == kNamed && result_.known_as.empty()) result_.nearest = first->value;
      first = end;
    }
  }

  void find_grid() {
    struct Grid {
      int bits;
      SnapRule rule;
    };
    // The likeliest first: of those that explain the image, the first is taken.
    constexpr Grid grids[] = {{8, SnapRule::nearest},    {8, SnapRule::toward_zero}, {4, SnapRule::nearest},
                              {6, SnapRule::nearest},    {10, SnapRule::nearest},    {12, SnapRule::nearest},
                              {8, SnapRule::nearest_0_6}};
    for (const Grid& grid : grids) {
      Profile p = loose_;
      p.subpixel_bits = grid.bits;
      p.snap = grid.rule;
      if (against(p, Bears::on_surfaces, "snap", std::to_string(grid.bits) + " bits, " + text(grid.rule)) > 0) continue;
      result_.subpixel_bits = grid.bits;
      result_.snap = grid.rule;
      loose_ = p;
      return;
    }
  }

  void find_origin() {
    Profile snapped = loose_, unsnapped = loose_;
    snapped.plane_origin = PlaneOrigin::snapped;
    unsnapped.plane_origin = PlaneOrigin::unsnapped;
    const bool a = against(snapped, Bears::on_surfaces, "plane origin", "snapped") == 0,
               b = against(unsnapped, Bears::on_surfaces, "plane origin", "unsnapped") == 0;
    if (a || b) result_.plane_origin = a && b ? PlaneOrigin::either : a ? PlaneOrigin::snapped : PlaneOrigin::unsnapped;
    if (a != b) loose_.plane_origin = *result_.plane_origin;
  }

  void find_stores() {
    if (half_) {
      Profile truncated = loose_, nearest = loose_;
      truncated.half = HalfStore::toward_zero;
      nearest.half = HalfStore::nearest;
      const bool a = against(truncated, Bears::on_all_stages, "half", text(truncated.half)) == 0,
                 b = against(nearest, Bears::on_all_stages, "half", text(nearest.half)) == 0;
      if (a || b) result_.half = a && b ? HalfStore::either : a ? HalfStore::toward_zero : HalfStore::nearest;
      if (a != b) loose_.half = *result_.half;
    }
    if (!unorm_) return;
    for (const double reach : {0.5, 0.6, 1.0}) {
      Profile p = loose_;
      p.unorm_reach = reach;
      if (against(p, Bears::on_all_stages, "unorm", "within " + std::to_string(reach).substr(0, 3)) > 0) continue;
      result_.unorm_reach = reach;
      loose_.unorm_reach = reach;
      return;
    }
  }

  void find_name() {
    for (const char* name : {"ideal", "mesa-llvmpipe-22.3", "d3d-class", "unknown"}) {
      if (against(*profile_named(name), Bears::on_all_stages, kNamed, name) > 0) continue;
      result_.known_as = name;
      return;
    }
  }

  const Scene& scene_;
  const Pipeline& pipeline_;
  const Capture& capture_;
  bool unorm_ = false, half_ = false, lit_ = false;
  Profile loose_;
  Inference result_;
};

}  // namespace

Inference infer_profile(const Scene& scene, const Pipeline& pipeline, const Capture& capture) {
  return Inquiry(scene, pipeline, capture).run();
}

std::string text(const Inference& i) {
  std::string line =
      i.subpixel_bits ? std::to_string(*i.subpixel_bits) + " bits, " + text(*i.snap) : "no grid explains it";
  line += std::string("; planes ") + (i.plane_origin ? text(*i.plane_origin) : "of neither origin");
  line += std::string("; half ") + (i.half ? text(*i.half) : "not told");
  line +=
      "; unorm " + (i.unorm_reach ? "within " + std::to_string(*i.unorm_reach).substr(0, 3) : std::string("not told"));
  return line;
}

}  // namespace trueshade::oracle
