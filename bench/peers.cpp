// How fast is the same picture drawn by OpenGL, in the ways people draw many lights with it, on the driver at hand?
// Warm frames, the sum of the passes' times up to glFinish. The first counter is the driver's geometry pass alone.
#include <benchmark/benchmark.h>

#include <map>
#include <memory>
#include <string>

#include "oracle/gl/designs.h"
#include "scenes/presets.h"
#include "scenes/scene.h"

using namespace trueshade;
using oracle::GlDesign;

namespace {

struct Loaded {
  Scene scene;
  oracle::GlRenderer renderer;
  Loaded(const oracle::GlContext& context, const std::string& spec) : scene(load_scene(spec)), renderer(context, scene) {}
};

void draw(benchmark::State& state, const oracle::GlContext& context, const std::string& spec, GlDesign design) {
  static std::map<std::string, std::unique_ptr<Loaded>> scenes;
  auto& loaded = scenes[spec];
  if (!loaded) loaded = std::make_unique<Loaded>(context, spec);
  oracle::GlPeer peer(loaded->renderer, presets().front().pipeline, design);
  peer.draw(false);
  double first_ms = 0.0;
  for (auto _ : state) {
    const oracle::GlFrame frame = peer.draw(false);
    double ms = 0.0;
    for (const oracle::GlPass& pass : frame.passes) ms += pass.ms;
    state.SetIterationTime(ms * 1e-3);
    first_ms += frame.passes.empty() ? 0.0 : frame.passes.front().ms;
  }
  state.counters["first pass ms"] = benchmark::Counter(first_ms, benchmark::Counter::kAvgIterations);
}

}  // namespace

int main(int argc, char** argv) {
  const oracle::GlContext context(oracle::GlDriver::any);
  for (const char* scene : {"builtin:city", "builtin:rabbits", "builtin:sphere", "builtin:red"})
    for (const GlDesign design : oracle::kGlDesigns)
      benchmark::RegisterBenchmark((std::string(scene) + " " + std::string(name_of(design))).c_str(),
                                   [&context, scene, design](benchmark::State& state) { draw(state, context, scene, design); })
          ->Unit(benchmark::kMillisecond)
          ->UseManualTime();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
