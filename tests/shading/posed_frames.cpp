#include "scenes/pipeline/presets.h"
#include "shading/frame.h"
#include "tests/catch.hpp"
#include "tests/scenes/gltf/asset.h"

namespace trueshade {
namespace {

/// A sheet of 20 x 20 vertices over the picture, half of which a joint turns, beside a triangle that stands.
std::string turning_sheet() {
  Asset asset;
  std::vector<float> positions, weights;
  std::vector<uint8_t> joints;
  std::vector<uint16_t> indices;
  constexpr uint16_t kSide = 20;
  for (uint16_t y = 0; y < kSide; ++y)
    for (uint16_t x = 0; x < kSide; ++x) {
      positions.insert(positions.end(), {float(x) / 8.0f - 1.2f, float(y) / 8.0f - 1.2f, 0.0f});
      joints.insert(joints.end(), {uint8_t(x < 10 ? 0 : 1), 0, 0, 0});
      weights.insert(weights.end(), {1.0f, 0.0f, 0.0f, 0.0f});
      const uint16_t at = uint16_t(y * kSide + x);
      if (x + 1 < kSide && y + 1 < kSide)
        for (const int corner : {0, 1, int(kSide), 1, kSide + 1, int(kSide)}) indices.push_back(uint16_t(at + corner));
    }
  asset.accessor(positions, "VEC3");
  asset.accessor(joints, "VEC4");
  asset.accessor(weights, "VEC4");
  asset.accessor(indices, "SCALAR");
  asset.accessor(std::vector<float>{0, 1}, "SCALAR");
  asset.accessor(std::vector<float>{0, 0, 0, 1, 0, 0.6f, 0, 0.8f}, "VEC4");
  asset.accessor(std::vector<float>{0, 0, 0.5f, 1, 0, 0.5f, 0, 1, 0.5f}, "VEC3");
  return asset.gltf(R"("scenes": [{"nodes": [0, 1, 3]}], "skins": [{"joints": [1, 2]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2}, "indices": 3}]},
               {"primitives": [{"attributes": {"POSITION": 6}}]}],
    "nodes": [{"mesh": 0, "skin": 0}, {"children": [2]}, {}, {"mesh": 1}],
    "animations": [{"samplers": [{"input": 4, "output": 5}], "channels": [{"sampler": 0, "target": {"node": 2, "path": "rotation"}}]}])");
}

std::string hash_of(const PreparedScene& prepared) {
  Pipeline pipeline = default_pipeline(prepared.scene());
  pipeline.width = pipeline.height = 128;
  return image_hash(render_frame(prepared, pipeline).color);
}

TEST_CASE("a posed mesh is drawn as if its scene were prepared anew") {
  Scene scene = load_gltf(turning_sheet());
  PreparedScene prepared(scene);
  const std::string at_rest = hash_of(prepared);
  std::string before = at_rest;
  for (const double time : {0.3, 1.0}) {
    set_time(scene, time);
    CHECK(hash_of(prepared) == before);  // what was split is the pose before
    prepared.update();
    const std::string posed = hash_of(prepared);
    CHECK(posed == hash_of(PreparedScene(scene)));
    CHECK(posed != before);
    before = posed;
  }
  set_time(scene, 0.0);
  prepared.update();
  CHECK(hash_of(prepared) == at_rest);
}

}  // namespace
}  // namespace trueshade
