// How long does a frame of each benchmark scene take, and where does the time go?
// Counters: million triangles submitted a second, ns of one core per evaluated pixel-light, covered pixels, share of
// the CPU time that is geometry. A run first draws the frame with one thread and compares hashes, so no wrong image is
// timed.
#include <benchmark/benchmark.h>

#include <map>
#include <memory>
#include <string>

#include "scenes/pipeline/presets.h"
#include "shading/frame.h"

using namespace trueshade;

namespace {

struct Loaded {
  Scene scene;
  PreparedScene prepared;
  explicit Loaded(const std::string& spec) : scene(load_scene(spec)), prepared(scene) {}
};

const Loaded& loaded(const std::string& spec) {
  static std::map<std::string, std::unique_ptr<Loaded>> scenes;
  auto& slot = scenes[spec];
  if (!slot) slot = std::make_unique<Loaded>(spec);
  return *slot;
}

struct Size {
  int width, height;
};

void draw(benchmark::State& state, const std::string& spec, const std::string& preset, Size size) {
  const Loaded& in = loaded(spec);
  Pipeline pipeline = *preset_pipeline(preset);
  pipeline.width = size.width;
  pipeline.height = size.height;
  Execution one_thread;
  one_thread.threads = 1;
  if (image_hash(render_frame(in.prepared, pipeline, one_thread).color) !=
      image_hash(render_frame(in.prepared, pipeline).color)) {
    state.SkipWithError("one thread and all threads disagree: nothing to time");
    return;
  }
  FrameStats sum;
  for (auto _ : state) {
    const FrameStats s = render_frame(in.prepared, pipeline).stats;
    sum.triangles += s.triangles;
    sum.evaluated_pixel_lights += s.evaluated_pixel_lights;
    sum.covered_pixels = s.covered_pixels;
    sum.core_ms += s.core_ms;
  }
  state.counters["Mtri/s"] = benchmark::Counter(double(sum.triangles) * 1e-6, benchmark::Counter::kIsRate);
  state.counters["ns/pixel-light"] = sum.core_ms.light * 1e6 / double(sum.evaluated_pixel_lights);
  state.counters["covered"] = double(sum.covered_pixels);
  state.counters["geometry share"] = sum.core_ms.geometry() / (sum.core_ms.geometry() + sum.core_ms.light);
}

}  // namespace

int main(int argc, char** argv) {
  for (const char* scene : {"builtin:city", "builtin:rabbits", "builtin:sphere", "builtin:red"})
    for (const Size size : {Size{800, 800}, Size{1920, 1080}})
      benchmark::RegisterBenchmark(
          (std::string(scene) + " many-lights " + std::to_string(size.width) + "x" + std::to_string(size.height))
              .c_str(),
          [=](benchmark::State& state) { draw(state, scene, "many-lights", size); })
          ->Unit(benchmark::kMillisecond)
          ->UseRealTime();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
