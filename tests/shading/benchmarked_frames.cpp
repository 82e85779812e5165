// Frames at the size that is timed: what small frames do not have, clusters in one tile, regions full of lights,
// millions of triangles that meet no sample, comes together here.
#include <string>

#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "shading/frame.h"
#include "tests/catch.hpp"
#include "tests/golden/frames.h"

using namespace trueshade;

TEST_CASE("Frames of 800x800 have their hash by every fast path and by none", "[determinism]") {
  const std::vector<std::string_view> targets = simd_targets();
  const std::string_view narrow = targets.size() > 1 ? targets[targets.size() - 2] : targets.front();  // not scalar
  Execution fast, plain;
  plain.threads = 3, plain.tile = 48, plain.simd = narrow, plain.shuffle_tiles = true;
  plain.compiled_models = plain.fast_geometry = plain.bounded_codes = false;
  std::string loaded;
  Scene scene;
  std::optional<PreparedScene> prepared;
  for (const GoldenFrame& golden : kGoldenFrames) {
    if (golden.width != 800) continue;
    if (loaded != golden.scene) {
      scene = load_scene(std::string(golden.scene));
      prepared.emplace(scene);
      loaded = golden.scene;
    }
    const Pipeline pipeline = *preset_pipeline(golden.preset);
    INFO(golden.scene << " " << golden.preset);
    CHECK(image_hash(render_frame(*prepared, pipeline, fast).color) == golden.hash);
    CHECK(image_hash(render_frame(*prepared, pipeline, plain).color) == golden.hash);
  }
}

TEST_CASE("A million lights of city at constant overlap: the same image with culling and without", "[determinism]") {
  const Scene scene = load_scene("builtin:city,lights=1000000,radius=overlap");
  const PreparedScene prepared(scene);
  for (const char* preset : {"many-lights", "light-volumes"}) {
    Pipeline pipeline = *preset_pipeline(preset);
    pipeline.width = 48, pipeline.height = 32;
    Execution all;
    all.light_culling = false;
    const Frame expected = render_frame(prepared, pipeline, all);
    for (const std::string_view simd : simd_targets()) {
      if (simd == "scalar") continue;  // shares its lists with the others, and takes minutes
      INFO(preset << " " << simd);
      const Frame culled = render_frame(prepared, pipeline, {.simd = simd});
      CHECK(culled.color.texels == expected.color.texels);
      CHECK(culled.stats.tile_pixel_lights * 5 < culled.stats.pixel_lights);
    }
  }
}
