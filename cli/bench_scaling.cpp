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
      : scene(load_scene(options.scene, {}, decode_image)),
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

std::vector<Step> sizes(const Execution& execution) {
  std::vector<Step> steps;
  for (const int side : {200, 400, 800, 1600})
    steps.push_back({std::to_string(side) + "x" + std::to_string(side), side * side * 1e-6, "builtin:city", execution,
                     Size{side, side}});
  return steps;
}

std::vector<Step> thread_counts(Execution execution) {
  std::vector<Step> steps;
  const int most = thread_count(0);
  for (int n = 1; n <= most; n = std::max(n + 1, std::min(2 * n, most))) {
    execution.threads = n;
    steps.push_back({std::to_string(n), double(n), "builtin:city", execution});
  }
  return steps;
}

std::vector<Step> targets(Execution execution) {
  std::vector<Step> steps;
  for (const std::string_view target : simd_targets()) {
    execution.simd = target;
    steps.push_back({std::string(target), double(steps.size()), "builtin:city", execution});
  }
  return steps;
}

}  // namespace

std::vector<ScalingCurve> scaling_curves(const BenchOptions& options, const Execution& execution) {
  const std::vector<int> lights{1, 10, 100, 757, 10000, 100000, 1000000};
  const std::pair<ScalingCurve, std::vector<Step>> wanted[] = {
      {{"Lights, city", "lights", true, {}}, scenes_of("builtin:city,lights=", lights, execution)},
      {{"Lights at constant overlap, city", "lights", true, {}},
       scenes_of("builtin:city,radius=overlap,lights=", lights, execution)},
      {{"Triangles, city", "triangles", true, {}},
       scenes_of("builtin:city,objects=", {100, 1000, 10000, 100000}, execution, 12)},
      {{"Pixels, city", "megapixels", true, {}}, sizes(execution)},
      {{"Threads, city", "threads", false, {}}, thread_counts(execution)},
      {{"SIMD targets, city", "", false, {}}, targets(execution)}};
  ProgressBar bar("scaling", "curves");
  std::vector<ScalingCurve> curves;
  for (const auto& [curve, steps] : wanted) {
    curves.push_back(curve_of(options, curve, steps));
    bar.show(int(curves.size()), int(std::size(wanted)));
  }
  return curves;
}

}  // namespace trueshade
