// Views made of planes, against formulas (docs/views.md).
#include <algorithm>
#include <cmath>

#include "core/srgb.h"
#include "core/simd/simd_target.h"
#include "scenes/light_shapes.h"
#include "shading/frame.h"
#include "shading/output/heat_map.h"
#include "tests/catch.hpp"
#include "tests/shading/two_squares.h"

using namespace trueshade;
using testing::at, testing::bulb, testing::pipeline_of, testing::rgb, testing::two_squares;

TEST_CASE("The colour map's lightness only rises, and no step of 256 is more than twice the mean", "[views]") {
  const auto lightness = [](const std::array<uint8_t, 3>& code) {  // CIE 1976 L* of sRGB under D65
    long double linear[3];
    for (size_t k = 0; k < 3; ++k) {
      const long double c = code[k] / 255.0L;
      linear[k] = c <= 0.04045L ? c / 12.92L : std::pow((c + 0.055L) / 1.055L, 2.4L);
    }
    const long double y = 0.2126L * linear[0] + 0.7152L * linear[1] + 0.0722L * linear[2];
    return y > 216.0L / 24389.0L ? 116.0L * std::cbrt(y) - 16.0L : y * 24389.0L / 27.0L;
  };
  const long double mean = (lightness(heat_color(256)) - lightness(heat_color(0))) / 256.0L;
  CHECK(lightness(heat_color(0)) < 4.0L);
  CHECK(lightness(heat_color(256)) > 96.0L);
  for (int step = 1; step <= 256; ++step) {
    const long double rise = lightness(heat_color(step)) - lightness(heat_color(step - 1));
    INFO("step " << step);
    CHECK(rise > 0.0L);
    CHECK(rise < 2.0L * mean);
  }
}

TEST_CASE("A heat map's scale is the least power of two that no count exceeds, and its steps are floor(256 n / scale)",
          "[views]") {
  Image counts(4, 1, Format::r32ui);
  const auto put = [&](int x, uint32_t count) { std::memcpy(counts.texel(x, 0), &count, 4); };
  CHECK(heat_scale(counts) == 1);
  put(1, 1);
  CHECK(heat_scale(counts) == 1);
  put(2, 32);
  CHECK(heat_scale(counts) == 32);
  put(3, 33);
  CHECK(heat_scale(counts) == 64);
  const Image map = heat_image(counts, 64);
  const int steps[] = {0, 4, 128, 132};
  for (int x = 0; x < 4; ++x) {
    const std::array<uint8_t, 3> expected = heat_color(steps[x]);
    CHECK(rgb(map, x, 0) == std::array<int, 3>{expected[0], expected[1], expected[2]});
  }
}

TEST_CASE("Views of known surfaces have the colours of their formulas", "[views]") {
  const Scene scene = two_squares();
  Pipeline pipeline = pipeline_of("many-lights", 60, 60);
  pipeline.target = Format::rgba32f;
  const auto shown = [&](ImageView view, int x, int y) {
    pipeline.view = view;
    const Image image = render_frame(scene, pipeline).color;
    REQUIRE(image.format == Format::rgba8);
    CHECK(image.texel(x, y)[3] == 255);
    return rgb(image, x, y);
  };
  using Rgb = std::array<int, 3>;
  CHECK(shown(ImageView::albedo, 30, 30) == Rgb{255, 0, 0});
  CHECK(shown(ImageView::albedo, 39, 30) == Rgb{0, 255, 0});
  CHECK(shown(ImageView::albedo, 0, 0) == Rgb{24, 26, 31});
  CHECK(shown(ImageView::normal, 30, 30) == Rgb{128, 128, 255});
  CHECK(shown(ImageView::specular, 30, 30) == Rgb{137, 137, 137});  // sRGB of 0.25: 136.96
  CHECK(shown(ImageView::depth, 30, 30) == Rgb{255, 255, 255});
  CHECK(shown(ImageView::depth, 39, 30) == Rgb{32, 32, 32});  // 0.125 * 255 = 31.9
  CHECK(shown(ImageView::position, 30, 30)[2] == 255);
  CHECK(shown(ImageView::position, 39, 30)[2] == 0);
  CHECK(shown(ImageView::uv, 30, 30) == Rgb{0, 0, 0});
  const std::array<uint8_t, 3> top = heat_color(256), half = heat_color(128);
  CHECK(shown(ImageView::overdraw, 30, 30) == Rgb{top[0], top[1], top[2]});
  CHECK(shown(ImageView::overdraw, 39, 30) == Rgb{half[0], half[1], half[2]});
}

TEST_CASE("Light volumes are black boxes among the surfaces, tested for depth, one about the camera is not drawn",
          "[views]") {
  Scene scene = two_squares();
  Pipeline pipeline = pipeline_of("many-lights", 60, 60);
  pipeline.view = ImageView::light_boxes;
  using Rgb = std::array<int, 3>;
  const auto centre = [&] { return rgb(render_frame(scene, pipeline).color, 30, 30); };
  CHECK(centre() == Rgb{255, 0, 0});
  scene.lights = {bulb({0, 0, -1}, 0.5f)};  // behind the red square
  CHECK(centre() == Rgb{255, 0, 0});
  scene.lights.push_back(bulb({0, 0, 4}, 1.0f));  // about the camera
  CHECK(centre() == Rgb{255, 0, 0});
  scene.lights.push_back(bulb({0, 0, -1}, 1.25f));  // reaches 0.25 before it
  CHECK(centre() == Rgb{0, 0, 0});
  scene.lights = {bulb({0, 0, 1}, std::numeric_limits<float>::infinity())};
  CHECK(centre() == Rgb{255, 0, 0});
  // Its front face at z = 2 is 2 from the eye and 1 to each side: half of the half height, 15 pixels of 30.
  scene.lights = {bulb({0, 0, 1}, 1.0f)};
  const Image volumes = render_frame(scene, pipeline).color;
  CHECK(rgb(volumes, 44, 30) == Rgb{0, 0, 0});
  CHECK(rgb(volumes, 45, 30) == Rgb{24, 26, 31});
  pipeline.view = ImageView::light_edges;
  scene.lights[0].color = {3.0f, 1.5f, 0.0f};
  const Image edges = render_frame(scene, pipeline).color;
  CHECK(rgb(edges, 30, 30) == Rgb{255, 0, 0});  // seen through the box
}

TEST_CASE(
    "light.boxes and light.edges are the albedo with boxes over it, alpha where one is seen: what the views encode",
    "[views]") {
  Scene scene = two_squares();
  scene.lights = {bulb({0, 0, 1}, 1.0f), bulb({0.5f, 0, -1}, 0.5f)};  // the second one is behind the red square
  scene.lights[0].color = {3.0f, 1.5f, 0.0f};
  Pipeline pipeline = pipeline_of("many-lights", 60, 60);
  const std::string planes[] = {"light.boxes", "light.edges", "albedo", "id.object"};
  const Frame frame = render_frame(scene, pipeline, {}, planes);
  const Image &albedo = frame.aovs[2].image, &object = frame.aovs[3].image;
  int boxes = 0, edges = 0;
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 60; ++x) {
      const bool surface = at<uint32_t>(object, x, y) != 0;
      // The box's front face is 2 from the eye and reaches 1 to each side: 15 pixels of 30 from the centre.
      const bool inside = x >= 15 && x < 45 && y >= 15 && y < 45;
      boxes += inside;
      REQUIRE(at<float>(frame.aovs[0].image, x, y, 3) == (inside ? 1.0f : 0.0f));
      const bool edge = at<float>(frame.aovs[1].image, x, y, 3) != 0.0f;
      edges += edge;
      const float bar[] = {1.0f, 0.5f, 0.0f};
      for (int k = 0; k < 3; ++k) {
        const float under = surface ? float(albedo.value(x, y, k)) : 0.0f;
        REQUIRE(at<float>(frame.aovs[0].image, x, y, k) == (inside ? 0.0f : under));
        REQUIRE(at<float>(frame.aovs[1].image, x, y, k) == (edge ? bar[k] : under));
      }
    }
  CHECK(boxes == 900);
  CHECK(edges > 80);  // four bars of the face in front, each about 30 pixels long
  CHECK(edges < 400);
  for (size_t i = 0; i < 2; ++i) {
    pipeline.view = i == 0 ? ImageView::light_boxes : ImageView::light_edges;
    const Image view = render_frame(scene, pipeline).color;
    int unlike = 0;
    for (int y = 0; y < 60; ++y)
      for (int x = 0; x < 60; ++x) {
        const bool shown = at<uint32_t>(object, x, y) != 0 || at<float>(frame.aovs[i].image, x, y, 3) != 0.0f;
        const float* texel = reinterpret_cast<const float*>(frame.aovs[i].image.texel(x, y));
        using Rgb = std::array<int, 3>;
        const Rgb expected =
            shown ? Rgb{srgb8_from_linear(texel[0]), srgb8_from_linear(texel[1]), srgb8_from_linear(texel[2])}
                  : Rgb{24, 26, 31};
        unlike += rgb(view, x, y) != expected;
      }
    CHECK(unlike == 0);
  }
}

namespace {

bool is_nearer(DepthFunc func, float z, float there) {
  if (func == DepthFunc::less) return z < there;
  if (func == DepthFunc::lequal) return z <= there;
  return func == DepthFunc::greater ? z > there : z >= there;
}

/// Pixels at which a plane of boxes is not what a frame of the boxes alone shows where that passes the depth test
/// against the frame's, and the frame's albedo elsewhere; and pixels that show a box.
std::array<int, 2> unlike_and_boxed(const Scene& scene, const Scene& boxes, const Pipeline& pipeline,
                                    const std::string& name, const Execution& execution) {
  const std::string planes[] = {"depth", "id.object", "albedo"}, shown[] = {name};
  Pipeline over = pipeline;
  over.geometry.cull_face = CullFace::back;
  over.gbuffer.albedo.format = Format::rgba32f;
  const Frame there = render_frame(scene, pipeline, {}, planes), box = render_frame(boxes, over, {}, planes);
  const Image plane = render_frame(scene, pipeline, execution, shown).aovs[0].image;
  std::array<int, 2> count{};
  for (int y = 0; y < plane.height; ++y)
    for (int x = 0; x < plane.width; ++x) {
      const bool boxed = at<uint32_t>(box.aovs[1].image, x, y) != 0 &&
                         is_nearer(pipeline.geometry.depth_func, at<float>(box.aovs[0].image, x, y),
                                   at<float>(there.aovs[0].image, x, y));
      bool same = at<float>(plane, x, y, 3) == (boxed ? 1.0f : 0.0f);
      for (int k = 0; k < 3; ++k) {
        const double expected = boxed ? box.aovs[2].image.value(x, y, k) : there.aovs[2].image.value(x, y, k);
        same = same && double(at<float>(plane, x, y, k)) == expected;
      }
      count[0] += !same, count[1] += boxed;
    }
  return count;
}

}  // namespace

TEST_CASE("Light volumes and their edges are those of a frame of them alone, where it passes the frame's depth test",
          "[views]") {
  for (const char* spec : {"builtin:circle", "builtin:city,lights=60", "builtin:sphere,lights=90"}) {
    const Scene scene = load_scene(spec);
    const Scene boxes = light_boxes(scene), edges = light_box_edges(scene);
    int turn = 0;
    for (const DepthFunc func : {DepthFunc::less, DepthFunc::lequal, DepthFunc::greater, DepthFunc::gequal})
      for (const std::string_view simd : simd_targets()) {
        Pipeline pipeline = pipeline_of("many-lights", 77, 51);
        pipeline.geometry.depth_func = func;
        if (func == DepthFunc::greater || func == DepthFunc::gequal) pipeline.geometry.clear_depth = 0.0f;
        if (turn % 2 != 0) pipeline.geometry.viewport = {5, 3, 60, 44};
        Execution execution;
        execution.simd = simd;
        execution.tile = ++turn % 3 == 0 ? 64 : 16;
        execution.geometry_culling = turn % 4 < 2;
        execution.fast_geometry = turn % 2 != 0;
        CAPTURE(spec, int(func), simd, turn);
        const auto of_boxes = unlike_and_boxed(scene, boxes, pipeline, "light.boxes", execution);
        const auto of_edges = unlike_and_boxed(scene, edges, pipeline, "light.edges", execution);
        CHECK(of_boxes[0] + of_edges[0] == 0);
        CHECK(of_boxes[1] + of_edges[1] > 100);
      }
  }
}

TEST_CASE("Light volumes are drawn some thousands at a time: of more than that they are the same", "[views]") {
  const Scene scene = load_scene("builtin:city,lights=5000");
  const Pipeline pipeline = pipeline_of("many-lights", 67, 43);
  CHECK(unlike_and_boxed(scene, light_boxes(scene), pipeline, "light.boxes", {})[0] == 0);
  CHECK(unlike_and_boxed(scene, light_box_edges(scene), pipeline, "light.edges", {})[0] == 0);
}

TEST_CASE("Every view and plane has one set of bits, however it is drawn, and a view changes no plane", "[views]") {
  const Scene scene = load_scene("builtin:circle");
  const PreparedScene prepared(scene);
  std::vector<std::string> planes(aov_names().begin(), aov_names().end());
  planes.push_back("light.3");
  for (size_t view = 0; view < std::size(kViewNames); ++view) {
    Pipeline pipeline = pipeline_of(view % 2 ? "touchdesigner" : "many-lights", 70, 50);
    const Frame lit = render_frame(prepared, pipeline, {}, planes);
    pipeline.view = ImageView(view);
    const Frame first = render_frame(prepared, pipeline, {}, planes);
    for (const std::string_view simd : simd_targets())
      for (const int tile : {8, 32}) {
        Execution execution;
        execution.simd = simd;
        execution.tile = tile;
        execution.threads = tile == 8 ? 1 : 3;
        execution.light_culling = execution.geometry_culling = tile == 8;
        execution.shuffle_tiles = tile == 32;
        const Frame frame = render_frame(prepared, pipeline, execution, planes);
        INFO(kViewNames[view] << " " << simd << " tile " << tile);
        CHECK(frame.color.texels == first.color.texels);
        for (size_t i = 0; i < planes.size(); ++i) {
          INFO(planes[i]);
          CHECK(frame.aovs[i].name == planes[i]);
          CHECK(frame.aovs[i].image.texels == lit.aovs[i].image.texels);
        }
      }
  }
}

TEST_CASE("A view that shows nothing of the lights is the same without a light pass, and so are the planes beside it",
          "[views]") {
  const Scene scene = load_scene("builtin:circle");
  const PreparedScene prepared(scene);
  const std::vector<std::string> unlit{"normal", "depth", "Z", "overdraw", "light.tile", "normal"};
  std::vector<std::string> lit = unlit;
  lit.push_back("light.count");  // which makes the lights be drawn
  for (size_t view = 1; view < std::size(kViewNames); ++view)
    for (const char* preset : {"many-lights", "light-volumes"})
      for (const int threads : {1, 3}) {
        Pipeline pipeline = pipeline_of(preset, 70, 50);
        pipeline.view = ImageView(view);
        Execution execution;
        execution.threads = threads;
        const Frame with = render_frame(prepared, pipeline, {}, lit);
        const Frame without = render_frame(prepared, pipeline, execution, unlit);
        CAPTURE(kViewNames[view], preset, threads);
        CHECK(with.stats.evaluated_pixel_lights > 0);
        CHECK((without.stats.evaluated_pixel_lights > 0) == (pipeline.view == ImageView::light_count));
        CHECK(with.color.texels == without.color.texels);
        for (size_t i = 0; i < unlit.size(); ++i) CHECK(with.aovs[i].image.texels == without.aovs[i].image.texels);
        CHECK(render_frame(prepared, pipeline, execution).color.texels == with.color.texels);
      }
}

TEST_CASE("Views of stored planes are the formulas of each texel's value, whatever the formats of the planes",
          "[views]") {
  const Scene scene = load_scene("builtin:circle");
  const auto code = [](double x) { return int(std::floor(255.0 * std::clamp(x, 0.0, 1.0) + 0.5)); };
  const std::string planes[] = {"albedo", "normal", "position", "id.object"};
  for (const char* preset : {"many-lights", "touchdesigner", "light-volumes", "redsdk"})
    for (const Format packed : {Format::rgba32f, Format::rgba16f, Format::rgb10_a2}) {
      Pipeline pipeline = pipeline_of(preset, 67, 49);
      pipeline.gbuffer.normal.format = pipeline.gbuffer.albedo.format = packed;
      CAPTURE(preset, info(packed).name);
      Image views[3];
      Frame frame;
      for (size_t i = 0; i < 3; ++i) {
        pipeline.view = std::array{ImageView::albedo, ImageView::normal, ImageView::position}[i];
        frame = render_frame(scene, pipeline, {}, planes);
        views[i] = frame.color;
      }
      double low[3] = {1e30, 1e30, 1e30}, high[3] = {-1e30, -1e30, -1e30};
      for (int pass = 0; pass < 2; ++pass)
        for (int y = 0; y < 49; ++y)
          for (int x = 0; x < 67; ++x) {
            if (at<uint32_t>(frame.aovs[3].image, x, y) == 0) continue;
            for (int k = 0; k < 3; ++k) {
              const double place = frame.aovs[2].image.value(x, y, k), n = frame.aovs[1].image.value(x, y, k);
              low[k] = std::min(low[k], place);
              high[k] = std::max(high[k], place);
              if (pass == 0) continue;
              const bool halved = info(frame.aovs[1].image.format).number_class == NumberClass::unorm;
              REQUIRE(views[0].texel(x, y)[k] == srgb8_from_linear(float(frame.aovs[0].image.value(x, y, k))));
              REQUIRE(int(views[1].texel(x, y)[k]) == code(halved ? n : (n + 1.0) / 2.0));
              REQUIRE(int(views[2].texel(x, y)[k]) == code((place - low[k]) / (high[k] - low[k])));
            }
          }
    }
}
