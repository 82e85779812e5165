// Random frames against the scalar renderer of oracle/: what is seen, where, how deep, and every attribute.
#include <algorithm>
#include <cmath>

#include "oracle/scalar_renderer.h"
#include "tests/catch.hpp"
#include "tests/raster/drawn_alike.h"
#include "tests/raster/window_scene.h"

using namespace trueshade;
using namespace trueshade::testing;

namespace {

struct Tally {
  uint64_t pixels = 0, covered = 0, uncertain = 0, values = 0;
};

/// One value of the renderer's against the exact plane: within 1 ulp of the largest vertex value, and in the hull.
void check_value(const oracle::ValueRange& range, float value) {
  const double off = std::fabs(double((long double)(value)-range.value));
  if (off <= range.ulp && double(value) >= range.lo && double(value) <= range.hi) return;
  CAPTURE(value, double(range.value), range.ulp, range.lo, range.hi);
  FAIL("an attribute is more than 1 ulp off or outside the range of its vertices");
}

void check_pixel(const oracle::ScalarFrame& frame, const oracle::Fragment& fragment, const Scene& scene,
                 const Pipeline& pipeline, const Planes& planes, int x, int y) {
  const size_t i = planes.index(x, y);
  const oracle::DrawnTriangle& t = frame.triangles[fragment.window];
  const double depth_off = std::fabs(double((long double)(planes.depth[i]) - fragment.depth));
  CAPTURE(planes.depth[i], double(fragment.depth));
  const Format format = pipeline.geometry.depth_format;
  const double code = format == Format::d32f ? 0 : 1.01 / double(info(format).largest_code(0));
  REQUIRE(depth_off <=
          std::max({code, 0x1p-24, 0x1p-23 * double(std::fabs(fragment.depth)), double(fragment.depth_bound)}));
  if (fragment.depth_bound == 0) REQUIRE(planes.depth[i] == fragment.depth_code);
  const GBufferState& g = pipeline.gbuffer;
  const std::array<oracle::ValueRange, 3> normal = normal_at(t, g, x, y);
  for (size_t k = 0; k < 3; ++k) {
    CAPTURE(k);
    check_value(value_at(t, oracle::kPosition + k, g.position.interpolation, x, y), planes.position[i][k]);
    check_value(normal[k], planes.normal[i][k]);
  }
  for (size_t k = 0; k < 2; ++k) check_value(value_at(t, oracle::kUv + k, g.uv.interpolation, x, y), planes.uv[i][k]);
  const glm::vec4& base = scene.materials[scene.instances[fragment.instance].material].base_color;
  for (size_t k = 0; k < 4; ++k) {  // the product with the base colour rounds once more, and rounding keeps order
    oracle::ValueRange range = value_at(t, oracle::kAlbedo + k, g.albedo.interpolation, x, y);
    const double factor = double(base[int(k)]);
    range.value *= (long double)(factor);
    range.ulp = range.ulp * factor + 0x1p-24 * std::fabs(double(range.value));
    range.lo = double(float(range.lo * factor)), range.hi = double(float(range.hi * factor));
    check_value(range, planes.albedo[i][k]);
  }
}

void check_frame(const oracle::ScalarFrame& frame, const Scene& scene, const Pipeline& pipeline, const Planes& planes,
                 Tally& tally) {
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      CAPTURE(x, y);
      const std::vector<oracle::Fragment>& fragments = frame.at(x, y);
      const oracle::Visible seen = visible_fragment(fragments, pipeline.geometry);
      const uint32_t object = planes.object[planes.index(x, y)];
      ++tally.pixels;
      if (!seen.certain) {
        ++tally.uncertain;
        const bool known = object == 0 || std::any_of(fragments.begin(), fragments.end(),
                                                      [&](const auto& f) { return f.instance + 1 == object; });
        REQUIRE(known);
        continue;
      }
      REQUIRE(object == (seen.fragment ? fragments[*seen.fragment].instance + 1 : 0));
      if (!seen.fragment) continue;
      ++tally.covered;
      check_pixel(frame, fragments[*seen.fragment], scene, pipeline, planes, x, y);
    }
}

}  // namespace

TEST_CASE("Random frames equal the scalar renderer's: surfaces exactly, values within 1 ulp and in their hull") {
  Random random(31), faces(37);
  const std::vector<Execution> all = executions();
  Tally tally;
  for (int i = 0; i < 300; ++i) {
    Scene scene = random_scene(random);
    if (i % 3 == 1) add_faces(faces, scene);
    const Pipeline pipeline = random_pipeline(random);
    const oracle::ScalarFrame frame = oracle::scalar_frame(scene, pipeline);
    const Execution& execution = all[size_t(i) % all.size()];
    INFO("frame " << i << ", " << named(execution) << ", " << pipeline_json(pipeline));
    check_frame(frame, scene, pipeline, drawn(scene, pipeline, execution), tally);
  }
  INFO(tally.covered << " covered of " << tally.pixels << ", " << tally.uncertain << " uncertain");
  CHECK(tally.covered > tally.pixels / 20);
  CHECK(tally.uncertain < tally.pixels / 150);  // nearly all under depth clamp, where z / w reaches 2^100 at a cut
}

TEST_CASE("Random frames are the same on every SIMD target, tile size and thread count, with and without culling") {
  Random random(32), faces(38);
  for (int i = 0; i < 60; ++i) {
    INFO("frame " << i);
    Scene scene = random_scene(random);
    if (i % 2 == 1) add_faces(faces, scene);
    check_executions_alike(scene, random_pipeline(random));
  }
}

TEST_CASE("Random frames are the same by the paths for usual triangles and surfaces and by the general ones") {
  Random random(33), faces(39);
  for (int i = 0; i < 80; ++i) {
    Scene scene = random_scene(random);
    if (i % 2 == 1) add_faces(faces, scene);
    Pipeline pipeline = random_pipeline(random);
    GBufferState& planes = pipeline.gbuffer;
    for (PlaneState* plane : {&planes.position, &planes.normal, &planes.albedo, &planes.uv})
      plane->interpolation = Interpolation::smooth;
    pipeline.geometry.depth_func = i % 3 == 0 ? DepthFunc::lequal : DepthFunc::less;
    planes.position_from_depth = i % 5 == 0 && pipeline.geometry.depth_near != pipeline.geometry.depth_far;
    if (i % 4 == 0) pipeline.width *= 3, pipeline.height *= 2;
    INFO("frame " << i);
    check_general_alike(scene, pipeline);
  }
}

TEST_CASE("Attributes that a triangle's corners share are the same by the path for them and by the general one") {
  Random random(36);
  const float values[] = {0.0f, -0.0f, 1.0f, -1.0f, 0.25f, 1e-40f, -1e18f};
  for (int i = 0; i < 40; ++i) {
    Scene scene = random_scene(random);
    scene.materials.resize(70);
    for (size_t m = 2; m < scene.materials.size(); ++m) scene.materials[m].base_color.g = float(between(random, 0, 1));
    for (Instance& instance : scene.instances)  // 1, 33, 65: those that the same place would hold
      instance.material = uint32_t(random() % 3 * 32 + random() % 2);
    for (Mesh& mesh : scene.meshes) {
      if (i % 3 != 0)
        for (auto& channel : mesh.color) channel.clear();
      for (auto& stream : mesh.normal)  // the first mesh has vertices of its own for each triangle
        for (size_t v = 0; v < stream.size(); ++v)
          stream[v] = v % 3 != 0 && random() % 8 != 0 ? stream[v - 1] : values[random() % std::size(values)];
      for (auto& channel : mesh.color)
        for (size_t v = 1; v < channel.size(); ++v)
          if (v % 3 != 0 && random() % 8 != 0) channel[v] = channel[v - 1];
    }
    Pipeline pipeline = random_pipeline(random);
    for (PlaneState* plane : {&pipeline.gbuffer.position, &pipeline.gbuffer.normal, &pipeline.gbuffer.albedo})
      plane->interpolation = Interpolation::smooth;
    pipeline.geometry.depth_func = DepthFunc::less;
    if (i % 2 == 0) pipeline.width *= 2, pipeline.height *= 3;
    INFO("frame " << i);
    check_general_alike(scene, pipeline);
  }
}

TEST_CASE("Sheets of triangles of 1 to 50 pixels are the same by the path for their size and by the general one") {
  Random random(35);
  const Pipeline pipeline = window_pipeline();
  for (const double side : {0.7, 1.5, 3.0, 4.5, 6.5, 8.0, 12.0, 20.0, 50.0}) {
    constexpr int kQuads = 14;
    const double low = 0.5 * (kWindow - kQuads * side);
    std::vector<Corner> corners;
    for (int y = 0; y <= kQuads; ++y)
      for (int x = 0; x <= kQuads; ++x)
        corners.push_back({low + side * (x + between(random, -0.3, 0.3)), low + side * (y + between(random, -0.3, 0.3)),
                           between(random, -0.9, 0.9)});
    std::vector<testing::Corners>
        sheets[2];  // the second turned about the middle: what it hides and what hides it changes
    for (int y = 0; y < kQuads; ++y)
      for (int x = 0; x < kQuads; ++x) {
        const size_t i = size_t(y * (kQuads + 1) + x), above = i + kQuads + 1;
        sheets[0].push_back({corners[i], corners[i + 1], corners[above]});
        sheets[0].push_back({corners[i + 1], corners[above + 1], corners[above]});
      }
    for (testing::Corners triangle : sheets[0]) {
      for (Corner& c : triangle) c.x = kWindow - c.x, c.z = -c.z;
      sheets[1].push_back(triangle);
    }
    const Scene scene = window_objects({sheets[0], sheets[1]});
    Execution general;
    general.fast_geometry = false;
    const Planes expected = drawn(scene, pipeline, general);
    for (const Execution& execution : executions()) {
      INFO("quads of " << side << " pixels, " << named(execution));
      REQUIRE(drawn(scene, pipeline, execution) == expected);
    }
  }
}

TEST_CASE("Random frames do not depend on which vertex a triangle names first") {
  Random random(34);
  const std::vector<Execution> all = executions();
  for (int i = 0; i < 60; ++i) {
    INFO("frame " << i);
    const Scene scene = random_scene(random);
    const Pipeline pipeline = without_flat(random_pipeline(random));
    check_turned_alike(random, scene, pipeline, all[size_t(i) % all.size()]);
  }
}

TEST_CASE(
    "A double-sided material shows both faces, the back with its normal turned, and a mirrored instance the other") {
  Random random(47);
  uint64_t turned = 0, straight = 0;
  for (int i = 0; i < 60; ++i) {
    Scene scene = random_scene(random);
    for (auto& instance : scene.instances) instance.material = 0;
    Pipeline pipeline = random_pipeline(random);
    const auto planes = [&](CullFace cull, bool both, bool mirrored) {
      pipeline.geometry.cull_face = cull;
      scene.materials[0].double_sided = both;
      for (Instance& instance : scene.instances) instance.mirrored = mirrored;
      return drawn(scene, pipeline, {});
    };
    INFO("frame " << i << ", " << pipeline_json(pipeline));
    const Planes all = planes(CullFace::none, false, false), both = planes(CullFace::none, true, false);
    REQUIRE(planes(CullFace::back, true, false) == both);
    REQUIRE(planes(CullFace::front_and_back, true, false) == planes(CullFace::front, true, false));
    REQUIRE(planes(CullFace::back, false, true) == planes(CullFace::front, false, false));
    REQUIRE(planes(CullFace::none, false, true) == all);
    const Planes mirrored = planes(CullFace::none, true, true);
    // Which pixels show a back: those that change where backs alone are left out.
    for (size_t p = 0; p < all.object.size(); ++p) {
      if (all.object[p] == 0) continue;
      const auto negated = [&](const std::array<float, 4>& n) {
        return std::array<float, 4>{-n[0], -n[1], -n[2], n[3]};
      };
      const bool is_turned = both.normal[p] != all.normal[p];
      (is_turned ? turned : straight) += 1;
      REQUIRE(both.normal[p] == (is_turned ? negated(all.normal[p]) : all.normal[p]));
      REQUIRE(mirrored.normal[p] == negated(both.normal[p]));
    }
    Planes same = both;
    same.normal = all.normal;
    REQUIRE(same == all);
  }
  CHECK(turned > 1000);
  CHECK(straight > 1000);
}

TEST_CASE("Random frames move with their viewport by (64, 32) pixels and keep every bit") {
  Random random(33);
  const std::vector<Execution> all = executions();
  for (int i = 0; i < 60; ++i) {
    INFO("frame " << i);
    const Scene scene = random_scene(random);
    check_moved_alike(scene, random_pipeline(random), all[size_t(i) % all.size()]);
  }
}
