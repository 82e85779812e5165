// What light geometry covers, against exact integers: polygons and triangles, inside and out, every extent and side.
#include "raster/light_geometry/light_outlines.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "core/fp_env.h"
#include "core/simd/simd_target.h"
#include "oracle/exact_coverage.h"
#include "oracle/matrices.h"
#include "scenes/trig.h"
#include "tests/catch.hpp"

namespace trueshade {
namespace {

constexpr int kWidth = 150, kHeight = 90;

struct Setting {
  Scene scene;
  Pipeline pipeline;
};

/// Lights all around an eye that some of them contain, ranges from a hundredth to a hundred units.
Setting random_setting(uint32_t seed) {
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) {
    return float(low + (high - low) * double(random()) / 4294967296.0);
  };
  Setting s;
  s.scene.camera.eye = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
  s.scene.camera.target = {uniform(-9, 9), uniform(-9, 9), 10.0f};
  for (int i = 0; i < 24; ++i) {
    Light light;
    light.type = i % 3 == 0 ? LightType::spot : LightType::point;
    light.position = {uniform(-12, 12), uniform(-12, 12), uniform(-12, 12)};
    light.range = float(std::pow(10.0, double(uniform(-2, 1))));
    light.direction = glm::vec3(unit(glm::dvec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1))));
    light.cone_rad = uniform(0.05, 1.4);
    if (i % 8 == 7) {  // about the eye
      light.position = s.scene.camera.eye + glm::vec3(uniform(-2, 2), uniform(-2, 2), uniform(-2, 2));
      light.range = uniform(3, 9);
    }
    s.scene.lights.push_back(light);
  }
  s.scene.lights[0].direction = {0.0f, 0.0f, 1.0f};
  s.scene.lights[0].position = {0.0f, 0.0f, 5.0f};
  s.scene.lights[0].range = 2.0f;
  Pipeline& p = s.pipeline;
  p.width = kWidth;
  p.height = kHeight;
  const LightExtent meshes[] = {LightExtent::box, LightExtent::sphere, LightExtent::cone};
  p.light_volumes.point = meshes[random() % 2];
  p.light_volumes.spot = meshes[random() % 3];
  p.light_volumes.slices = int(3 + random() % 20);
  p.light_volumes.stacks = int(2 + random() % 10);
  p.light_volumes.cull_face = CullFace(random() % 3);
  p.light_volumes.depth_clamp = random() % 2 == 0;
  p.geometry.clip_origin = ClipOrigin(random() % 2);
  p.geometry.clip_depth = ClipDepth(random() % 2);
  if (random() % 4 == 0) p.geometry.viewport = {-20, 7, 140, 70};
  return s;
}

/// Clip coordinates in float32, row by row, as docs/arithmetic.md sections 1 and 2 say.
std::vector<uint16_t> exact_counts(const Setting& s, const LightMesh& mesh, const Light& light) {
  const Matrix4 clip = oracle::projection_of(s.scene.camera, s.pipeline.geometry, kWidth, kHeight);
  std::vector<glm::vec3> vertices(mesh.unit.size());
  light_vertices(mesh, light, vertices);
  std::vector<oracle::ClipTriangleValues> triangles;
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    oracle::ClipTriangleValues t{};
    for (size_t k = 0; k < 3; ++k) {
      const glm::vec3 v = vertices[mesh.indices[i + k]];
      for (size_t r = 0; r < 4; ++r)
        t.vertex[k][r] =
            ((float(clip[r]) * v.x + float(clip[4 + r]) * v.y) + float(clip[8 + r]) * v.z) + float(clip[12 + r]);
    }
    triangles.push_back(t);
  }
  std::vector<uint16_t> counts(kWidth * kHeight);
  oracle::count_exactly(triangles, light_geometry_state(s.pipeline), kWidth, kHeight, counts);
  return counts;
}

TileRect tile_of(const WindowTransform& t, int x, int y, int size) {
  const auto in_tile = [size](int v) { return std::clamp(v, 0, size); };
  return {x, y, size, {in_tile(t.x0 - x), in_tile(t.y0 - y), in_tile(t.x1 - x), in_tile(t.y1 - y)}};
}

/// How often a polygon covers the pixels of a tile: by its edges or masks, and by the masks of blocks.
void count_polygon(const LightOutlines& outlines, size_t index, const TileRect& rect, uint16_t* counts) {
  std::vector<TileEdge> edges;
  std::vector<uint16_t> masks;
  const Cover cover =
      outlines.kind[index] == OutlineKind::everywhere ? Cover::all : tile_cover(outlines, index, rect, edges, masks);
  for (int y = 0; y < rect.size; ++y)
    for (int x = 0; x < rect.size; ++x) {
      const int at = tile_index(rect.size, x, y), bit = at % kBlockPixels;
      bool inside = cover == Cover::all || cover == Cover::edges;
      for (const TileEdge& e : edges) inside = inside && e.at + e.across * x + e.up * y >= 0;
      if (cover == Cover::masks) inside = (masks[size_t(at / kBlockPixels)] >> bit & 1) != 0;
      if (cover == Cover::edges) {
        const unsigned mask = block_mask(edges, x / kBlockSize * kBlockSize, y / kBlockSize * kBlockSize);
        CHECK((mask >> bit & 1) == unsigned(inside));
      }
      counts[at] = inside ? outlines.layers[index] : 0;
    }
}

/// The same from our outlines, tile by tile: by polygons, other meshes by their triangles.
std::vector<uint16_t> our_counts(const LightOutlines& outlines, const LightMesh& mesh, const Light& light, size_t index,
                                 const View& view) {
  constexpr int kTile = 32;
  std::vector<uint16_t> counts(kWidth * kHeight), tile(kMaxTilePixels);
  const WindowTransform& t = outlines.window;
  if (outlines.kind[index] == OutlineKind::nothing) return counts;
  for (int ty = 0; ty < kHeight; ty += kTile)
    for (int tx = 0; tx < kWidth; tx += kTile) {
      const TileRect rect = tile_of(t, tx, ty, kTile);
      if (outlines.kind[index] == OutlineKind::mesh) {
        const int most = count_light_mesh(mesh, light, outlines, view, rect, tile.data());
        CHECK(most == *std::max_element(tile.begin(), tile.begin() + kTile * kTile));
      } else {
        count_polygon(outlines, index, rect, tile.data());
      }
      for (int y = std::max(ty, t.y0); y < std::min(ty + kTile, t.y1); ++y)
        for (int x = std::max(tx, t.x0); x < std::min(tx + kTile, t.x1); ++x)
          counts[size_t(y * kWidth + x)] = tile[size_t(tile_index(kTile, x - tx, y - ty))];
    }
  return counts;
}

TEST_CASE("Light geometry covers what exact integers say its triangles cover, camera inside included") {
  const FpScope fp;
  size_t kinds[4] = {}, pixels = 0;
  for (uint32_t seed = 0; seed < 40; ++seed) {
    const Setting s = random_setting(seed);
    const LightMeshes meshes(s.pipeline.light_volumes);
    const View view = make_view(s.scene, s.pipeline);
    for (const std::string_view target : simd_targets()) {
      const SimdScope simd(target);
      if (target != simd_targets().front() && seed % 8 != 0) continue;
      const LightOutlines outlines = make_light_outlines(s.scene.lights, s.pipeline, meshes, view, 2);
      for (size_t i = 0; i < s.scene.lights.size(); ++i) {
        const Light& light = s.scene.lights[i];
        const LightMesh& mesh = meshes[drawn_extent(light, s.pipeline.light_volumes)];
        const std::vector<uint16_t> exact = exact_counts(s, mesh, light),
                                    ours = our_counts(outlines, mesh, light, i, view);
        ++kinds[size_t(outlines.kind[i])];
        size_t wrong = 0, outside = 0;
        for (int y = 0; y < kHeight; ++y)
          for (int x = 0; x < kWidth; ++x) {
            const size_t at = size_t(y * kWidth + x);
            wrong += exact[at] != ours[at];
            pixels += exact[at];
            outside += exact[at] != 0 &&
                       (x < outlines.x0[i] || x >= outlines.x1[i] || y < outlines.y0[i] || y >= outlines.y1[i]);
          }
        INFO("seed " << seed << ", light " << i << ", kind " << int(outlines.kind[i]) << ", " << target);
        CHECK(wrong == 0);
        CHECK(outside == 0);
      }
    }
  }
  CAPTURE(kinds[0], kinds[1], kinds[2], kinds[3], pixels);
  CHECK(kinds[size_t(OutlineKind::nothing)] > 100);
  CHECK(kinds[size_t(OutlineKind::everywhere)] > 20);
  CHECK(kinds[size_t(OutlineKind::polygon)] > 100);
  CHECK(kinds[size_t(OutlineKind::mesh)] > 20);
  CHECK(pixels > 1000000);
}

TEST_CASE("A closed mesh has every edge twice, once in each direction, and faces outward") {
  for (const LightExtent extent : {LightExtent::box, LightExtent::sphere, LightExtent::cone})
    for (const int slices : {3, 16, 64}) {
      const LightMesh mesh = light_mesh(extent, slices, slices == 3 ? 2 : slices / 2);
      double volume = 0.0;  // six times the signed one
      for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        const auto &a = mesh.unit[mesh.indices[i]], &b = mesh.unit[mesh.indices[i + 1]],
                   &c = mesh.unit[mesh.indices[i + 2]];
        volume += dot(a, cross(b, c));
        for (size_t k = 0; k < 3; ++k) {
          const size_t other = mesh.neighbour[i + k];
          CHECK(std::count(mesh.neighbour.begin() + std::ptrdiff_t(3 * other),
                           mesh.neighbour.begin() + std::ptrdiff_t(3 * other + 3), uint32_t(i / 3)) == 1);
        }
      }
      CHECK(volume > 0.0);
      if (extent == LightExtent::box) CHECK(volume == 48.0);
    }
}

TEST_CASE("Lights without a mesh are drawn over the whole image") {
  LightVolumes boxes;
  boxes.point = boxes.spot = LightExtent::cone;
  Light light;
  light.range = 2.0f;
  CHECK(drawn_extent(light, boxes) == LightExtent::sphere);  // a point light has no cone
  light.type = LightType::spot;
  light.cone_rad = 1.5f;
  CHECK(drawn_extent(light, boxes) == LightExtent::cone);
  light.penumbra_rad = 0.01f;
  CHECK(drawn_extent(light, boxes) == LightExtent::sphere);
  light.range = std::numeric_limits<float>::infinity();
  CHECK(drawn_extent(light, boxes) == LightExtent::unbounded);
  light.range = 1.0f;
  light.type = LightType::ambient;
  CHECK(drawn_extent(light, boxes) == LightExtent::unbounded);
}

}  // namespace
}  // namespace trueshade
