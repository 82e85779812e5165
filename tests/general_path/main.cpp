// Draws every golden frame of 200x150 that its build can draw, on the program's best SIMD target, and compares the hashes.
// Prints each frame that differs; exits with 1 where one does.
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>

#include "core/fp_env.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "shading/frame.h"
#include "tests/golden/frames.h"

int main() {
  using namespace trueshade;
  const FpScope fp;
  std::string loaded;
  Scene scene;
  std::optional<PreparedScene> prepared;
  int frames = 0, different = 0;
  for (const GoldenFrame& golden : kGoldenFrames) {
    if (golden.width != 200) continue;
    if (loaded != golden.scene) {
      prepared.reset();
      scene = builtin_scene(std::string_view(golden.scene).substr(sizeof "builtin:" - 1), {});
      prepared.emplace(scene);
      loaded = golden.scene;
    }
    Pipeline pipeline = *preset_pipeline(golden.preset);
    if (pipeline.light_program.used() && !draws_light_programs()) continue;  // the picture's build has no glslang
    pipeline.width = golden.width, pipeline.height = golden.height;
    ++frames;
    if (image_hash(render_frame(*prepared, pipeline, {}).color) == golden.hash) continue;
    ++different;
    std::printf("%s %s differs\n", std::string(golden.scene).c_str(), std::string(golden.preset).c_str());
  }
  std::printf("%d frames, %d different\n", frames, different);
  return different == 0 && frames > 0 ? 0 : 1;
}
