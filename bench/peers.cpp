// How fast is the same picture drawn by OpenGL, in the ways people draw many lights with it, on the driver at hand?
// The peers of `trueshade bench`: warm frames, the sum of the passes' times up to glFinish; CPU is of all the driver's
// threads. "Lambert": the shader of other people's figures, max(0, 1 - d/range) * max(0, N.L), Specular::none.
#include "bench/peers.h"

#include <benchmark/benchmark.h>

#include <memory>
#include <string>

#include "gl/driver/designs.h"
#include "scenes/pipeline/presets.h"
#include "scenes/scene.h"

using namespace trueshade;

namespace {

/// A scene and those who draw it, made when the first of them is timed.
struct Loaded {
  std::string spec;
  bool lambert;
  std::unique_ptr<Scene> scene;
  std::unique_ptr<Peers> peers;
  std::vector<Contender> contenders;

  Contender& contender(size_t index) {
    if (scene == nullptr) {
      scene = std::make_unique<Scene>(load_scene(spec));
      Pipeline pipeline = presets().front().pipeline;
      if (lambert) pipeline.light_model.specular = Specular::none;
      peers = gl_peers(*scene, pipeline, {});
      contenders = peers->contenders();
    }
    return contenders[index];
  }
};

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::unique_ptr<Loaded>> all;
  for (const char* scene : {"builtin:city", "builtin:rabbits", "builtin:sphere", "builtin:red"})
    for (const bool lambert : {false, true}) {
      all.push_back(std::make_unique<Loaded>(Loaded{scene, lambert, {}, {}, {}}));
      for (size_t i = 0; i < oracle::kGlDesigns.size(); ++i)
        benchmark::RegisterBenchmark(
            (std::string(scene) + " " + std::string(name_of(oracle::kGlDesigns[i])) + (lambert ? " Lambert" : ""))
                .c_str(),
            [&loaded = *all.back(), i](benchmark::State& state) {
              const Contender& peer = loaded.contender(i);
              peer.draw();
              for (auto _ : state) state.SetIterationTime(peer.draw() * 1e-3);
            })
            ->Unit(benchmark::kMillisecond)
            ->MeasureProcessCPUTime()
            ->UseManualTime();
    }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
