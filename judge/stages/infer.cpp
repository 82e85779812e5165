#include "judge/stages/infer.h"

#include "judge/stages/tally.h"

namespace trueshade::oracle {

namespace {

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
    result_.tightest = loose_;
    result_.tightest.name = result_.known_as.empty() ? "inferred" : result_.known_as;
    if (const auto known = profile_named(result_.known_as)) result_.tightest = *known;
    return std::move(result_);
  }

 private:
  uint64_t against(const Profile& profile, bool lighting, const char* knob, const std::string& value) {
    uint64_t violations = judge_gbuffer(scene_, pipeline_, profile, capture_).count(PixelClass::violation);
    if (violations == 0 && lighting && lit_)  // the costlier of the two
      violations += judge_lighting(scene_, pipeline_, profile, capture_).count(PixelClass::violation);
    result_.tried.push_back({knob, value, violations});
    return violations;
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
      if (against(p, false, "snap", std::to_string(grid.bits) + " bits, " + text(grid.rule)) > 0) continue;
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
    const bool a = against(snapped, false, "plane origin", "snapped") == 0,
               b = against(unsnapped, false, "plane origin", "unsnapped") == 0;
    if (a || b) result_.plane_origin = a && b ? PlaneOrigin::either : a ? PlaneOrigin::snapped : PlaneOrigin::unsnapped;
    if (a != b) loose_.plane_origin = *result_.plane_origin;
  }

  void find_stores() {
    if (half_) {
      Profile truncated = loose_, nearest = loose_;
      truncated.half = HalfStore::toward_zero;
      nearest.half = HalfStore::nearest;
      const bool a = against(truncated, true, "half", text(truncated.half)) == 0,
                 b = against(nearest, true, "half", text(nearest.half)) == 0;
      if (a || b) result_.half = a && b ? HalfStore::either : a ? HalfStore::toward_zero : HalfStore::nearest;
      if (a != b) loose_.half = *result_.half;
    }
    if (!unorm_) return;
    for (const double reach : {0.5, 0.6, 1.0}) {
      Profile p = loose_;
      p.unorm_reach = reach;
      if (against(p, true, "unorm", "within " + std::to_string(reach).substr(0, 3)) > 0) continue;
      result_.unorm_reach = reach;
      loose_.unorm_reach = reach;
      return;
    }
  }

  void find_name() {
    for (const char* name : {"ideal", "mesa-llvmpipe-22.3", "d3d-class", "unknown"}) {
      if (against(*profile_named(name), true, "profile", name) > 0) continue;
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
