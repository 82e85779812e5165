// How fast is the same picture drawn by OpenGL, in the ways people draw many lights with it, on the driver at hand?
// Warm frames, the sum of the passes' times up to glFinish; CPU is of all the driver's threads. "first pass ms" is the
// driver's geometry pass alone.
// The fast designs cull back faces, as their users would, where that changes at most one pixel in 50,000.
// "Lambert": the shader of other people's figures, max(0, 1 - d/range) * max(0, N.L), Specular::none.
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
  int culling_changes = -1;  ///< pixels, once counted
  Loaded(const oracle::GlContext& context, const std::string& spec)
      : scene(load_scene(spec)), renderer(context, scene) {}
};

/// The designs a user who wants speed would take.
bool is_fast(GlDesign design) {
  return design == GlDesign::tiled || design == GlDesign::forward_plus || design == GlDesign::deferred_volumes;
}

/// Pixels that are not the same without back faces: none inside closed meshes, a few where a silhouette's edges round,
/// many where faces of two objects coincide.
int pixels_culling_changes(oracle::GlRenderer& renderer, Pipeline pipeline) {
  const Image all = oracle::GlPeer(renderer, pipeline, GlDesign::tiled).draw(true).capture.color;
  pipeline.geometry.cull_face = CullFace::back;
  const Image front = oracle::GlPeer(renderer, pipeline, GlDesign::tiled).draw(true).capture.color;
  int count = 0;
  for (int y = 0; y < all.height; ++y)
    for (int x = 0; x < all.width; ++x) {
      bool same = true;
      for (int k = 0; k < 4; ++k) same = same && all.value(x, y, k) == front.value(x, y, k);
      count += same ? 0 : 1;
    }
  return count;
}

void draw(benchmark::State& state, const oracle::GlContext& context, const std::string& spec, GlDesign design, bool lambert) {
  static std::map<std::string, std::unique_ptr<Loaded>> scenes;
  auto& loaded = scenes[spec];
  if (!loaded) loaded = std::make_unique<Loaded>(context, spec);
  Pipeline pipeline = presets().front().pipeline;
  if (lambert) pipeline.light_model.specular = Specular::none;
  if (loaded->culling_changes < 0) loaded->culling_changes = pixels_culling_changes(loaded->renderer, pipeline);
  const int changed = loaded->culling_changes;
  const bool culled = is_fast(design) && changed <= pipeline.width * pipeline.height / 50000;
  if (culled) pipeline.geometry.cull_face = CullFace::back;
  oracle::GlPeer peer(loaded->renderer, pipeline, design);
  peer.draw(false);
  double first_ms = 0.0;
  for (auto _ : state) {
    const oracle::GlFrame frame = peer.draw(false);
    double ms = 0.0;
    for (const oracle::GlPass& pass : frame.passes) ms += pass.ms;
    state.SetIterationTime(ms * 1e-3);
    first_ms += frame.passes.empty() ? 0.0 : frame.passes.front().ms;
  }
  state.counters["pixels culling changes"] = changed;
  state.counters["culled"] = culled;
  state.counters["first pass ms"] = benchmark::Counter(first_ms, benchmark::Counter::kAvgIterations);
}

}  // namespace

int main(int argc, char** argv) {
  const oracle::GlContext context(oracle::GlDriver::any);
  for (const char* scene : {"builtin:city", "builtin:rabbits", "builtin:sphere", "builtin:red"})
    for (const GlDesign design : oracle::kGlDesigns)
      for (const bool lambert : {false, true})
        benchmark::RegisterBenchmark(
            (std::string(scene) + " " + std::string(name_of(design)) + (lambert ? " Lambert" : "")).c_str(),
            [&context, scene, design, lambert](benchmark::State& state) { draw(state, context, scene, design, lambert); })
            ->Unit(benchmark::kMillisecond)
            ->MeasureProcessCPUTime()
            ->UseManualTime();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
