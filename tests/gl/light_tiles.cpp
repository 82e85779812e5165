// Lists of lights by tile leave out no light that lights a pixel.
#include "gl/driver/light_tiles.h"

#include <cstdio>

#include "gl/emit/light_text.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "shading/frame.h"
#include "tests/catch.hpp"

using namespace trueshade;
using namespace trueshade::oracle;

namespace {

constexpr int kWidth = 200, kHeight = 150;

struct Shown {
  Image position, normal;
  std::vector<float> depth;      ///< row 0 at the bottom
  std::vector<uint16_t> halves;  ///< RGBA
};

Shown shown(const Scene& scene, const Pipeline& pipeline) {
  Frame frame =
      render_frame(PreparedScene(scene), pipeline, {}, std::vector<std::string>{"depth", "position", "normal"});
  Shown s;
  for (NamedImage& plane : frame.aovs) {
    for (int y = kHeight - 1; y >= 0; --y)
      for (int x = 0; x < kWidth; ++x) {
        if (plane.name == "depth") s.depth.push_back(float(plane.image.value(x, y, 0)));
        for (int k = 0; k < 4 && plane.name == "normal"; ++k) s.halves.push_back(uint16_t(plane.image.code(x, y, k)));
      }
    if (plane.name == "position")
      s.position = std::move(plane.image);
    else if (plane.name == "normal")
      s.normal = std::move(plane.image);
  }
  return s;
}

bool lights(const Shown& s, const Light& light, int x, int y) {
  double d2 = 0, n_l = 0;
  for (int k = 0; k < 3; ++k) {
    const double o = double(light.position[k]) - s.position.value(x, y, k);
    d2 += o * o, n_l += o * s.normal.value(x, y, k);
  }
  return n_l > 0 && d2 < double(light.range) * double(light.range);
}

/// Lights of the tile that a pixel is in, by their places.
bool listed(const LightTiles& tiles, const Light& light, int x, int y, size_t floats) {
  const size_t tile = size_t((kHeight - 1 - y) / tiles.tile) * size_t(tiles.columns) + size_t(x / tiles.tile);
  for (uint32_t i = 0; i < tiles.count[tile]; ++i) {
    const float* record = &tiles.records[(tiles.first[tile] + i) * floats];
    if (record[0] == light.position.x && record[1] == light.position.y && record[2] == light.position.z) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("A tile lists every light that lights one of its pixels, and few that light none") {
  Pipeline pipeline = presets().front().pipeline;
  pipeline.width = kWidth, pipeline.height = kHeight;
  pipeline.gbuffer.normal.format = Format::rgba16f;
  const size_t floats = 4 * light_texels(pipeline).size();
  for (const char* name : {"city,lights=80", "sphere", "rabbits,lights=60", "atrium"}) {
    const Scene scene = builtin_scene(name);
    const Shown s = shown(scene, pipeline);
    for (const int size : {8, 32}) {
      const LightTiles all = light_tiles(scene, pipeline, s.depth, {}, size);
      const LightTiles facing = light_tiles(scene, pipeline, s.depth, s.halves, size);
      CAPTURE(name, size);
      CHECK(facing.records.size() <= all.records.size());
      if (scene.spec == "builtin:sphere") CHECK(facing.records.size() < all.records.size() * 6 / 10);
      uint64_t pairs = 0, lost = 0;
      for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
          if (s.depth[size_t(kHeight - 1 - y) * kWidth + size_t(x)] == 1) continue;
          for (const Light& light : scene.lights) {
            if (light.type < LightType::point || !lights(s, light, x, y)) continue;
            ++pairs;
            lost += listed(facing, light, x, y, floats) ? 0 : 1;
          }
        }
      CHECK(pairs > 10000);
      CHECK(lost == 0);
      std::printf("%s, tiles of %d: %zu of %zu records kept by their normals\n", name, size,
                  facing.records.size() / floats, all.records.size() / floats);
    }
  }
  // A light that adds something to what faces away is listed whatever the normals.
  Pipeline unmasked = pipeline;
  unmasked.light_model.specular_masked = false;
  const Scene scene = builtin_scene("sphere");
  const Shown s = shown(scene, unmasked);
  CHECK(light_tiles(scene, unmasked, s.depth, s.halves, 32).records ==
        light_tiles(scene, unmasked, s.depth, {}, 32).records);
}
