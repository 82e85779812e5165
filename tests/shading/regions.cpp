// A region of a picture has the picture's pixels: every strategy, profile, view, plane and step of the post chain, at
// places that no tile, block or square of pixels respects.
#include <algorithm>
#include <cstring>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "shading/frame.h"
#include "shading/picture_region.h"
#include "tests/catch.hpp"
#include "tests/raster/random_frame.h"

using namespace trueshade;

namespace {

constexpr Strategy kStrategies[] = {Strategy::forward_multipass, Strategy::forward_loop, Strategy::deferred_volumes,
                                    Strategy::deferred_loop};

/// Puts a region's rows where they belong.
void put(const Image& part, const PictureRegion& at, Image& whole) {
  REQUIRE(part.width == at.width);
  REQUIRE(part.height == at.height);
  REQUIRE(part.format == whole.format);
  for (int y = 0; y < at.height; ++y) std::memcpy(whole.texel(at.x, at.y + y), part.texel(0, y), part.row_bytes());
}

/// Regions that make up the picture: columns and rows that end at the places given.
std::vector<PictureRegion> grid(std::vector<int> columns, std::vector<int> rows, const Pipeline& p) {
  columns.push_back(p.width), rows.push_back(p.height);
  std::vector<PictureRegion> regions;
  int y = 0;
  for (const int bottom : rows) {
    int x = 0;
    for (const int right : columns) {
      regions.push_back({x, y, right - x, bottom - y});
      x = right;
    }
    y = bottom;
  }
  return regions;
}

/// Draws the picture whole, and again of regions, each of which is drawn in another way.
void check_regions(const PreparedScene& scene, const Pipeline& pipeline, const std::vector<PictureRegion>& regions,
                   const std::vector<std::string>& aovs = {}) {
  const Frame whole = render_frame(scene, pipeline, {}, aovs);
  Frame parts = whole;
  std::fill(parts.color.texels.begin(), parts.color.texels.end(), uint8_t(0xa5));
  for (NamedImage& plane : parts.aovs) std::fill(plane.image.texels.begin(), plane.image.texels.end(), uint8_t(0xa5));
  Execution execution;
  for (size_t i = 0; i < regions.size(); ++i) {
    execution.region = regions[i];
    execution.threads = 1 + int(i % 2);
    execution.tile = i % 3 == 0 ? 16 : i % 3 == 1 ? 64 : 0;
    const Frame part = render_frame(scene, pipeline, execution, aovs);
    CHECK(part.view_scale == whole.view_scale);
    put(part.color, regions[i], parts.color);
    for (size_t k = 0; k < aovs.size(); ++k) put(part.aovs[k].image, regions[i], parts.aovs[k].image);
  }
  CHECK(image_hash(parts.color) == image_hash(whole.color));
  for (size_t k = 0; k < aovs.size(); ++k) {
    INFO(aovs[k]);
    CHECK(image_hash(parts.aovs[k].image) == image_hash(whole.aovs[k].image));
  }
}

Pipeline pipeline_of(const Scene& scene, int width, int height) {
  Pipeline p = default_pipeline(scene);
  p.width = width, p.height = height;
  return p;
}

}  // namespace

TEST_CASE("Regions make up the picture, for every built-in scene and strategy", "[regions]") {
  for (const BuiltinInfo& builtin : builtin_scenes()) {
    const Scene scene = builtin_scene(std::string(builtin.name));
    const PreparedScene prepared(scene);
    for (const Strategy strategy : kStrategies) {
      INFO(builtin.name << ", " << name_of(strategy));
      Pipeline p = pipeline_of(scene, 117, 83);
      p.strategy = strategy;
      check_regions(prepared, p, grid({5, 50}, {33}, p), {"depth", "Z", "position", "normal", "id.object"});
    }
  }
}

TEST_CASE("Regions have the picture's planes and views", "[regions]") {
  const Scene scene = builtin_scene("city");
  const PreparedScene prepared(scene);
  Pipeline p = pipeline_of(scene, 130, 75);
  std::vector<std::string> all(aov_names().begin(), aov_names().end());
  all.emplace_back("light.3");
  check_regions(prepared, p, grid({31, 64}, {18}, p), all);
  for (size_t view = 0; view < std::size(kViewNames); ++view) {
    INFO(kViewNames[view]);
    p.view = ImageView(view);
    check_regions(prepared, p, grid({31}, {18}, p));
  }
}

TEST_CASE("Regions have the picture's pixels after the post chain", "[regions]") {
  const Scene scene = builtin_scene("circle");
  const PreparedScene prepared(scene);
  Pipeline p = pipeline_of(scene, 90, 61);
  p.target = Format::rgba16f;
  const auto check = [&](const char* what) {
    INFO(what);
    check_regions(prepared, p, grid({40}, {7, 41}, p), {"depth"});
  };
  p.post.edge_filter = true;
  check("edges");
  p.post.bloom = {0.3f, 0.4f, 3, 3};
  check("bloom, edges");
  p.post.tone_map = PostChain::ToneMap::reinhard;
  p.post.encode = PostChain::Encode::srgb;
  check("bloom, tones, sRGB, edges");
  p.post.samples = 3;
  p.post.marker_radius = 0.2f;
  check("samples, markers, bloom, tones, sRGB, edges");
}

TEST_CASE("Regions under llvmpipe's snapping, positions from depth, and viewports of all kinds", "[regions]") {
  const Scene scene = builtin_scene("red");
  const PreparedScene prepared(scene);
  Pipeline p = pipeline_of(scene, 111, 70);
  p.gbuffer.position_from_depth = true;
  for (const NumericProfile profile : {NumericProfile::ideal, NumericProfile::mesa_llvmpipe_22_3})
    for (const ClipOrigin origin : {ClipOrigin::lower_left, ClipOrigin::upper_left})
      for (const Viewport& viewport : {Viewport{}, Viewport{-300, 17, 700, 90}, Viewport{20, -1000, 60, 3000}}) {
        INFO(viewport.x << ',' << viewport.y << ' ' << viewport.width << 'x' << viewport.height);
        p.profile = profile;
        p.geometry.clip_origin = origin;
        p.geometry.viewport = viewport;
        check_regions(prepared, p, grid({53}, {1, 37}, p), {"depth", "position"});
      }
}

TEST_CASE("Regions of random frames", "[regions]") {
  testing::Random random(19);
  for (int i = 0; i < 60; ++i) {
    INFO("frame " << i);
    Scene scene = testing::random_scene(random);
    if (i % 3 == 0) testing::add_maps(random, scene);
    if (i % 4 == 0) testing::add_faces(random, scene);
    Pipeline p = testing::random_pipeline(random);
    const auto cut = [&random](int size) { return 1 + int(random() % uint64_t(std::max(size - 1, 1))); };
    if (p.width < 2 || p.height < 2) continue;
    check_regions(PreparedScene(scene), p, grid({cut(p.width)}, {cut(p.height)}, p), {"depth", "position", "uv"});
  }
}

TEST_CASE("A region of a picture too large to draw whole is a region of twice the picture", "[regions]") {
  // Samples of the picture of 2^20 pixels a side that are those of one of 2^13: each 128th pixel's neighbourhood is
  // flat, so a uniformly coloured wall shows the same colours, and the edge of a square lies where it belongs.
  Scene scene;
  scene.spec = "square";
  scene.camera.clip_from_world = std::array<float, 16>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  Mesh mesh;
  // In a picture of 2^20 pixels a side a corner at pixel (2^20 - 300.5, 200.25) from the lower left.
  const float right = float((1048576.0 - 300.5) / 524288.0 - 1.0), low = float(200.25 / 524288.0 - 1.0);
  for (const auto& [x, y] : {std::pair{-1.0f, low}, {right, low}, {right, 1.0f}, {-1.0f, 1.0f}}) {
    mesh.position[0].push_back(x), mesh.position[1].push_back(y), mesh.position[2].push_back(0.0f);
    mesh.normal[0].push_back(0.0f), mesh.normal[1].push_back(0.0f), mesh.normal[2].push_back(1.0f);
  }
  mesh.indices = {0, 1, 2, 0, 2, 3};
  scene.meshes.push_back(mesh);
  scene.materials.push_back({"white", glm::vec4(1.0f)});
  scene.instances.push_back({0, 0, glm::mat4x3(1.0f)});
  Pipeline p;
  p.width = p.height = kMostPictureSide;
  Execution execution;
  execution.region = {kMostPictureSide - 400, kMostPictureSide - 300, 400, 300};
  const std::vector<std::string> planes = {"id.object"};
  const Frame frame = render_frame(scene, p, execution, planes);
  // float spaces numbers near 1 by 2^-24, that is 1/32 pixel here: the corner is where its floats say.
  const double edge_x = (double(right) + 1.0) * 524288.0, edge_y = (double(low) + 1.0) * 524288.0;
  for (int y = 0; y < 300; ++y)
    for (int x = 0; x < 400; ++x) {
      const double at_x = kMostPictureSide - 400 + x + 0.5, at_y = 300 - 1 - y + 0.5;
      if (std::abs(at_x - edge_x) < 0.01 || std::abs(at_y - edge_y) < 0.01) continue;  // snapped by 1/512 pixel
      const bool covered = at_x < edge_x && at_y > edge_y;
      if (frame.aovs[0].image.code(x, y, 0) != (covered ? 1u : 0u)) FAIL("pixel " << x << ',' << y << " of the region");
    }
}

TEST_CASE("Regions out of the picture, and pictures too large to draw whole, are refused", "[regions]") {
  const Scene scene = builtin_scene("sphere");
  const PreparedScene prepared(scene);
  Pipeline p = pipeline_of(scene, 100, 80);
  Execution execution;
  for (const PictureRegion& region :
       {PictureRegion{0, 0, 101, 1}, PictureRegion{-1, 0, 2, 2}, PictureRegion{99, 79, 1, 2}, PictureRegion{5, 5, 0, 3},
        PictureRegion{5, 5, 3, 0}, PictureRegion{2147483647, 0, 2147483647, 1}}) {
    execution.region = region;
    CHECK_THROWS_AS(render_frame(prepared, p, execution), Error);
  }
  p.width = kMostDrawnSide + 1, p.height = 1;
  CHECK_THROWS_AS(render_frame(prepared, p), Error);
  execution.region = {70, 0, kMostDrawnSide - 1000, 1};
  CHECK_NOTHROW(render_frame(prepared, p, execution));
  p.width = kMostPictureSide + 1;
  CHECK_THROWS_AS(render_frame(prepared, p, execution), Error);
}
