// The four strategies against each other, against exact coverage, and against the costs their sources state.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <tuple>

#include "core/fp_env.h"
#include "core/simd/simd_target.h"
#include "oracle/exact_coverage.h"
#include "oracle/matrices.h"
#include "oracle/scalar_renderer.h"
#include "raster/light_geometry/light_outlines.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "shading/frame.h"
#include "tests/catch.hpp"
#include "tests/stated_presets.h"

using namespace trueshade;

namespace {

constexpr Strategy kEachStrategy[] = {Strategy::forward_multipass, Strategy::forward_loop, Strategy::deferred_volumes,
                                      Strategy::deferred_loop};

/// many-lights with RGBA32F planes, lights as quads.
Pipeline float_planes(Strategy strategy, Format target) {
  Pipeline p;
  p.width = 120;
  p.height = 90;
  p.gbuffer.albedo.format = Format::rgba32f;
  p.strategy = strategy;
  p.target = target;
  return p;
}

std::string hash(const PreparedScene& scene, const Pipeline& pipeline, const Execution& execution = {}) {
  return image_hash(render_frame(scene, pipeline, execution).color);
}

/// A square of half side `half` in the plane z, facing the eye at (0, 0, 5), drawn `times` times.
Scene squares(int times, float half = 10.0f) {
  Scene scene;
  scene.spec = "squares";
  scene.camera.eye = {0.0f, 0.0f, 5.0f};
  scene.camera.target = {0.0f, 0.0f, 0.0f};
  Mesh mesh;
  for (const auto& [x, y] : {std::pair{-half, -half}, {half, -half}, {half, half}, {-half, half}}) {
    mesh.position[0].push_back(x), mesh.position[1].push_back(y), mesh.position[2].push_back(0.0f);
    mesh.normal[0].push_back(0.0f), mesh.normal[1].push_back(0.0f), mesh.normal[2].push_back(1.0f);
  }
  mesh.indices = {0, 1, 2, 0, 2, 3};
  scene.meshes.push_back(mesh);
  scene.materials.push_back({"white", glm::vec4(1.0f)});
  for (int i = 0; i < times; ++i) scene.instances.push_back({0, 0, glm::mat4x3(1.0f)});
  return scene;
}

Light ambient(float strength) {
  Light light;
  light.type = LightType::ambient;
  light.color = glm::vec3(strength);
  return light;
}

}  // namespace

TEST_CASE("With RGBA32F planes forward-loop is deferred-loop and forward-multipass is full-screen deferred-volumes") {
  for (const char* name : {"builtin:city", "builtin:cornell", "builtin:circle", "builtin:sphere"}) {
    const Scene scene = builtin_scene(std::string(name).substr(8));
    const PreparedScene prepared(scene);
    for (const Format target : {Format::rgba8, Format::rgba16f, Format::rgba32f, Format::srgb8_a8, Format::rgb10_a2}) {
      INFO(name << " into " << info(target).name);
      const auto drawn = [&](Strategy s) { return hash(prepared, float_planes(s, target)); };
      CHECK(drawn(Strategy::forward_loop) == drawn(Strategy::deferred_loop));
      if (std::string(name) != "builtin:city")  // it has coincident faces
        CHECK(drawn(Strategy::forward_multipass) == drawn(Strategy::deferred_volumes));
      if (target == Format::rgba8 && std::string(name) == "builtin:city")
        CHECK(drawn(Strategy::deferred_volumes) != drawn(Strategy::deferred_loop));  // rounded 757 times, or once
    }
  }
}

namespace {

/// Pixels where multipass and full-screen volumes are not alike, and what long double says of their depths.
struct Ties {
  int differ = 0, alone = 0, less = 0, equal_faces = 0, covered = 0;
};

Ties ties_of(const Scene& scene, int width, int height) {
  const PreparedScene prepared(scene);
  Pipeline pipeline = float_planes(Strategy::forward_multipass, Format::rgba32f);
  pipeline.width = width, pipeline.height = height;
  const oracle::ScalarFrame exact = oracle::scalar_frame(scene, pipeline);
  const Image multipass = render_frame(prepared, pipeline).color;
  pipeline.strategy = Strategy::deferred_volumes;
  const Image volumes = render_frame(prepared, pipeline).color;
  Ties ties;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::vector<oracle::Fragment>& fragments = exact.at(x, height - 1 - y);
      if (fragments.empty()) continue;
      ++ties.covered;
      const auto seen = std::min_element(fragments.begin(), fragments.end(),
                                         [](const auto& a, const auto& b) { return a.depth < b.depth; });
      // Stored depths are equal only where exact ones are less than a float apart.
      const auto coincides = [&](const oracle::Fragment& f) { return f.depth - seen->depth <= 0x1p-23L * seen->depth; };
      const bool tied = std::count_if(fragments.begin(), fragments.end(), coincides) > 1;
      ties.equal_faces += tied ? 1 : 0;
      if (std::memcmp(multipass.texel(x, y), volumes.texel(x, y), 16) == 0) continue;
      ++ties.differ;
      ties.alone += tied ? 0 : 1;
      for (int c = 0; c < 3; ++c) ties.less += multipass.value(x, y, c) < volumes.value(x, y, c) ? 1 : 0;
    }
  return ties;
}

}  // namespace

TEST_CASE("Pictures by multipass and by full-screen volumes differ at coincident faces alone, which are added up") {
  for (const auto& [name, width, height] : {std::tuple{"city", 120, 90}, {"atrium", 100, 75}}) {
    const Ties ties = ties_of(builtin_scene(name), width, height);
    CAPTURE(name, ties.differ, ties.equal_faces, ties.covered);
    CHECK(ties.alone == 0);
    CHECK(ties.less == 0);
    CHECK(ties.differ > 0);
    CHECK(ties.equal_faces < ties.covered / 50);  // the rest of the picture is equal, bit for bit
  }
}

TEST_CASE("Every strategy draws one image, whatever the culling, threads, tiles, SIMD target and order of tiles") {
  const Scene scene = builtin_scene("city,lights=120");
  const PreparedScene prepared(scene);
  struct Volumes {
    LightExtent extent;
    CullFace cull;
    bool base, alpha;
  };
  const Volumes volumes[] = {{LightExtent::range, CullFace::none, true, false},
                             {LightExtent::box, CullFace::front, false, true},
                             {LightExtent::sphere, CullFace::back, false, true},
                             {LightExtent::box, CullFace::none, true, true}};
  for (const Strategy strategy : kEachStrategy)
    for (const Volumes& v : volumes) {
      if (strategy != Strategy::deferred_volumes && v.extent != LightExtent::range) continue;
      for (const Format target : {Format::rgba8, Format::rgba16f}) {
        Pipeline p = float_planes(strategy, target);
        p.light_volumes.point = v.extent;
        p.light_volumes.cull_face = v.cull;
        p.light_volumes.base = v.base;
        p.blend.mask[3] = v.alpha;
        const std::string once = hash(prepared, p);
        INFO(name_of(strategy) << ", extent " << int(v.extent) << ", cull " << int(v.cull) << ", "
                               << info(target).name);
        CHECK(hash(prepared, p, {.light_culling = false}) == once);
        CHECK(hash(prepared, p, {.compiled_models = false}) == once);
        CHECK(hash(prepared, p, {.fast_geometry = false}) == once);
        CHECK(hash(prepared, p, {.threads = 1, .tile = 8, .shuffle_tiles = true}) == once);
        CHECK(hash(prepared, p, {.threads = 3, .tile = 48, .geometry_culling = false}) == once);
        for (const std::string_view simd : simd_targets())
          CHECK(hash(prepared, p, {.tile = 16, .simd = simd, .count_as_gl = true}) == once);
      }
    }
}

TEST_CASE("Row 50 in a frame: 64 lights of a quarter code leave nothing where each is blended, 16 codes where summed") {
  Scene scene = squares(1);
  for (int i = 0; i < 64; ++i) scene.lights.push_back(ambient(0.25f / 255.0f));
  for (const Strategy strategy : kEachStrategy) {
    for (const std::string_view simd : simd_targets())
      for (const int tile : {8, 64}) {
        const Image image =
            render_frame(scene, float_planes(strategy, Format::rgba8), {.tile = tile, .simd = simd}).color;
        INFO(name_of(strategy) << ", " << simd << ", tile " << tile);
        const uint8_t* texel = image.texel(60, 45);
        CHECK(int(texel[0]) == (blends_lights(strategy) ? 0 : 16));
        CHECK(int(texel[3]) == 255);
      }
  }
}

TEST_CASE("Fragments that share a pixel's depth are drawn by every light but the first, as by OpenGL") {
  for (const int times : {1, 2, 5}) {
    Scene scene = squares(times);
    for (const float strength : {0.125f, 0.03125f, 0.0625f}) scene.lights.push_back(ambient(strength));
    const Image image = render_frame(scene, float_planes(Strategy::forward_multipass, Format::rgba32f)).color;
    // The first light is drawn once: coincident fragments fail LESS. The others find them all EQUAL.
    CHECK(image.value(60, 45, 0) == 0.125 + times * (0.03125 + 0.0625));
    CHECK(image.value(60, 45, 3) == 1.0);
  }
}

TEST_CASE("Without lights a surface is black with its alpha, and the rest is the clear colour") {
  Scene scene = squares(1, 1.0f);
  scene.clear = {0.25f, 0.5f, 0.75f, 0.5f};
  for (const Strategy strategy : kEachStrategy) {
    const Image image = render_frame(scene, float_planes(strategy, Format::rgba32f)).color;
    INFO(name_of(strategy));
    for (int c = 0; c < 4; ++c) {
      CHECK(image.value(60, 45, c) == (c == 3 ? 1.0 : 0.0));
      CHECK(image.value(0, 0, c) == double(scene.clear[c]));
    }
  }
}

TEST_CASE("Alpha is written where a light's extent leaves fragments, and not where it discards them") {
  Scene scene = squares(1);
  Light light;
  light.position = {0.0f, 0.0f, 0.5f};
  light.range = 1.0f;
  scene.lights.push_back(light);
  Pipeline p = float_planes(Strategy::deferred_volumes, Format::rgba8);
  p.light_volumes = {LightExtent::range, LightExtent::range, 16, 8, CullFace::none, true, false};
  p.blend.mask[3] = true;
  const std::vector<std::string> planes{"position"};
  const Frame frame = render_frame(scene, p, {}, planes);
  size_t inside = 0, wrong = 0;
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x) {
      double d2 = 0.25;
      for (int c = 0; c < 2; ++c) d2 += std::pow(frame.aovs[0].image.value(x, y, c), 2.0);
      if (std::abs(d2 - 1.0) < 1e-4) continue;
      inside += d2 < 1.0;
      wrong += (int(frame.color.texel(x, y)[3]) == 255) != (d2 < 1.0);
    }
  CHECK(inside > 100);
  CHECK(wrong == 0);
}

TEST_CASE("Each light shows where exact integers say its geometry is, as often as that covers the pixel") {
  const FpScope fp;
  Scene scene = squares(1);
  for (int i = 0; i < 12; ++i) {
    Light light;
    light.type = i % 2 == 0 ? LightType::point : LightType::spot;
    light.position = {0.7f * float(i % 4) - 1.1f, 0.5f * float(i / 4) - 0.6f, 0.4f + 0.3f * float(i % 5)};
    light.range = 0.3f + 0.35f * float(i);  // the last contain the eye
    light.cone_rad = 0.2f + 0.1f * float(i);
    scene.lights.push_back(light);
  }
  const std::vector<Light> lights = scene.lights;
  for (const CullFace cull : {CullFace::none, CullFace::front, CullFace::back})
    for (const LightExtent extent : {LightExtent::box, LightExtent::sphere, LightExtent::cone}) {
      Pipeline p = float_planes(Strategy::deferred_volumes, Format::rgba32f);
      p.light_model.falloff = Falloff::none;
      p.light_volumes.point = p.light_volumes.spot = extent;
      p.light_volumes.cull_face = cull;
      Pipeline everywhere = p;
      everywhere.light_volumes.point = everywhere.light_volumes.spot = LightExtent::unbounded;
      const LightMeshes meshes(p.light_volumes);
      const Matrix4 clip = oracle::projection_of(scene.camera, p.geometry, p.width, p.height);
      for (const Light& light : lights) {
        scene.lights = {light};
        const Image drawn = render_frame(scene, p).color, whole = render_frame(scene, everywhere).color;
        const LightMesh& mesh = meshes[drawn_extent(light, p.light_volumes)];
        std::vector<glm::vec3> vertices(mesh.unit.size());
        light_vertices(mesh, light, vertices);
        std::vector<oracle::ClipTriangleValues> triangles;
        for (size_t i = 0; i < mesh.indices.size(); i += 3) {
          oracle::ClipTriangleValues t{};
          for (size_t k = 0; k < 3; ++k)
            for (size_t r = 0; r < 4; ++r) {
              const glm::vec3 v = vertices[mesh.indices[i + k]];
              t.vertex[k][r] =
                  ((float(clip[r]) * v.x + float(clip[4 + r]) * v.y) + float(clip[8 + r]) * v.z) + float(clip[12 + r]);
            }
          triangles.push_back(t);
        }
        std::vector<uint16_t> counts(size_t(p.width * p.height));
        oracle::count_exactly(triangles, light_geometry_state(p), p.width, p.height, counts);
        size_t wrong = 0;
        for (int y = 0; y < p.height; ++y)
          for (int x = 0; x < p.width; ++x) {
            const float once = float(whole.value(x, y, 0));
            float expected = 0.0f;
            for (int n = counts[size_t((p.height - 1 - y) * p.width + x)]; n > 0; --n) expected += once;
            wrong += float(drawn.value(x, y, 0)) != expected;
          }
        INFO("cull " << int(cull) << ", extent " << int(extent) << ", range " << light.range);
        CHECK(wrong == 0);
      }
    }
}

TEST_CASE("Costs are the lecture's: N L, N (L - 1), N L, N L, N, P, 3 P, 3 N + P, N L, 3 N, 3 N + N") {
  const Scene scene = builtin_scene("city,lights=30");
  const PreparedScene prepared(scene);
  const uint64_t lights = 30, objects = scene.instances.size();
  const auto costs = [&](Strategy strategy, bool base, bool culled) {
    Pipeline p = float_planes(strategy, Format::rgba8);
    p.light_volumes = {LightExtent::box, LightExtent::box, 16, 8, CullFace::front, true, base};
    return render_frame(prepared, p, {.light_culling = culled, .geometry_culling = culled, .count_as_gl = true}).stats;
  };
  for (const bool culled : {true, false}) {
    const FrameStats multipass = costs(Strategy::forward_multipass, false, culled),
                     loop = costs(Strategy::forward_loop, false, culled),
                     volumes = costs(Strategy::deferred_volumes, false, culled),
                     based = costs(Strategy::deferred_volumes, true, culled),
                     deferred = costs(Strategy::deferred_loop, false, culled);
    const uint64_t n = multipass.covered_pixels, p = volumes.gl.light_pixels;
    CHECK(n > 5000);
    CHECK((p > 0 && p < n * lights));
    CHECK(multipass.gl.material_computations == n * lights);
    CHECK(multipass.gl.target_fragments_read == n * (lights - 1));
    CHECK(multipass.gl.fragments_written == n * lights);
    CHECK(multipass.gl.draws == objects * lights);
    CHECK(loop.gl.material_computations == n * lights);
    CHECK(loop.gl.fragments_written == n);
    CHECK(loop.gl.target_fragments_read == 0);
    CHECK(loop.gl.draws == objects);
    CHECK(volumes.gl.material_computations == p);
    CHECK(volumes.gl.gbuffer_fragments_read == 3 * p);
    CHECK(volumes.gl.target_fragments_read == p);
    CHECK(volumes.gl.fragments_written == 3 * n + p);
    CHECK(volumes.gl.draws == objects + lights);
    CHECK(volumes.gl.light_triangles == 12 * lights);
    // The base is one more draw of a quad, over N pixels, that computes no material and blends with nothing.
    CHECK(based.gl.light_pixels == p + n);
    CHECK(based.gl.material_computations == p);
    CHECK(based.gl.gbuffer_fragments_read == 3 * (p + n));
    CHECK(based.gl.target_fragments_read == p);
    CHECK(based.gl.fragments_written == 3 * n + p + n);
    CHECK(based.gl.draws == objects + lights + 1);
    CHECK(based.gl.light_triangles == 12 * lights + 2);
    CHECK(deferred.gl.material_computations == n * lights);
    CHECK(deferred.gl.gbuffer_fragments_read == 3 * n);
    CHECK(deferred.gl.target_fragments_read == 0);
    CHECK(deferred.gl.fragments_written == 3 * n + n);
    CHECK(deferred.gl.draws == objects + 1);
  }
}

TEST_CASE("Costs count the planes that a preset's lights read: three, and specular and emission where it has them") {
  const Scene scene = builtin_scene("lecture");
  const PreparedScene prepared(scene);
  for (const Preset& preset : stated_presets())
    for (const Strategy strategy : kEachStrategy) {
      Pipeline p = preset.pipeline;
      p.width = 64, p.height = 48;
      p.strategy = strategy;
      const FrameStats stats = render_frame(prepared, p, {.count_as_gl = true}).stats;
      const uint64_t n = stats.covered_pixels, lights = scene.lights.size(), objects = scene.instances.size();
      const bool volumes = strategy == Strategy::deferred_volumes,
                 deferred = volumes || strategy == Strategy::deferred_loop;
      const bool material = preset.name == "gl-fixed" || preset.name == "punctual";
      const uint64_t base = volumes && p.light_volumes.base ? 1 : 0, drawn = volumes ? stats.gl.light_pixels : n;
      INFO(preset.name << ", " << name_of(strategy));
      CHECK(n > 1000);
      CHECK(stats.gl.planes >= (deferred ? 3 : 0));
      CHECK((stats.gl.planes > 3) == (deferred && material));
      CHECK(stats.gl.material_computations == (volumes ? drawn - base * n : n * lights));
      CHECK(stats.gl.gbuffer_fragments_read == uint64_t(stats.gl.planes) * drawn);
      CHECK(stats.gl.fragments_written == (deferred ? uint64_t(stats.gl.planes) * n + drawn
                                           : strategy == Strategy::forward_multipass ? n * lights
                                                                                     : n));
      CHECK(stats.gl.draws == (volumes                                   ? objects + lights + base
                               : deferred                                ? objects + 1
                               : strategy == Strategy::forward_multipass ? objects * lights
                                                                         : objects));
    }
}

TEST_CASE("P is what is left on the target when every draw adds one") {
  Scene scene = builtin_scene("city,lights=30");
  scene.clear = glm::vec4(0.0f);
  Pipeline p = float_planes(Strategy::deferred_volumes, Format::rgba32f);
  p.light_volumes = {LightExtent::box, LightExtent::box, 16, 8, CullFace::none, true, false};
  p.blend.mask[3] = true;  // alpha 1, ONE, ONE
  const Frame frame = render_frame(scene, p, {.count_as_gl = true});
  double sum = 0.0;
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x) sum += frame.color.value(x, y, 3);
  CHECK(double(frame.stats.gl.light_pixels) == sum);
}

TEST_CASE("City in the paper's way has 3,247 draws, 9,084 triangles of lights and 29,880 of cubes") {
  const Scene scene = builtin_scene("city");
  Pipeline p = float_planes(Strategy::deferred_volumes, Format::rgba8);
  p.light_volumes = {LightExtent::box, LightExtent::box, 16, 8, CullFace::front, true, false};
  const FrameStats stats = render_frame(scene, p).stats;
  CHECK(stats.gl.draws == 3247);
  CHECK(stats.gl.light_triangles == 9084);
  CHECK(stats.triangles == 29880);
}
