// GL_RULES section 8, rows 52, 55 and 56: the light pass against a naive float32 loop written from docs/arithmetic.md
// sections 8 and 9, bit for bit, over the stored planes of the same frame.
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "oracle/scalar_renderer.h"
#include "scenes/presets.h"
#include "scenes/scene.h"
#include "shading/frame.h"
#include "tests/catch.hpp"

using namespace trueshade;

namespace {

using Random = std::mt19937_64;
float between(Random& random, double low, double high) {
  return float(low + (high - low) * double(random() >> 11) * 0x1p-53);
}

struct Vec {
  float x, y, z;
};
Vec minus(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec times(Vec a, float s) { return {a.x * s, a.y * s, a.z * s}; }
float dot(Vec a, Vec b) { return (a.x * b.x + a.y * b.y) + a.z * b.z; }
Vec unit(Vec v) {
  const float l2 = dot(v, v);
  return times(v, l2 > 0 ? 1.0f / std::sqrt(l2) : 0.0f);
}
Vec vec(const glm::vec3& v) { return {v.x, v.y, v.z}; }

float integer_power(float x, int p) {
  const double y = double(x);
  double result = 1;
  bool started = false;
  for (int bit = 13; bit >= 0; --bit) {
    if (started) result = result * result;
    if ((p >> bit & 1) == 0) continue;
    result = started ? result * y : y;
    started = true;
  }
  return float(result);
}

float real_power(float x, float p) {
  if (x == 0) return 0;
  int exponent = 0;
  double m = std::frexp(double(x), &exponent);  // [1/2, 1)
  if (m < std::sqrt(0.5)) m *= 2, exponent -= 1;
  const double s = (m - 1) / (m + 1), z = s * s, ln2 = 0.6931471805599453;
  double series = 1.0 / 21;
  for (int k = 19; k >= 1; k -= 2) series = series * z + 1.0 / k;
  const double log2 = (s * (2 / ln2)) * series + double(exponent);
  double t = double(p) * log2;
  if (t < -1000) return 0;
  if (t > 1000) t = 1000;
  const double n = std::nearbyint(t), r = (t - n) * ln2;
  double e = 1;
  for (int k = 13; k >= 1; --k) e = e * (r / k) + 1;
  return float(std::ldexp(e, int(n)));
}

float specular(Vec h, Vec n, const LightModel& model) {
  const float h2 = dot(h, h), nh = dot(n, h), t = nh > 0 ? nh : 0.0f;
  const bool integer = model.shininess <= 8192 && model.shininess == std::floor(model.shininess);
  const bool even = integer && int(model.shininess) % 2 == 0;
  float x = h2 > 0 ? (even ? (t * t) / h2 : t / std::sqrt(h2)) : 0.0f;
  if (model.renormalize && x > 1) x = 1;
  if (even) return integer_power(x, int(model.shininess) / 2);
  return integer ? integer_power(x, int(model.shininess)) : real_power(x, model.shininess);
}

struct Pixel {
  Vec position, normal;
  float albedo[4];
};

void add_light(const Light& light, const LightModel& model, const Pixel& pixel, Vec n, Vec view, float sum[3]) {
  const float color[3] = {light.color.x, light.color.y, light.color.z};
  const float ks[3] = {model.specular_color.x, model.specular_color.y, model.specular_color.z};
  if (light.type == LightType::ambient) {
    for (int k = 0; k < 3; ++k) sum[k] = sum[k] + pixel.albedo[k] * color[k];
    return;
  }
  Vec to_light{};
  float along = 0, nl = 0, f = 1;
  if (light.type == LightType::directional) {
    to_light = {-light.direction.x, -light.direction.y, -light.direction.z};
    along = nl = dot(n, to_light);
  } else {
    const Vec d_vector = minus(vec(light.position), pixel.position);
    const float d2 = dot(d_vector, d_vector), d = std::sqrt(d2), r = d2 > 0 ? 1.0f / d : 0.0f;
    along = dot(n, d_vector);
    nl = along * r;
    to_light = times(d_vector, r);
    if (model.falloff == Falloff::linear_range) {
      f = 1.0f - d / light.range;
      if (!(f > 0)) f = 0;
    } else {
      f = 1.0f / ((1.0f + light.attenuation.y * d) + (light.attenuation.z * d) * d);
    }
  }
  if (f == 0 || (model.specular_masked && !(along > 0))) return;
  const float c = nl > 0 ? nl : 0.0f;
  const Vec h = {to_light.x + view.x, to_light.y + view.y, to_light.z + view.z};
  const float s = specular(h, n, model);
  for (int k = 0; k < 3; ++k) {
    if (model.order == TermOrder::factored) {
      sum[k] = sum[k] + (pixel.albedo[k] * c + ks[k] * s) * (color[k] * f);
    } else {
      sum[k] = sum[k] + (((c * pixel.albedo[k]) * color[k]) * f + ((color[k] * s) * ks[k]) * f);
    }
  }
}

std::array<float, 4> naive(const Scene& scene, const LightModel& model, const Pixel& pixel) {
  const Vec n = model.renormalize ? unit(pixel.normal) : pixel.normal;
  const Vec view = unit(minus(vec(scene.camera.eye), pixel.position));
  float sum[3] = {0, 0, 0};
  for (const Light& light : scene.lights) add_light(light, model, pixel, n, view, sum);
  return {sum[0], sum[1], sum[2], model.alpha_from_albedo ? pixel.albedo[3] : 1.0f};
}

/// A bumpy sheet across the view, x and y in [-2, 2].
Scene sheet(Random& random) {
  Scene scene;
  scene.materials.resize(1);
  scene.instances.resize(1);
  Mesh mesh;
  for (uint32_t y = 0; y < 9; ++y)
    for (uint32_t x = 0; x < 9; ++x) {
      const float position[3] = {float(x) / 2 - 2, float(y) / 2 - 2, between(random, -0.4, 0.4)};
      const float normal[3] = {between(random, -0.5, 0.5), between(random, -0.5, 0.5), between(random, 0.5, 1)};
      for (size_t k = 0; k < 3; ++k) mesh.position[k].push_back(position[k]);
      for (size_t k = 0; k < 3; ++k) mesh.normal[k].push_back(normal[k]);
      for (size_t k = 0; k < 4; ++k) mesh.color[k].push_back(between(random, 0, 1));
      if (x == 8 || y == 8) continue;
      const uint32_t i = y * 9 + x;
      for (const uint32_t index : {i, i + 1, i + 9, i + 1, i + 10, i + 9}) mesh.indices.push_back(index);
    }
  scene.meshes = {mesh};
  scene.camera.eye = {0.2f, -0.1f, 4};
  scene.camera.fov_y_rad = 0.9f;
  return scene;
}

Light random_light(Random& random) {
  Light light;
  light.position = {between(random, -2.5, 2.5), between(random, -2.5, 2.5), between(random, -0.5, 2)};
  light.color = {between(random, 0, 2), between(random, 0, 2), between(random, 0, 2)};
  light.range = between(random, 0.2, 3);
  light.attenuation = {1, between(random, 0, 2), between(random, 0, 3)};
  const Vec d = unit({between(random, -1, 1), between(random, -1, 1), between(random, -1, 0)});
  light.direction = {d.x, d.y, d.z};
  switch (random() % 12) {
    case 0:
      light.type = LightType::ambient;
      light.color *= 0.1f;
      break;
    case 1:
      light.type = LightType::directional;
      light.color *= 0.2f;
      break;
    case 2:
      light.range = std::numeric_limits<float>::infinity();
      break;
    case 3:
      light.attenuation = {1, 0, 0};
      break;
    default:
      break;
  }
  return light;
}

Pipeline loop_pipeline(std::string_view preset) {
  Pipeline pipeline = *preset_pipeline(preset);
  pipeline.width = 57;
  pipeline.height = 43;
  pipeline.target = Format::rgba32f;
  return pipeline;
}

struct Result {
  Frame frame;
  Pixel pixel(int x, int y) const {  // y from the top
    Pixel out{};
    float texel[4];
    std::memcpy(texel, frame.aovs[0].image.texel(x, y), sizeof texel);
    out.position = {texel[0], texel[1], texel[2]};
    std::memcpy(texel, frame.aovs[1].image.texel(x, y), sizeof texel);
    out.normal = {texel[0], texel[1], texel[2]};
    const Image& albedo = frame.aovs[2].image;
    for (int k = 0; k < 4; ++k) {
      if (albedo.format == Format::rgba8) {
        out.albedo[k] = float(albedo.texel(x, y)[k]) / 255.0f;
      } else {
        std::memcpy(&out.albedo[k], albedo.texel(x, y) + 4 * k, 4);
      }
    }
    return out;
  }
  bool covered(int x, int y) const { return frame.aovs[3].image.value(x, y, 0) != 0; }
};

Result render(const Scene& scene, const Pipeline& pipeline, const Execution& execution = {}) {
  const std::string aovs[] = {"position", "normal", "albedo", "id.object"};
  return {render_frame(PreparedScene(scene), pipeline, execution, aovs)};
}

void compare_with_loop(const Scene& scene, const Pipeline& pipeline, const Result& result) {
  int covered = 0;
  for (int y = 0; y < pipeline.height; ++y)
    for (int x = 0; x < pipeline.width; ++x) {
      if (!result.covered(x, y)) continue;
      ++covered;
      const std::array<float, 4> expected = naive(scene, pipeline.light_model, result.pixel(x, y));
      std::array<float, 4> stored;
      std::memcpy(stored.data(), result.frame.color.texel(x, y), sizeof stored);
      for (size_t k = 0; k < 4; ++k) {
        CAPTURE(x, y, k, stored[k], expected[k]);
        REQUIRE(std::bit_cast<uint32_t>(stored[k]) == std::bit_cast<uint32_t>(expected[k]));
      }
    }
  REQUIRE(covered > pipeline.width * pipeline.height / 2);
}

}  // namespace

TEST_CASE("Row 56: both presets' light sums equal a naive float32 loop bit for bit") {
  Random random(56);
  for (int i = 0; i < 12; ++i)
    for (const std::string_view preset : {"many-lights", "touchdesigner"}) {
      Scene scene = sheet(random);
      for (int light = 0; light < 1 << i % 8; ++light) scene.lights.push_back(random_light(random));
      Pipeline pipeline = loop_pipeline(preset);
      // One light exactly on the surface: its distance to that pixel is 0.
      const Result dark = render(scene, pipeline);
      REQUIRE(dark.covered(30, 20));
      Light touching = random_light(random);
      touching.type = LightType::point;
      const Vec p = dark.pixel(30, 20).position;
      touching.position = {p.x, p.y, p.z};
      scene.lights.insert(scene.lights.begin() + int(random() % (scene.lights.size() + 1)), touching);
      for (const std::string_view simd : simd_targets()) {
        Execution execution;
        execution.simd = simd;
        INFO(preset << ", scene " << i << ", " << simd);
        compare_with_loop(scene, pipeline, render(scene, pipeline, execution));
      }
    }
}

TEST_CASE("Row 56: so do other light models, term by term") {
  Random random(57);
  const float shininesses[] = {0, 1, 2, 5, 60, 7.5f, 0.25f, 8192, 333.3f, 8191};
  for (int i = 0; i < 40; ++i) {
    Scene scene = sheet(random);
    for (int light = 0; light < 20; ++light) scene.lights.push_back(random_light(random));
    Pipeline pipeline = loop_pipeline("many-lights");
    LightModel& model = pipeline.light_model;
    model.renormalize = random() % 2 == 0;
    model.specular_masked = random() % 2 == 0;
    model.shininess = shininesses[size_t(i) % std::size(shininesses)];
    model.specular_color = {between(random, 0, 1), between(random, 0, 1), between(random, 0, 1)};
    model.falloff = Falloff(random() % 2);
    model.order = TermOrder(random() % 2);
    model.alpha_from_albedo = random() % 2 == 0;
    const std::vector<std::string_view> targets = simd_targets();
    Execution execution;
    execution.simd = targets[size_t(i) % targets.size()];
    INFO("model " << i << ", " << execution.simd << ", " << pipeline_json(pipeline));
    compare_with_loop(scene, pipeline, render(scene, pipeline, execution));
  }
}

TEST_CASE(
    "Row 55: 256 lights give one image, tiles 8 to 64 or no light lists, any number of threads, every SIMD target") {
  Random random(55);
  for (const std::string_view preset : {"many-lights", "touchdesigner"}) {
    Scene scene = sheet(random);
    for (int light = 0; light < 256; ++light) scene.lights.push_back(random_light(random));
    for (const Format target : {Format::rgba8, Format::rgba16f, Format::rgba32f}) {
      Pipeline pipeline = loop_pipeline(preset);
      pipeline.target = target;
      Execution brute;
      brute.light_culling = false;
      brute.simd = "scalar";
      brute.threads = 1;
      const Image expected = render(scene, pipeline, brute).frame.color;
      for (const std::string_view simd : simd_targets())
        for (const int tile : {8, 16, 32, 48, 64})
          for (const bool culling : {false, true}) {
            Execution execution;
            execution.simd = simd;
            execution.tile = tile;
            execution.threads = tile == 8 ? 3 : tile == 16 ? 2 : tile == 32 ? 8 : 1;
            execution.light_culling = culling;
            execution.shuffle_tiles = tile == 16;
            INFO(preset << ", " << simd << ", tile " << tile << ", culling " << culling);
            REQUIRE(render(scene, pipeline, execution).frame.color.texels == expected.texels);
          }
    }
  }
}

TEST_CASE("Row 55: lights without a range light surfaces whose stored or squared position overflows, culled or not") {
  Random random(550);
  for (const bool overflow_of_half : {true, false}) {
    Scene scene = sheet(random);
    Light ambient, directional;
    ambient.type = LightType::ambient;
    directional.type = LightType::directional;
    directional.direction = {0, 0, -1};
    scene.lights = {ambient, directional, random_light(random)};
    Pipeline pipeline = loop_pipeline("many-lights");
    if (overflow_of_half) {  // 1e5 is infinite in a half
      pipeline.gbuffer.position.format = Format::rgb16f;
      pipeline.gbuffer.half_round = HalfRound::nearest;
      for (glm::vec3* place : {&scene.camera.eye, &scene.camera.target, &scene.instances[0].world_from_object[3]})
        *place += glm::vec3(1e5f, 1e5f, 1e5f);
    } else {  // a sheet of 2e20 a side, seen by a matrix of its size
      for (int axis = 0; axis < 3; ++axis) scene.instances[0].world_from_object[axis][axis] = 1e18f;
      for (auto& stream : scene.meshes[0].position)
        for (float& value : stream) value = value * 100 + 1000;
      scene.camera.clip_from_world = {5e-21f, 0, 0, 0, 0, 5e-21f, 0, 0, 0, 0, 1e-22f, 0, -5, -5, 0, 1};
    }
    Execution brute;
    brute.light_culling = false;
    const Result expected = render(scene, pipeline, brute);
    REQUIRE(expected.covered(30, 20));
    float red;
    std::memcpy(&red, expected.frame.color.texel(30, 20), sizeof red);
    REQUIRE(red > 0);
    for (const std::string_view simd : simd_targets()) {
      Execution execution;
      execution.simd = simd;
      INFO(overflow_of_half << " " << simd);
      CHECK(render(scene, pipeline, execution).frame.color.texels == expected.frame.color.texels);
    }
  }
}

TEST_CASE(
    "Row 52: attenuation (1, 0.14, 0.07) at distance 2 is 0x3F241A42 give or take an ulp, a directional light has "
    "none") {
  Random random(52);
  Scene scene = sheet(random);
  for (float& z : scene.meshes[0].position[2]) z = 0;
  for (size_t k = 0; k < 3; ++k)
    for (float& n : scene.meshes[0].normal[k]) n = k == 2 ? 1.0f : 0.0f;
  for (auto& channel : scene.meshes[0].color)
    for (float& c : channel) c = 1;
  Pipeline pipeline = loop_pipeline("touchdesigner");
  pipeline.light_model.specular_color = {0, 0, 0};
  const Vec p = render(scene, pipeline).pixel(30, 20).position;
  REQUIRE(p.z == 0);
  Light light;
  light.position = {p.x, p.y, 2};
  light.attenuation = {1, 0.14f, 0.07f};
  scene.lights = {light};
  const auto red_bits = [&](std::string_view simd) {
    Execution execution;
    execution.simd = simd;
    float value;
    std::memcpy(&value, render(scene, pipeline, execution).frame.color.texel(30, 20), 4);
    return int64_t(std::bit_cast<uint32_t>(value));
  };
  for (const std::string_view simd : simd_targets()) {
    INFO(simd);
    scene.lights[0].type = LightType::point;
    CHECK(std::abs(red_bits(simd) - 0x3F241A42) <= 1);
    scene.lights[0].type = LightType::directional;
    scene.lights[0].direction = {0, 0, -1};
    CHECK(red_bits(simd) == 0x3F800000);
  }
}

TEST_CASE("The light sums of both presets are the real numbers' to within the bounds of their roundings") {
  Random random(58);
  for (const std::string_view preset : {"many-lights", "touchdesigner"})
    for (int i = 0; i < 4; ++i) {
      Scene scene = sheet(random);
      for (int light = 0; light < 50; ++light) scene.lights.push_back(random_light(random));
      const Pipeline pipeline = loop_pipeline(preset);
      const LightModel& model = pipeline.light_model;
      const Result result = render(scene, pipeline);
      for (int y = 0; y < pipeline.height; ++y)
        for (int x = 0; x < pipeline.width; ++x) {
          if (!result.covered(x, y)) continue;
          const Pixel pixel = result.pixel(x, y);
          oracle::Surface surface{{pixel.position.x, pixel.position.y, pixel.position.z},
                                  {pixel.normal.x, pixel.normal.y, pixel.normal.z},
                                  {pixel.albedo[0], pixel.albedo[1], pixel.albedo[2]}};
          const std::array<double, 3> real = oracle::lit_color(surface, scene, model);
          for (size_t k = 0; k < 3; ++k) {
            // Each light: some ten roundings of its terms, and shininess times those of N.H (GL_RULES section 6).
            double bound = 0;
            for (const Light& light : scene.lights)
              bound += double(light.color[int(k)]) * (double(pixel.albedo[k]) + double(model.specular_color[int(k)]));
            bound *= (12 + 4 * double(model.shininess) + double(scene.lights.size())) * 0x1p-24;
            float stored;
            std::memcpy(&stored, result.frame.color.texel(x, y) + 4 * k, 4);
            CAPTURE(preset, i, x, y, k, stored, real[k], bound);
            REQUIRE(std::fabs(double(stored) - real[k]) <= bound);
          }
        }
    }
}
