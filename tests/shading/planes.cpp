// Planes beside the picture, against formulas (docs/views.md).
#include <algorithm>
#include <bit>
#include <cmath>

#include "core/error.h"
#include "core/simd/simd_target.h"
#include "scenes/pipeline/light_mesh.h"
#include "shading/frame.h"
#include "tests/catch.hpp"
#include "tests/shading/two_squares.h"

using namespace trueshade;
using testing::at, testing::bulb, testing::pipeline_of, testing::two_squares;

/// A loop over all lights of `preset`, which may be one of another strategy; extents as it has them, or of range.
std::vector<Pipeline> loops_of(std::string_view preset) {
  std::vector<Pipeline> loops;
  for (const Strategy strategy : {Strategy::deferred_loop, Strategy::forward_loop})
    for (const bool ranged : {false, true}) {
      Pipeline p = pipeline_of(preset, 61, 47);
      p.strategy = strategy;
      p.target = Format::rgba32f;
      if (ranged) p.light_volumes.point = p.light_volumes.spot = LightExtent::range;
      loops.push_back(p);
    }
  return loops;
}

/// Pixels with a surface where `light.<i>` planes do not sum to the picture, and where they sum to more than 0.
std::array<int, 2> unlike_and_lit(const PreparedScene& prepared, const Pipeline& pipeline, std::string_view simd) {
  std::vector<std::string> names{"id.object"};
  for (size_t i = 0; i < prepared.scene().lights.size(); ++i) names.push_back("light." + std::to_string(i));
  Execution execution;
  execution.simd = simd;
  execution.tile = simd == "scalar" ? 16 : 64;
  execution.light_culling = simd != "avx2";
  const Frame frame = render_frame(prepared, pipeline, execution, names);
  std::array<int, 2> count{};
  for (int y = 0; y < pipeline.height; ++y)
    for (int x = 0; x < pipeline.width; ++x) {
      if (at<uint32_t>(frame.aovs[0].image, x, y) == 0) continue;
      bool unlike = false, lit = false;
      for (int k = 0; k < 3; ++k) {
        float sum = 0.0f;
        for (size_t i = 1; i < names.size(); ++i) sum += at<float>(frame.aovs[i].image, x, y, k);
        unlike = unlike || std::bit_cast<uint32_t>(sum) != std::bit_cast<uint32_t>(at<float>(frame.color, x, y, k));
        lit = lit || sum > 0.0f;
      }
      count[0] += unlike, count[1] += lit;
    }
  return count;
}

TEST_CASE("The planes light.<i>, added in index order in float32, are the rgba32f image bit for bit", "[views][slow]") {
  for (const char* spec : {"builtin:cornell", "builtin:circle", "builtin:red,lights=40", "builtin:lecture"}) {
    const Scene scene = load_scene(spec);
    const PreparedScene prepared(scene);
    for (const std::string_view preset :
         {"many-lights", "touchdesigner", "light-volumes", "light-volumes-literal", "redsdk"})
      for (const Pipeline& pipeline : loops_of(preset))
        for (const std::string_view simd : simd_targets()) {
          CAPTURE(spec, preset, int(pipeline.strategy), int(pipeline.light_volumes.point), simd);
          const std::array<int, 2> count = unlike_and_lit(prepared, pipeline, simd);
          CHECK(count[0] == 0);
          CHECK(count[1] > 61 * 47 / 10);
        }
  }
}

namespace {

Frame with_light_planes(const PreparedScene& prepared, const Pipeline& pipeline, std::string_view simd) {
  std::vector<std::string> names;
  for (size_t i = 0; i < prepared.scene().lights.size(); ++i) names.push_back("light." + std::to_string(i));
  Execution execution;
  execution.simd = simd;
  execution.tile = simd == "scalar" ? 16 : 64;
  execution.light_culling = simd != "scalar";
  return render_frame(prepared, pipeline, execution, names);
}

bool same_bits(float a, float b) { return std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b); }

/// Values of a rgba32f picture that are not what pixels hold without lights with each light's draws added in turn, the
/// planes of light geometry of both faces that are not the sum of its two draws; and values that light changes.
std::array<int, 2> unlike_and_lit_by_draws(const Scene& scene, const Pipeline& pipeline, std::string_view simd) {
  const PreparedScene prepared(scene);
  Scene dark = scene;
  dark.lights.clear();
  const Image start = render_frame(dark, pipeline).color;
  const Frame frame = with_light_planes(prepared, pipeline, simd);
  std::vector<Frame> face;
  if (pipeline.strategy == Strategy::deferred_volumes && pipeline.light_volumes.cull_face == CullFace::none)
    for (const CullFace culled : {CullFace::back, CullFace::front}) {
      Pipeline one = pipeline;
      one.light_volumes.cull_face = culled;
      face.push_back(with_light_planes(prepared, one, simd));
    }
  std::array<int, 2> count{};
  for (int y = 0; y < pipeline.height; ++y)
    for (int x = 0; x < pipeline.width; ++x)
      for (int k = 0; k < 3; ++k) {
        const float before = at<float>(start, x, y, k);
        float sum = before;
        bool unlike = false;
        for (size_t i = 0; i < scene.lights.size(); ++i) {
          const float plane = at<float>(frame.aovs[i].image, x, y, k);
          if (!face.empty() && is_mesh(drawn_extent(scene.lights[i], pipeline.light_volumes))) {
            const float front = at<float>(face[0].aovs[i].image, x, y, k);
            const float back = at<float>(face[1].aovs[i].image, x, y, k);
            unlike = unlike || !same_bits(plane, front + back);
            sum = sum + front + back;
          } else {
            sum += plane;
          }
        }
        unlike = unlike || !same_bits(sum, at<float>(frame.color, x, y, k));
        count[0] += unlike, count[1] += !same_bits(sum, before);
      }
  return count;
}

/// The lights of a built-in scene, some of which lie outside the view, a spot, and one about the camera.
Scene scene_among_lights() {
  Scene scene = load_scene("builtin:circle");
  scene.lights.resize(std::min<size_t>(scene.lights.size(), 12));
  for (size_t i = 0; i < scene.lights.size(); ++i) scene.lights[i].range = 0.4f + 0.3f * float(i);
  scene.lights.push_back(bulb(scene.camera.eye, 7.0f));
  Light spot = bulb({0.3f, 3.0f, 0.2f}, 4.0f);
  spot.type = LightType::spot;
  spot.direction = {0.0f, -1.0f, 0.0f};
  spot.cone_rad = 0.6f, spot.penumbra_rad = 0.2f;
  scene.lights.push_back(spot);
  scene.lights.push_back(bulb({0.0f, 2.0f, 0.0f}, std::numeric_limits<float>::infinity()));
  return scene;
}

constexpr const char* kPlanePresets[] = {"many-lights",   "touchdesigner",         "gl-fixed", "lecture",
                                         "light-volumes", "light-volumes-literal", "redsdk"};

}  // namespace

TEST_CASE(
    "The planes light.<i> of light geometry, added in light order to what is there without lights, are the "
    "rgba32f image bit for bit: whatever it is, wherever its faces point, inside and out",
    "[views]") {
  const Scene scene = scene_among_lights();
  size_t turn = 0;
  for (const char* preset : kPlanePresets)
    for (const LightExtent extent :
         {LightExtent::unbounded, LightExtent::range, LightExtent::box, LightExtent::sphere, LightExtent::cone})
      for (const CullFace culled : {CullFace::none, CullFace::front, CullFace::back, CullFace::front_and_back}) {
        Pipeline p = pipeline_of(preset, 61, 47);
        p.strategy = Strategy::deferred_volumes;
        p.target = Format::rgba32f;
        p.blend = kAddLight;
        p.light_volumes.point = extent == LightExtent::cone ? LightExtent::sphere : extent;
        p.light_volumes.spot = extent;
        p.light_volumes.cull_face = culled;
        p.light_volumes.base = turn++ % 3 != 0;
        const std::string_view simd = turn % 2 ? "best" : "scalar";
        CAPTURE(preset, int(extent), int(culled), p.light_volumes.base, simd);
        const std::array<int, 2> count = unlike_and_lit_by_draws(scene, p, simd);
        CHECK(count[0] == 0);
        if (culled != CullFace::front_and_back) CHECK(count[1] > 61 * 47 / 10);
      }
}

TEST_CASE("The planes light.<i> of forward-multipass, added likewise, are the rgba32f image bit for bit", "[views]") {
  const Scene scene = scene_among_lights();
  for (const char* preset : kPlanePresets)
    for (const std::string_view simd : simd_targets()) {
      Pipeline p = pipeline_of(preset, 61, 47);
      p.strategy = Strategy::forward_multipass;
      p.target = Format::rgba32f;
      p.light_model.clamp_result = false;  // or light 0 and what needs no light are clamped as one
      CAPTURE(preset, simd);
      const std::array<int, 2> count = unlike_and_lit_by_draws(scene, p, simd);
      CHECK(count[0] == 0);
      CHECK(count[1] > 61 * 47 / 10);
    }
}

TEST_CASE("A plane light.<i> has what the light adds through every fragment that multipass lights", "[views]") {
  Scene scene = two_squares();
  scene.instances[1].world_from_object = scene.instances[0].world_from_object;  // the same depth everywhere
  scene.materials[0].base_color = {1.0f, 0.25f, 0.0f, 1.0f};
  scene.lights = {bulb({0.0f, 0.0f, 1.5f}, 6.0f), bulb({0.5f, 0.0f, 2.0f}, 6.0f)};
  Pipeline p = pipeline_of("light-volumes", 60, 60);  // diffuse: what is reflected is proportional to the albedo
  p.strategy = Strategy::forward_multipass;
  p.target = Format::rgba32f;
  p.geometry.depth_func = DepthFunc::lequal;
  const std::string planes[] = {"light.0", "light.1"};
  const Frame frame = render_frame(scene, p, {}, planes);
  int lit = 0;
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 60; ++x) {
      float value[2][3];
      for (size_t i = 0; i < 2; ++i)
        for (int k = 0; k < 3; ++k) value[i][k] = at<float>(frame.aovs[i].image, x, y, k);
      for (int k = 0; k < 3; ++k) {
        const float found = at<float>(frame.color, x, y, k);
        if (value[0][1] > 0.0f) CHECK(std::fabs(value[0][k] + value[1][k] - found) <= found * 0x1p-22f);
      }
      if (!(value[1][1] > 0.0f)) continue;
      ++lit;
      CHECK(value[1][0] == Approx(value[1][1] / 1.25f).epsilon(0.02));  // red once, green of both
    }
  CHECK(lit > 100);
}

TEST_CASE("Z is the distance along the view axis, whatever the camera's matrix", "[views]") {
  Scene scene = two_squares();
  const std::string planes[] = {"Z", "id.object"};
  const Pipeline pipeline = pipeline_of("many-lights", 60, 60);
  const auto check = [&] {
    const Frame frame = render_frame(scene, pipeline, {}, planes);
    int seen[3] = {};
    for (int y = 0; y < 60; ++y)
      for (int x = 0; x < 60; ++x) {
        const uint32_t object = at<uint32_t>(frame.aovs[1].image, x, y);
        const float expected[] = {0.0f, 4.0f, 6.0f};
        CHECK(std::fabs(at<float>(frame.aovs[0].image, x, y) - expected[object]) <= 6.0f * 0x1p-22f);
        ++seen[object];
      }
    for (const int pixels : seen) CHECK(pixels > 0);
  };
  check();
  // An orthographic matrix, column-major: x, y in [-3, 3], z from 1 to 9 before the eye.
  scene.camera.clip_from_world = {1 / 3.0f, 0, 0, 0, 0, 1 / 3.0f, 0, 0, 0, 0, -0.25f, 0, 0, 0, -0.25f, 1};
  check();
}

TEST_CASE("Z is made of the position as it is stored, bit for bit", "[views]") {
  const Scene scene = load_scene("builtin:circle");
  const PreparedScene prepared(scene);
  const Matrix4 m = clip_from_world(scene.camera, 1.0);
  const double inverse = 1.0 / std::sqrt((m[3] * m[3] + m[7] * m[7]) + m[11] * m[11]);
  const float axis[] = {float(m[3] * inverse), float(m[7] * inverse), float(m[11] * inverse)};
  const std::string planes[] = {"Z", "position", "id.object"};
  for (const Format format : {Format::rgba32f, Format::rgb16f})
    for (const bool from_depth : {false, true})
      for (const std::string_view simd : simd_targets()) {
        Pipeline pipeline = pipeline_of("many-lights", 61, 47);
        pipeline.gbuffer.position.format = format;
        pipeline.gbuffer.position_from_depth = from_depth;
        Execution execution;
        execution.simd = simd;
        const Frame frame = render_frame(prepared, pipeline, execution, planes);
        int unlike = 0, seen = 0;
        for (int y = 0; y < pipeline.height; ++y)
          for (int x = 0; x < pipeline.width; ++x) {
            const bool surface = at<uint32_t>(frame.aovs[2].image, x, y) != 0;
            float part[3];
            for (int k = 0; k < 3; ++k)
              part[k] = axis[k] * (float(frame.aovs[1].image.value(x, y, k)) - scene.camera.eye[k]);
            const float expected = surface ? (part[0] + part[1]) + part[2] : 0.0f;
            unlike += std::bit_cast<uint32_t>(expected) != at<uint32_t>(frame.aovs[0].image, x, y);
            seen += surface;
          }
        CAPTURE(info(format).name, from_depth, simd);
        CHECK(unlike == 0);
        CHECK(seen > 100);
      }
}

TEST_CASE("Overdraw counts every covered sample, hidden ones too, and those of culled faces not", "[views]") {
  Scene scene = two_squares();
  const std::string planes[] = {"overdraw", "id.object"};
  Pipeline pipeline = pipeline_of("many-lights", 60, 60);
  const auto count = [&](int x) {
    return at<uint32_t>(render_frame(scene, pipeline, {}, planes).aovs[0].image, x, 30);
  };
  // Half a height is 30 pixels: the squares reach 7.5 and 10 of them from the centre.
  CHECK(count(30) == 2);
  CHECK(count(22) == 2);
  CHECK(count(36) == 2);
  CHECK(count(37) == 1);  // the right edge goes through its centre
  CHECK(count(39) == 1);
  CHECK(count(40) == 0);
  scene.instances.push_back(scene.instances[1]);  // behind all: the depth test drops it everywhere
  CHECK(count(30) == 3);
  pipeline.geometry.depth_func = DepthFunc::never;
  CHECK(count(30) == 3);
  pipeline.geometry.cull_face = CullFace::front;
  CHECK(count(30) == 0);
}

TEST_CASE("Overdraw adds up to the fragments of a frame without culling, whatever draws it", "[views]") {
  const std::string planes[] = {"overdraw"};
  const Pipeline pipeline = pipeline_of("many-lights", 50, 40);
  for (const char* spec : {"builtin:circle", "builtin:city"}) {  // small triangles; large ones, some of them clipped
    const Scene scene = load_scene(spec);
    const PreparedScene prepared(scene);
    const Image first = render_frame(prepared, pipeline, {}, planes).aovs[0].image;
    uint64_t sum = 0;
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 50; ++x) sum += at<uint32_t>(first, x, y);
    // Without culling of geometry the counter of fragments is the same sum, from other code.
    Execution all;
    all.geometry_culling = false;
    CHECK(render_frame(prepared, pipeline, all).stats.fragments == sum);
    for (const std::string_view simd : simd_targets())
      for (const int tile : {8, 48}) {
        Execution execution;
        execution.simd = simd;
        execution.tile = tile;
        execution.geometry_culling = tile == 8;
        for (const bool fast : {false, true}) {
          execution.fast_geometry = fast;
          CAPTURE(spec, simd, tile, fast);
          CHECK(render_frame(prepared, pipeline, execution, planes).aovs[0].image.texels == first.texels);
        }
      }
  }
}

TEST_CASE("light.tile counts the lights whose range meets the box of a square's surfaces", "[views]") {
  const Scene scene = load_scene("builtin:city,lights=200");
  const std::string planes[] = {"light.tile", "light.count", "position", "id.object"};
  const Pipeline pipeline = pipeline_of("many-lights", 100, 75);
  const Frame frame = render_frame(scene, pipeline, {}, planes);
  const Image &tile = frame.aovs[0].image, &count = frame.aovs[1].image, &position = frame.aovs[2].image;
  for (int bottom = 75; bottom > 0; bottom -= 16)
    for (int left = 0; left < 100; left += 16) {
      double low[3] = {1e30, 1e30, 1e30}, high[3] = {-1e30, -1e30, -1e30};
      uint32_t most = 0;
      for (int y = std::max(bottom - 16, 0); y < bottom; ++y)
        for (int x = left; x < std::min(left + 16, 100); ++x) {
          CHECK(at<uint32_t>(tile, x, y) == at<uint32_t>(tile, left, bottom - 1));
          most = std::max(most, at<uint32_t>(count, x, y));
          for (int k = 0; k < 3 && at<uint32_t>(frame.aovs[3].image, x, y) != 0; ++k) {
            low[k] = std::min(low[k], position.value(x, y, k));
            high[k] = std::max(high[k], position.value(x, y, k));
          }
        }
      uint32_t least_count = 0, most_count = 0;
      for (const Light& light : scene.lights) {
        double d2 = 0;
        for (int k = 0; k < 3; ++k) {
          const double p = double(light.position[k]), gap = std::max({low[k] - p, p - high[k], 0.0});
          d2 += gap * gap;
        }
        least_count += std::sqrt(d2) < double(light.range) * (1 - 1e-5);
        most_count += std::sqrt(d2) < double(light.range) * (1 + 1e-5);
      }
      const uint32_t counted = at<uint32_t>(tile, left, bottom - 1);
      CAPTURE(left, bottom);
      CHECK(counted >= most);
      CHECK(counted >= least_count);
      CHECK(counted <= most_count);
    }
}

TEST_CASE("light.intensity is the target's luminance, specular the model's colour on surfaces", "[views]") {
  const Scene scene = load_scene("builtin:cornell");
  Pipeline pipeline = pipeline_of("many-lights", 40, 30);
  pipeline.target = Format::rgba32f;
  const std::string planes[] = {"light.intensity", "specular", "id.object"};
  const Frame frame = render_frame(scene, pipeline, {}, planes);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x) {
      const long double exact = 0.2126L * (long double)(frame.color.value(x, y, 0)) +
                                0.7152L * (long double)(frame.color.value(x, y, 1)) +
                                0.0722L * (long double)(frame.color.value(x, y, 2));
      CHECK(std::fabs((long double)(at<float>(frame.aovs[0].image, x, y)) - exact) <= 3.0L * exact * 0x1p-23L);
      const bool covered = at<uint32_t>(frame.aovs[2].image, x, y) != 0;
      for (int k = 0; k < 3; ++k)
        CHECK(at<float>(frame.aovs[1].image, x, y, k) == (covered ? pipeline.light_model.specular_color[k] : 0.0f));
    }
}

TEST_CASE("Planes that are not there are refused by name", "[views]") {
  const Scene scene = load_scene("builtin:cornell");
  for (const char* name : {"light.", "light.01", "light.-1", "light.x", "Depth", "", "light.99999999999999999999999"}) {
    const std::string planes[] = {name};
    CHECK_THROWS_AS(render_frame(scene, pipeline_of("many-lights", 8, 8), {}, planes), Error);
  }
  const std::string past[] = {"light." + std::to_string(scene.lights.size())};
  CHECK_THROWS_WITH(render_frame(scene, pipeline_of("many-lights", 8, 8), {}, past),
                    Catch::Contains("the scene has " + std::to_string(scene.lights.size()) + " lights"));
}
