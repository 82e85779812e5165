#include <algorithm>
#include <memory>

#include "cli/bench.h"
#include "cli/commands.h"
#include "cli/own_frames.h"
#include "cli/preparation.h"
#include "cli/progress_bar.h"
#include "core/image_files/image_io.h"
#include "core/threads/parallel_for.h"

namespace trueshade {
namespace {

constexpr double kSlowMs = 1000.0;  ///< frames that take longer are not followed by ten times as much
constexpr ContestRules kRules{7, 1000.0}, kQuickRules{3, 300.0};

Scene shown_scene(const PipelineOptions& options) {
  Scene scene = scene_of_options(options);
  show(scene, options.camera, pipeline_of(options, scene), 0.0);
  return scene;
}

/// A scene to be drawn by us alone, ready.
struct ScaledScene {
  Scene scene;
  PreparedScene prepared;
  OwnFrames frames;

  ScaledScene(const PipelineOptions& options, const Execution& execution)
      : scene(shown_scene(options)), prepared(scene), frames(prepared, pipeline_of(options, scene), execution) {
    frames.checked_hash(simd_targets()[simd_targets().size() > 1 ? 1 : 0]);
  }
};

/// One value of what is varied.
struct Step {
  std::string label;
  double x;
  std::string scene;
  Execution execution;
  std::optional<Size> size = {};
  int threads = 0;  ///< where they are what is varied
};

/// All of a curve's frames are drawn in turn.
ScalingCurve curve_of(const BenchOptions& options, ScalingCurve curve, const std::vector<Step>& steps) {
  std::vector<std::unique_ptr<ScaledScene>> scenes;
  std::vector<Contender> contenders;
  for (const Step& step : steps) {
    PipelineOptions own = options;
    own.scene = step.scene;
    if (step.size) own.size = step.size;
    scenes.push_back(std::make_unique<ScaledScene>(own, step.execution));
    OwnFrames& frames = scenes.back()->frames;
    contenders.push_back({"trueshade", step.label, [&frames] { return frames.draw(); }});
    if (frames.draw() > kSlowMs) break;  // lights that end nowhere, every pixel
  }
  const std::vector<Timing> timings = contest(contenders, options.quick ? kQuickRules : kRules);
  for (size_t i = 0; i < timings.size(); ++i)
    curve.points.push_back({steps[i].label, steps[i].x, timings[i], steps[i].threads});
  return curve;
}

std::vector<Step> scenes_of(const std::string& spec, const std::vector<int>& counts, const Execution& execution,
                            int times = 1) {
  std::vector<Step> steps;
  for (const int count : counts)
    steps.push_back({std::to_string(count * times), double(count) * times, spec + std::to_string(count), execution});
  return steps;
}

std::vector<Step> sizes(const std::string& scene, const Execution& execution) {
  std::vector<Step> steps;
  for (const int side : {200, 400, 800, 1600})
    steps.push_back(
        {std::to_string(side) + "x" + std::to_string(side), side * side * 1e-6, scene, execution, Size{side, side}});
  return steps;
}

std::vector<Step> thread_counts(const std::string& scene, Execution execution) {
  std::vector<Step> steps;
  const int most = thread_count(0);
  for (int n = 1; n <= most; n = std::max(n + 1, std::min(2 * n, most))) {
    execution.threads = n;
    steps.push_back({std::to_string(n), double(n), scene, execution, {}, n});
  }
  return steps;
}

std::vector<Step> targets(const std::string& scene, Execution execution) {
  std::vector<Step> steps;
  for (const std::string_view target : simd_targets()) {
    execution.simd = target;
    steps.push_back({std::string(target), double(steps.size()), scene, execution});
  }
  return steps;
}

/// A built-in scene's text without these of its values: `builtin:city,objects=60,lights=9` without lights is
/// `builtin:city,objects=60`.
std::string without(const std::string& spec, std::initializer_list<std::string_view> keys) {
  std::string kept;
  for (size_t begin = 0; begin <= spec.size();) {
    const size_t end = std::min(spec.find(',', begin), spec.size());
    const std::string part = spec.substr(begin, end - begin);
    const bool is_left_out = std::any_of(
        keys.begin(), keys.end(), [&part](std::string_view key) { return part.starts_with(std::string(key) + '='); });
    if (!is_left_out) kept += (kept.empty() ? "" : ",") + part;
    begin = end + 1;
  }
  return kept;
}

/// What is varied of a scene, all else of it as it was measured: size, threads and SIMD target of any; lights of
/// built-in ones; of city, whose generator takes them, lights at constant overlap and triangles too.
std::vector<std::pair<ScalingCurve, std::vector<Step>>> wanted_curves(const std::string& scene, uint64_t own_lights,
                                                                      const Execution& execution) {
  std::vector<int> lights;
  constexpr uint64_t kApart = 3;  // so that the labels of neighbours have room beside each other
  for (const uint64_t count : std::initializer_list<uint64_t>{1, 10, 100, 1000, 10000, 100000, 1000000})
    if (count > own_lights * kApart || count * kApart < own_lights) lights.push_back(int(count));
  if (own_lights > 0 && own_lights < 1000000) lights.push_back(int(own_lights));
  std::sort(lights.begin(), lights.end());
  const std::string unlit = without(scene, {"lights"}), even = without(scene, {"lights", "radius"}),
                    empty = without(scene, {"objects"});
  std::vector<std::pair<ScalingCurve, std::vector<Step>>> wanted;
  if (scene.starts_with("builtin:"))
    wanted.push_back(
        {{"Lights, " + unlit, "More lights of the same range, so that more of them overlap.", "lights", true, {}},
         scenes_of(unlit + ",lights=", lights, execution)});
  if (scene.starts_with("builtin:city")) {
    wanted.push_back({{"Lights at constant overlap, " + even,
                       "More lights, each reaching less far, so that a pixel has about as many.",
                       "lights",
                       true,
                       {}},
                      scenes_of(even + ",radius=overlap,lights=", lights, execution)});
    wanted.push_back(
        {{"Triangles, " + empty, "More cubes of twelve triangles on the same ground.", "triangles", true, {}},
         scenes_of(empty + ",objects=", {100, 1000, 10000, 100000}, execution, 12)});
  }
  wanted.push_back(
      {{"Pixels, " + scene, "Square images of other sizes.", "size of the image", true, {}}, sizes(scene, execution)});
  wanted.push_back({{"Threads, " + scene, "The same frame on fewer threads.", "threads", false, {}},
                    thread_counts(scene, execution)});
  wanted.push_back({{"SIMD targets, " + scene,
                     "The same frame by each SIMD target that this build has and this CPU runs.",
                     "",
                     false,
                     {}},
                    targets(scene, execution)});
  return wanted;
}

}  // namespace

std::vector<std::string> scaling_reasons(const std::vector<ScalingCurve>& curves, int cores) {
  std::vector<NamedTiming> rows;
  for (const ScalingCurve& curve : curves)
    for (const ScalingCurve::Point& point : curve.points)
      rows.push_back({'"' + curve.title + "\" at " + point.label, &point.timing, point.threads});
  std::vector<std::string> reasons;
  for (const std::string& reason : {spread_reason(rows), threads_reason(rows, cores)})
    if (!reason.empty()) reasons.push_back(reason);
  return reasons;
}

std::vector<ScalingCurve> scaling_curves(const BenchOptions& options, const std::string& scene, uint64_t lights,
                                         const Execution& execution) {
  const auto wanted = wanted_curves(scene, lights, execution);
  ProgressBar bar("scaling", "curves");
  std::vector<ScalingCurve> curves;
  for (const auto& [curve, steps] : wanted) {
    curves.push_back(curve_of(options, curve, steps));
    bar.show(int(curves.size()), int(wanted.size()));
  }
  return curves;
}

}  // namespace trueshade
