// A frame of a scene that lies in a cache file is the frame of the scene as it is read.
#include "tests/catch.hpp"
#include "tests/scene_cache/cached.h"
#include "tests/scenes/gltf/asset.h"

namespace trueshade {
namespace {

void check_cached(const std::string& spec, double time = 0.0) {
  INFO(spec);
  const ScratchFolder cache;
  const std::string expected = plain_hash(spec, time);
  int loads = 0;
  CHECK(cached_hash(cache.path(""), spec, loads, time) == expected);
  CHECK(cache.entries().size() == 1);
  for (const int threads : {1, 2, 7})
    for (const std::string_view simd : simd_targets())
      CHECK(cached_hash(cache.path(""), spec, loads, time, {.threads = threads, .simd = simd}) == expected);
  CHECK(cached_hash(cache.path(""), spec, loads, time, {.fast_geometry = false}) == expected);
  CHECK(loads == 1);
}

TEST_CASE("built-in scenes are drawn from their cache files by every SIMD target and number of threads") {
  for (const char* spec : {"builtin:city", "builtin:atrium", "builtin:rabbits"}) check_cached(spec);
}

/// A sheet that a joint turns and a morph target moves, with texture coordinates and colours.
std::string moving_sheet() {
  Asset asset;
  asset.accessor(std::vector<float>{-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0}, "VEC3");
  asset.accessor(std::vector<uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}, "VEC4");
  asset.accessor(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  asset.accessor(std::vector<uint16_t>{0, 1, 2, 0, 2, 3}, "SCALAR");
  asset.accessor(std::vector<float>{0, 1}, "SCALAR");
  asset.accessor(std::vector<float>{0, 0, 0, 1, 0, 0.6f, 0, 0.8f}, "VEC4");
  asset.accessor(std::vector<float>{0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3");
  asset.accessor(std::vector<float>{0, 0, 1, 0, 1, 1, 0, 1}, "VEC2");
  asset.accessor(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}, "VEC3");
  return asset.gltf(R"("scenes": [{"nodes": [0, 1]}], "skins": [{"joints": [1, 2]}],
    "meshes": [{"weights": [0.5], "primitives": [{"attributes": {"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2,
      "TEXCOORD_0": 7, "TEXCOORD_1": 7, "COLOR_0": 8}, "indices": 3, "targets": [{"POSITION": 6}]}]}],
    "nodes": [{"mesh": 0, "skin": 0}, {"children": [2]}, {}],
    "animations": [{"samplers": [{"input": 4, "output": 5}], "channels": [{"sampler": 0, "target": {"node": 2, "path": "rotation"}}]}])");
}

TEST_CASE("a mesh that deforms is drawn from its cache file at every time") {
  const ScratchFolder folder;
  const std::string spec = folder.write("sheet.gltf", moving_sheet());
  let_files_settle();
  CHECK(plain_hash(spec, 0.0) != plain_hash(spec, 0.7));
  for (const double time : {0.0, 0.7}) check_cached(spec, time);
}

TEST_CASE("scene files with patterns, steps, grids and masks are drawn from their cache files") {
  const ScratchFolder folder;
  const std::string spec = folder.write("scene.json", R"({"version": 1, "camera": {"eye": [0, 2, 5]},
    "textures": [{"name": "squares", "pattern": {"type": "checker", "size": [64, 64]}}],
    "materials": [{"name": "tiles", "color": [1, 1, 1], "color_map": {"texture": "squares"}, "alpha_cutoff": 0.5},
                  {"name": "glass", "color": [0.2, 0.4, 1, 0.5], "transparent": true}],
    "lights": [{"type": "point", "position": [2, 3, 2], "color": [9, 8, 7]}],
    "objects": [{"mesh": "plane", "material": "tiles", "scale": 4},
                {"mesh": "knot", "color": [1, 0.5, 0.2], "grid": {"count": [2, 1, 2], "spacing": 2}},
                {"mesh": "rabbit", "material": "glass",
                 "steps": [{"time": 0, "position": [0, 0, 0]}, {"time": 1, "position": [0, 1, 1]}]}]})");
  let_files_settle();
  for (const double time : {0.0, 0.5}) check_cached(spec, time);
}

}  // namespace
}  // namespace trueshade
