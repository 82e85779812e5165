// The light models that ship, held to the formulas of their sources in double.
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "core/simd/simd_target.h"
#include "programs/front/light_program.h"
#include "scenes/light_cone.h"
#include "scenes/pipeline/shipped_models.h"
#include "tests/catch.hpp"
#include "tests/programs/random_words.h"
#include "tests/programs/run_program.h"

namespace trueshade::programs {
namespace {

using glm::dvec3;
using std::numbers::pi;

/// What a model is given at one pixel under one light.
struct LitPixel {
  dvec3 position, normal, eye, albedo, specular;
  double metallic, roughness, shininess, occlusion;
  Light light;
  double parameter = 0;
};

double square(double x) { return x * x; }
double clamped(double x) { return std::min(std::max(x, 0.0), 1.0); }
dvec3 mix(const dvec3& a, const dvec3& b, double t) { return a * (1 - t) + b * t; }

/// Unit vectors, and their cosines.
struct Angles {
  dvec3 n, l, v, h;
  double nl, nv, nh, vh;

  explicit Angles(const LitPixel& c)
      : n(glm::normalize(c.normal)),
        l(c.light.type == LightType::directional ? -dvec3(c.light.direction)
                                                 : glm::normalize(dvec3(c.light.position) - c.position)),
        v(glm::normalize(c.eye - c.position)),
        h(glm::normalize(l + v)),
        nl(glm::dot(n, l)),
        nv(glm::dot(n, v)),
        nh(glm::dot(n, h)),
        vh(glm::dot(v, h)) {}
};

// Fall-offs by distance and range.
double khr_falloff(double d, double range) {
  return std::max(std::min(1 - std::pow(d / range, 4), 1.0), 0.0) / (d * d);
}
double ue4_falloff(double d, double range) { return square(clamped(1 - std::pow(d / range, 4))) / (d * d + 1); }
double frostbite_falloff(double d, double range) {
  return square(clamped(1 - std::pow(d / range, 4))) / std::max(d * d, square(0.01));
}

/// KHR_lights_punctual, "Inner and Outer Cone Angles".
double cone(const LitPixel& c, const Angles& a) {
  if (c.light.type != LightType::spot) return 1;
  const double inner = std::cos(double(c.light.cone_rad));
  const double outer = std::cos(double(c.light.cone_rad) + double(c.light.penumbra_rad));
  const double scale = 1 / std::max(0.001, inner - outer);
  return square(clamped(glm::dot(dvec3(c.light.direction), -a.l) * scale - outer * scale));
}

dvec3 arriving(const LitPixel& c, const Angles& a, double (*falloff)(double, double) = khr_falloff) {
  if (c.light.type == LightType::directional) return dvec3(c.light.color);
  const double d = glm::length(dvec3(c.light.position) - c.position);
  return dvec3(c.light.color) * (falloff(d, double(c.light.range)) * cone(c, a));
}

double ggx(double nh, double alpha) {
  return nh > 0 ? square(alpha) / (pi * square(square(nh) * (square(alpha) - 1) + 1)) : 0;
}
dvec3 schlick(const dvec3& f0, double cosine) { return f0 + (dvec3(1) - f0) * std::pow(1 - cosine, 5); }
dvec3 f0_of(const LitPixel& c) { return mix(dvec3(0.04), c.albedo, c.metallic); }
dvec3 diffuse_of(const LitPixel& c) { return c.albedo * (1 - c.metallic); }

dvec3 gltf(const LitPixel& c) {
  const Angles a(c);
  const double alpha = std::max(square(c.roughness), 0.001);
  const auto g = [&](double x) {
    return 2 * std::abs(x) / (std::abs(x) + std::sqrt(square(alpha) + (1 - square(alpha)) * square(x)));
  };
  const dvec3 f = schlick(f0_of(c), std::abs(a.vh));
  const double specular = ggx(a.nh, alpha) * g(a.nl) * g(a.nv) / (4 * std::abs(a.nl) * std::abs(a.nv));
  return ((dvec3(1) - f) * diffuse_of(c) / pi + f * specular) * arriving(c, a) * a.nl;
}

dvec3 ue4(const LitPixel& c) {
  const Angles a(c);
  const double nv = std::max(a.nv, 1e-4), alpha = std::max(square(c.roughness), 0.001), k = square(c.roughness + 1) / 8;
  const auto g1 = [k](double x) { return x / (x * (1 - k) + k); };
  const dvec3 f0 = f0_of(c), f = f0 + (dvec3(1) - f0) * std::pow(2.0, (-5.55473 * a.vh - 6.98316) * a.vh);
  const dvec3 mirror = f * (ggx(a.nh, alpha) * g1(a.nl) * g1(nv) / (4 * a.nl * nv));
  return (diffuse_of(c) / pi + mirror) * arriving(c, a, ue4_falloff) * a.nl;
}

double burley(double nl, double nv, double f90) {
  return (1 + (f90 - 1) * std::pow(1 - nl, 5)) * (1 + (f90 - 1) * std::pow(1 - nv, 5));
}

dvec3 frostbite(const LitPixel& c) {
  const Angles a(c);
  const double nv = std::min(std::abs(a.nv) + 1e-5, 1.0), alpha = std::max(square(c.roughness), 0.002),
               a2 = square(alpha);
  const double lambda_v = a.nl * std::sqrt((-nv * a2 + nv) * nv + a2),
               lambda_l = nv * std::sqrt((-a.nl * a2 + a.nl) * a.nl + a2);
  const dvec3 mirror = schlick(f0_of(c), a.vh) * (ggx(a.nh, alpha) * 0.5 / (lambda_v + lambda_l));
  const double bias = 0.5 * c.roughness, factor = 1 - c.roughness + c.roughness / 1.51;
  const double scattered = burley(a.nl, nv, bias + 2 * square(a.vh) * c.roughness) * factor;
  return (diffuse_of(c) * scattered / pi + mirror) * arriving(c, a, frostbite_falloff) * a.nl;
}

dvec3 disney(const LitPixel& c) {
  const Angles a(c);
  const double nv = std::max(a.nv, 1e-4), alpha = std::max(square(c.roughness), 0.001),
               g = square(0.5 + c.roughness / 2);
  const auto smith = [g](double x) { return 1 / (x + std::sqrt(square(g) + square(x) - square(g) * square(x))); };
  const dvec3 mirror = schlick(f0_of(c), a.vh) * (ggx(a.nh, alpha) * smith(a.nl) * smith(nv));
  const double scattered = burley(a.nl, nv, 0.5 + 2 * square(a.vh) * c.roughness);
  return (diffuse_of(c) * scattered / pi + mirror) * arriving(c, a) * a.nl;
}

double tan2(double cosine) { return (1 - square(cosine)) / square(cosine); }

dvec3 cook_torrance(const LitPixel& c) {
  const Angles a(c);
  const double nv = std::max(a.nv, 1e-4), nh = std::max(a.nh, 1e-3), vh = std::max(a.vh, 1e-4);
  const double m2 = square(std::max(square(c.roughness), 0.01));
  const double d = std::exp(-tan2(nh) / m2) / (pi * m2 * std::pow(nh, 4));
  const double g = std::min({1.0, 2 * nh * nv / vh, 2 * nh * a.nl / vh});
  dvec3 f;
  for (int i = 0; i < 3; ++i) {
    const double root = std::sqrt(std::min(f0_of(c)[i], 0.99)), index = (1 + root) / (1 - root);
    const double b = std::sqrt(square(index) + square(vh) - 1);
    f[i] = 0.5 * square((b - vh) / (b + vh)) * (1 + square((vh * (b + vh) - 1) / (vh * (b - vh) + 1)));
  }
  return (diffuse_of(c) / pi + f * (d * g / (4 * a.nl * nv))) * arriving(c, a) * a.nl;
}

dvec3 blinn_phong(const LitPixel& c) {
  const Angles a(c);
  const double shine = (c.shininess + 8) / (8 * pi) * std::pow(std::max(a.nh, 0.0), c.shininess);
  return (c.albedo / pi + c.specular * shine) * arriving(c, a) * a.nl;
}

dvec3 oren_nayar(const LitPixel& c) {
  const Angles a(c);
  const double s2 = square(c.roughness), in = std::acos(a.nl), out = std::acos(a.nv);
  const dvec3 flat_l = a.l - a.n * a.nl, flat_v = a.v - a.n * a.nv;
  const double around = glm::dot(flat_l, flat_v) / (glm::length(flat_l) * glm::length(flat_v));
  const double rough =
      0.45 * s2 / (s2 + 0.09) * std::max(0.0, around) * std::sin(std::max(in, out)) * std::tan(std::min(in, out));
  return c.albedo / pi * (1 - 0.5 * s2 / (s2 + 0.33) + rough) * arriving(c, a) * a.nl;
}

dvec3 ward(const LitPixel& c) {
  const Angles a(c);
  const double alpha2 = square(std::max(square(c.roughness), 0.01)), nv = std::max(a.nv, 1e-4),
               nh = std::max(a.nh, 1e-3);
  const double gloss = std::exp(-tan2(nh) / alpha2) / (4 * pi * alpha2) / std::sqrt(a.nl * nv);
  return (diffuse_of(c) / pi + f0_of(c) * gloss) * arriving(c, a) * a.nl;
}

dvec3 charlie(const LitPixel& c) {
  const Angles a(c);
  const double r = std::max(c.roughness, 0.07), nv = std::max(a.nv, 1e-4), t = square(1 - r);
  constexpr double kSmooth[] = {25.3245, 3.32435, 0.16801, -1.27393, -4.85967};
  constexpr double kRough[] = {21.5473, 3.82987, 0.19823, -1.97760, -4.32054};
  double p[5];
  for (int i = 0; i < 5; ++i) p[i] = t * kSmooth[i] + (1 - t) * kRough[i];
  const auto fit = [&p](double x) { return p[0] / (1 + p[1] * std::pow(x, p[2])) + p[3] * x + p[4]; };
  const auto lambda = [&](double x) { return std::exp(x < 0.5 ? fit(x) : 2 * fit(0.5) - fit(1 - std::min(x, 1.0))); };
  const double d = (2 + 1 / r) * std::pow(std::sqrt(1 - std::min(square(a.nh), 1.0)), 1 / r) / (2 * pi);
  const double v = std::min(1 / ((1 + lambda(a.nl) + lambda(nv)) * 4 * a.nl * nv), 1.0);
  return c.albedo * ((1 - c.parameter) / pi + c.parameter * d * v) * arriving(c, a) * a.nl;
}

dvec3 lambert(const LitPixel& c) {
  const Angles a(c);
  return c.albedo / pi * arriving(c, a) * a.nl;
}

dvec3 wrapped(const LitPixel& c) {
  const Angles a(c);
  return c.albedo / pi * std::max(0.0, (a.nl + c.parameter) / (1 + c.parameter)) * arriving(c, a);
}

dvec3 toon(const LitPixel& c) {
  const Angles a(c);
  const double d = glm::length(dvec3(c.light.position) - c.position);
  const double w = c.light.type == LightType::directional ? 1 : square(clamped(1 - square(d / double(c.light.range))));
  const dvec3 color(c.light.color), paint = color / std::max({color.r, color.g, color.b, 1.0});
  return c.albedo * paint * std::ceil(c.parameter * a.nl * w * cone(c, a)) / c.parameter;
}

struct Row {
  const char* name;
  dvec3 (*formula)(const LitPixel&);  ///< of lights with a direction, where N.L > 0, or at all where it wraps
  const char* parameter = "";
  float value = 0;
};
const std::vector<Row>& rows() {
  static const std::vector<Row> all{{"area", gltf},
                                    {"area-lambert", lambert},
                                    {"blinn-phong-normalised", blinn_phong},
                                    {"charlie", charlie, "parameters.sheen", 0.75f},
                                    {"cook-torrance", cook_torrance},
                                    {"disney", disney},
                                    {"frostbite", frostbite},
                                    {"gltf", gltf},
                                    {"oren-nayar", oren_nayar},
                                    {"toon", toon, "parameters.steps", 3},
                                    {"ue4", ue4},
                                    {"ward", ward},
                                    {"wrapped", wrapped, "parameters.wrap", 0.375f}};
  return all;
}

dvec3 wanted(const Row& row, const LitPixel& c) {
  if (c.light.type == LightType::ambient)
    return dvec3(c.light.color) * c.albedo * (row.formula == gltf ? c.occlusion : 1.0);
  return Angles(c).nl > 0 || row.formula == wrapped ? row.formula(c) : dvec3(0);
}

constexpr double kOff = 4e-7;  ///< of unit vectors in f32: three roundings of 2^-24 and some

/// How far arithmetic in f32 may be from `value`: 1e-5 of it, and what the formula itself makes of directions that are
/// off by kOff. The second is for cosines and windows near 0, narrow lobes, and the edges of steps.
dvec3 allowed(const Row& row, const LitPixel& c, const dvec3& value) {
  dvec3 sum = 1e-5 * value;
  if (row.formula == blinn_phong) sum += c.shininess * kOff * value;  // a power of a cosine that is off by kOff
  const double to_light = glm::length(dvec3(c.light.position) - c.position), to_eye = glm::length(c.eye - c.position);
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0}) {
      const double off = sign * kOff;
      LitPixel near = c;
      near.normal[axis] += off * glm::length(c.normal);
      sum += glm::abs(wanted(row, near) - value);
      near = c;
      near.eye[axis] += off * to_eye;
      sum += glm::abs(wanted(row, near) - value);
      near = c;
      if (c.light.type == LightType::directional) {
        near.light.direction[axis] += float(off);
      } else {
        near.position[axis] += off * to_light, near.eye[axis] += off * to_light;
      }
      sum += glm::abs(wanted(row, near) - value);
    }
  return sum;
}

glm::vec3 triple_between(RandomWords& random, float low, float high) {
  const float x = float_between(random, low, high), y = float_between(random, low, high),
              z = float_between(random, low, high);
  return {x, y, z};
}

Light random_shipped_light(RandomWords& random) {
  Light l;
  l.type = LightType(random() % 4);
  l.position = triple_between(random, -3, 3), l.color = triple_between(random, 0, 4);
  l.direction = glm::vec3(glm::normalize(dvec3(triple_between(random, -1, 1)) + dvec3(1e-3)));
  if (random() % 4 != 0) l.range = float_between(random, 2, 12);
  l.cone_rad = float_between(random, 0.3f, 1.2f), l.penumbra_rad = float_between(random, 0.05f, 0.3f);
  return l;
}

LitPixel random_lit_pixel(RandomWords& random, const dvec3& eye) {
  LitPixel c{};
  c.position = triple_between(random, -3, 3), c.normal = triple_between(random, -1, 1), c.eye = eye;
  c.albedo = triple_between(random, 0, 1), c.specular = triple_between(random, 0, 1);
  c.metallic = float_between(random, 0, 1), c.roughness = float_between(random, 0, 1);
  c.shininess = 200 * square(float_between(random, 0, 1)), c.occlusion = float_between(random, 0, 1);
  return c;
}

Numbers numbers_of(const LitPixel& c) {
  Numbers out{{"surface.metallic", bits_of(float(c.metallic))},
              {"surface.roughness", bits_of(float(c.roughness))},
              {"surface.shininess", bits_of(float(c.shininess))},
              {"surface.occlusion", bits_of(float(c.occlusion))}};
  for (int i = 0; i < 3; ++i) {
    const std::string end = std::string(".") + "xyz"[i];
    out["surface.position" + end] = bits_of(float(c.position[i]));
    out["surface.normal" + end] = bits_of(float(c.normal[i]));
    out["surface.albedo" + end] = bits_of(float(c.albedo[i]));
    out["surface.specular" + end] = bits_of(float(c.specular[i]));
    out["surface.emission" + end] = bits_of(0.0f);
    out["view.eye" + end] = bits_of(float(c.eye[i]));
  }
  return out;
}

Numbers numbers_of(const Light& l) {
  Numbers out{{"light.type", uint32_t(l.type)},
              {"light.range", bits_of(l.range)},
              {"light.cone_scale", bits_of(LightCone(l).scale)},
              {"light.cone_offset", bits_of(LightCone(l).offset)}};
  for (int i = 0; i < 3; ++i) {
    const std::string end = std::string(".") + "xyz"[i];
    out["light.position" + end] = bits_of(l.position[i]);
    out["light.color" + end] = bits_of(l.color[i]);
    out["light.direction" + end] = bits_of(l.direction[i]);
    out["light.right" + end] = out["light.up" + end] = bits_of(0.0f);
  }
  return out;
}

Program program_of(const Row& row) {
  const LightProgram model = shipped_program(row.name);
  return program_from_glsl(model.file, model.text);
}

constexpr size_t kModelSurfaces = 8 * kBatchLanes, kModelLights = 4 * kBlockLanes;

/// Random surfaces, a view, and random lights; lane i of block k is under light (k * 5 + turn * 3) % kModelLights.
struct ModelSample {
  std::vector<LitPixel> surfaces;
  std::vector<Light> lights;

  explicit ModelSample(uint32_t seed) {
    RandomWords random(seed);
    for (size_t i = 0; i < kModelLights; ++i) lights.push_back(random_shipped_light(random));
    for (size_t i = 0; i < kModelSurfaces; ++i) surfaces.push_back(random_lit_pixel(random, {0.5, 1, 4}));
  }
  static size_t light_of(size_t surface, size_t turn) { return (surface / kBlockLanes * 5 + turn * 3) % kModelLights; }
  LitPixel at(size_t surface, size_t turn, const Row& row) const {
    LitPixel c = surfaces[surface];
    c.light = lights[light_of(surface, turn)], c.parameter = double(row.value);
    return c;
  }
};

/// Inputs of a rate, a plane each.
std::vector<std::vector<LaneBlock>> planes_of(const Executable& executable, Rate rate,
                                              const std::vector<Numbers>& given) {
  std::vector<std::vector<LaneBlock>> planes;
  for (const uint32_t input : executable.at(rate).inputs) {
    auto& plane = planes.emplace_back(given.size() / kBlockLanes);
    for (size_t i = 0; i < given.size(); ++i)
      plane[i / kBlockLanes].lane[i % kBlockLanes] = float_of(given[i].at(executable.program.inputs[input].name));
  }
  return planes;
}

/// What light() adds at every surface, for each turn of `turns`.
std::vector<glm::vec3> added(const Row& row, const ModelSample& sample, size_t turns) {
  const Executable executable = executable_of(program_of(row));
  Registers registers(executable);
  ConstantValues constants(executable);
  Numbers fixed = numbers_of(sample.surfaces[0]);
  fixed[row.parameter] = bits_of(row.value);
  const auto& inputs = executable.at(Rate::constant).inputs;
  for (size_t i = 0; i < inputs.size(); ++i)
    constants.set_input(i, fixed.at(executable.program.inputs[inputs[i]].name));
  std::vector<Numbers> surfaces, lights;
  for (const LitPixel& c : sample.surfaces) surfaces.push_back(numbers_of(c));
  for (const Light& l : sample.lights) lights.push_back(numbers_of(l));
  const auto surface_planes = planes_of(executable, Rate::surface, surfaces),
             light_planes = planes_of(executable, Rate::light, lights);
  LaneValues of_lights(executable.at(Rate::light), kModelLights),
      of_surfaces(executable.at(Rate::surface), kModelSurfaces);
  for (size_t i = 0; i < light_planes.size(); ++i) of_lights.set_input(i, light_planes[i][0].lane);
  for (size_t i = 0; i < surface_planes.size(); ++i) of_surfaces.set_input(i, surface_planes[i][0].lane);
  run_constants(executable, constants, registers);
  run_lights(executable, constants, of_lights, registers);
  run_surfaces(executable, constants, of_surfaces, nullptr, registers);
  std::vector<glm::vec3> out;
  for (size_t turn = 0; turn < turns; ++turn)
    for (size_t first = 0; first < kModelSurfaces; first += kBatchLanes) {
      PairBlock pairs[kBatchBlocks];
      for (size_t k = 0; k < kBatchBlocks; ++k) {
        const size_t surface = first + k * kBlockLanes;
        pairs[k] = {uint32_t(surface), uint32_t(ModelSample::light_of(surface, turn))};
      }
      const PairResults made = run_pairs(executable, constants, of_lights, of_surfaces, pairs, registers);
      for (size_t lane = 0; lane < kBatchLanes; ++lane)
        out.emplace_back(made.light[0][lane], made.light[1][lane], made.light[2][lane]);
    }
  return out;
}

}  // namespace

TEST_CASE("Every light model that ships adds what its source's formula gives in double, on every SIMD target") {
  constexpr size_t kTurns = 4;
  const ModelSample sample(4);
  REQUIRE(rows().size() == shipped_models().size());
  for (const Row& row : rows()) {
    INFO(row.name);
    std::vector<std::pair<dvec3, dvec3>> expected;  // values, and how far off they may be
    for (size_t turn = 0; turn < kTurns; ++turn)
      for (size_t i = 0; i < kModelSurfaces; ++i) {
        const LitPixel c = sample.at(i, turn, row);
        const dvec3 value = wanted(row, c);
        expected.emplace_back(value, allowed(row, c, value));
      }
    for (const std::string_view target : simd_targets()) {
      const SimdScope scope(target);
      const std::vector<glm::vec3> made = added(row, sample, kTurns);
      size_t lit = 0, tight = 0, worst = 0;
      double most = 0;  // of errors, by what is allowed
      for (size_t i = 0; i < 3 * made.size(); ++i) {
        const int k = int(i % 3);
        const double value = expected[i / 3].first[k], bound = expected[i / 3].second[k];
        const double error = std::abs(double(made[i / 3][k]) - value);
        lit += value > 0, tight += value > 0 && bound < 5e-5 * value;
        if (!(error <= most * bound)) worst = i, most = bound > 0 ? error / bound : 1e9;
      }
      const LitPixel c = sample.at(worst / 3 % kModelSurfaces, worst / 3 / kModelSurfaces, row);
      INFO("channel " << worst % 3 << " of a light of type " << int(c.light.type) << ", roughness " << c.roughness
                      << ", N.L " << Angles(c).nl << ", N.V " << Angles(c).nv << ": " << made[worst / 3][int(worst % 3)]
                      << ", not " << expected[worst / 3].first[int(worst % 3)] << "; target " << target);
      CHECK(most <= 1);
      CHECK(lit > made.size());  // of three channels a pair
      CHECK(2 * tight > lit);    // most are held to 5e-5
    }
  }
}

TEST_CASE("No light model that ships makes a NaN where a vector has no direction or a surface no roughness") {
  ModelSample sample(5);
  const float infinite = std::numeric_limits<float>::infinity();
  for (size_t i = 0; i < kModelSurfaces; ++i) {
    LitPixel& c = sample.surfaces[i];
    c.eye = {0.5, 1, 4};
    if (i % 2 == 1) c.position = sample.lights[ModelSample::light_of(i, 0)].position;
    if (i / 2 % 3 == 1) c.normal = dvec3(0);
    if (i / 2 % 3 == 2)
      c.normal = glm::normalize(dvec3(glm::vec3(sample.lights[ModelSample::light_of(i, 0)].position)) - c.position +
                                dvec3(1e-9));
    if (i / 6 % 4 == 1) c.position = c.eye;
    if (i / 6 % 4 == 2)
      c.position = 2.0 * c.eye - dvec3(sample.lights[ModelSample::light_of(i, 0)].position);  // between them
    if (i / 6 % 4 == 3) c.position = c.eye * (1.0 + 1e-6);
    c.roughness = i / 24 % 3 == 0 ? 0 : i / 24 % 3 == 1 ? 1 : c.roughness;
    c.metallic = double(i / 72 % 2), c.shininess = i / 24 % 3 == 0 ? 0 : 8192;
    if (i / 144 % 2 == 1) c.albedo = c.specular = dvec3(double(i / 288 % 2));
  }
  for (size_t i = 0; i < kModelLights; i += 3)
    sample.lights[i].range = infinite, sample.lights[i].color = glm::vec3(1e18f);
  for (size_t i = 1; i < kModelLights; i += 3) sample.lights[i].range = 1e-30f;
  for (const Row& row : rows()) {
    INFO(row.name);
    for (const std::string_view target : simd_targets()) {
      const SimdScope scope(target);
      size_t nans = 0;
      for (const glm::vec3& value : added(row, sample, 4))
        for (int k = 0; k < 3; ++k) nans += !(value[k] >= 0);
      CHECK(nans == 0);
    }
  }
}

TEST_CASE("glTF's sum starts from emission, and the text of a model that ships stands alone") {
  for (const Row& row : rows()) {
    const Program program = program_of(row);
    CHECK(program.defines_start == (row.formula == gltf));
    CHECK(!program.defines_finish);
  }
  const Numbers started = run_once(program_of(rows()[7]), {{"surface.emission.y", bits_of(0.25f)}});
  CHECK(started.at("start.y") == bits_of(0.25f));
  for (const ShippedModel& model : shipped_models()) CHECK(model.text.find("#include") == std::string_view::npos);
}

}  // namespace trueshade::programs
