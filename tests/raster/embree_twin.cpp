// Built-in scenes against Embree's rays (RELIABILITY R8): every pixel shows the surface the ray hits, or the geometry
// around its centre explains why not.
#include <string>

#include "oracle/embree_rays.h"
#include "scenes/builtin/builtin.h"
#include "tests/catch.hpp"
#include "tests/raster/window_scene.h"

using namespace trueshade;
using namespace trueshade::testing;

namespace {

void compare_with_embree(const std::string& spec, int width, int height) {
  const Scene scene = builtin_scene(spec);
  Pipeline pipeline;
  pipeline.width = width;
  pipeline.height = height;
  const std::string aovs[] = {"id.object", "depth"};
  const Frame frame = render_frame(PreparedScene(scene), pipeline, {}, aovs);
  std::vector<uint32_t> instances;
  std::vector<double> depths;
  for (int y = height - 1; y >= 0; --y)
    for (int x = 0; x < width; ++x) {
      const auto id = uint32_t(frame.aovs[0].image.value(x, y, 0));
      instances.push_back(id == 0 ? oracle::kNoInstance : id - 1);
      depths.push_back(frame.aovs[1].image.value(x, y, 0));
    }
  const auto hits = oracle::embree_visibility(scene, pipeline);
  const oracle::VisibilityReport report = oracle::judge_visibility(scene, pipeline, hits, instances, depths);
  uint64_t covered = 0;
  for (const uint32_t instance : instances) covered += instance != oracle::kNoInstance ? 1 : 0;
  INFO(spec << ": " << report.pixels << " pixels, " << covered << " covered, " << report.disagreements
            << " differ from Embree, which is wrong in " << report.embree_mistakes);
  for (const oracle::UnexplainedPixel& pixel : report.unexplained)
    UNSCOPED_INFO("(" << pixel.x << ", " << pixel.y << "): instance " << int32_t(pixel.instance) << " at depth "
                      << pixel.depth << ", Embree " << int32_t(pixel.expected) << " at " << pixel.expected_depth);
  CHECK(report.unexplained_count == 0);
  CHECK(covered > report.pixels / 20);
  CHECK(report.embree_mistakes <= report.pixels / 10000);  // its float tests, far from the eye
}

}  // namespace

TEST_CASE("All built-in scenes show what Embree's rays hit at 800 x 800, away from edges and depth ties") {
  for (const BuiltinInfo& scene : builtin_scenes()) compare_with_embree(std::string(scene.name), 800, 800);
}

TEST_CASE("Other seeds and odd sizes show what Embree's rays hit") {
  compare_with_embree("city,seed=3", 333, 77);
  compare_with_embree("cornell", 65, 401);
  compare_with_embree("sphere", 1, 300);
}
