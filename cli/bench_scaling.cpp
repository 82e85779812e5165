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
constexpr ContestRules kRules{7, 1000.0};

/// A scene to be drawn by us alone, ready.
struct ScaledScene {
  Scene scene;
  PreparedScene prepared;
  OwnFrames frames;

  ScaledScene(const PipelineOptions& options, const Execution& execution)
      : scene(scene_of_options(options.scene, options.limits)),
        prepared(scene),
        frames(prepared, pipeline_of(options, scene), execution) {
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
  const std::vector<Timing> timings = contest(contenders, kRules);
  for (size_t i = 0; i < timings.size(); ++i) curve.points.push_back({steps[i].label, steps[i].x, timings[i].median()});
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
    steps.push_back({std::to_string(side) + "x" + std::to_string(side), side * side * 1e-6, scene, execution,
                     Size{side, side}});
  return steps;
}

std::vector<Step> thread_counts(const std::string& scene, Execution execution) {
  std::vector<Step> steps;
  const int most = thread_count(0);
  for (int n = 1; n <= most; n = std::max(n + 1, std::min(2 * n, most))) {
    execution.threads = n;
    steps.push_back({std::to_string(n), double(n), scene, execution});
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

/// What is varied of a scene: size, threads and SIMD target of any; lights of built-in ones; of city, whose generator
/// takes them, lights at constant overlap and triangles too.
std::vector<std::pair<ScalingCurve, std::vector<Step>>> wanted_curves(const std::string& scene,
                                                                      const Execution& execution) {
  const std::vector<int> lights{1, 10, 100, 757, 10000, 100000, 1000000};
  const std::string generator = scene.substr(0, scene.find(','));
  std::vector<std::pair<ScalingCurve, std::vector<Step>>> wanted;
  if (scene.starts_with("builtin:"))
    wanted.push_back({{"Lights, " + generator, "lights", true, {}}, scenes_of(generator + ",lights=", lights, execution)});
  if (generator == "builtin:city") {
    wanted.push_back({{"Lights at constant overlap, " + generator, "lights", true, {}},
                      scenes_of(generator + ",radius=overlap,lights=", lights, execution)});
    wanted.push_back({{"Triangles, " + generator, "triangles", true, {}},
                      scenes_of(generator + ",objects=", {100, 1000, 10000, 100000}, execution, 12)});
  }
  wanted.push_back({{"Pixels, " + scene, "size of the image", true, {}}, sizes(scene, execution)});
  wanted.push_back({{"Threads, " + scene, "threads", false, {}}, thread_counts(scene, execution)});
  wanted.push_back({{"SIMD targets, " + scene, "", false, {}}, targets(scene, execution)});
  return wanted;
}

}  // namespace

std::vector<ScalingCurve> scaling_curves(const BenchOptions& options, const std::string& scene,
                                         const Execution& execution) {
  const auto wanted = wanted_curves(scene, execution);
  ProgressBar bar("scaling", "curves");
  std::vector<ScalingCurve> curves;
  for (const auto& [curve, steps] : wanted) {
    curves.push_back(curve_of(options, curve, steps));
    bar.show(int(curves.size()), int(wanted.size()));
  }
  return curves;
}

}  // namespace trueshade
