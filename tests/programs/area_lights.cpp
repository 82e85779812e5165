// Lights with an area: the models that ship have their form factors, and what GGX's representative point is off by,
// against integrals over the lights in double.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

#include "core/simd/simd_target.h"
#include "programs/front/light_program.h"
#include "scenes/light.h"
#include "scenes/pipeline/shipped_models.h"
#include "scenes/timeline.h"
#include "tests/catch.hpp"
#include "tests/programs/area_oracle.h"
#include "tests/programs/random_words.h"
#include "tests/programs/run_program.h"

namespace trueshade::programs {
namespace {

using glm::dvec3;
using std::numbers::pi;

constexpr LightType kAreas[] = {LightType::sphere, LightType::tube, LightType::rectangle, LightType::disk};

double double_between(RandomWords& random, double low, double high) {
  return low + (high - low) * (double(random()) * 0x1p-32);
}
dvec3 random_triple(RandomWords& random) {
  const double x = double_between(random, -1, 1), y = double_between(random, -1, 1), z = double_between(random, -1, 1);
  return {x, y, z};
}
dvec3 direction(RandomWords& random) { return glm::normalize(random_triple(random) + dvec3(1e-3, 0, 0)); }

/// A light about the origin, of sizes over a factor of 20; tubes are thin.
Light random_area_light(LightType type, RandomWords& random) {
  Light l;
  l.type = type;
  const dvec3 right = direction(random), up = glm::normalize(glm::cross(right, direction(random)));
  const double width = std::exp(double_between(random, -1.5, 1.5)),
               height = std::exp(double_between(random, -1.5, 1.5));
  if (type == LightType::sphere) l.right.x = float(width);
  if (type == LightType::tube) l.right = glm::vec3(right * width), l.up.x = float(0.01 * width);
  if (type == LightType::rectangle) l.right = glm::vec3(right * width), l.up = glm::vec3(up * height);
  if (type == LightType::disk) l.right = glm::vec3(right * width), l.up = glm::vec3(up * width);
  if (type != LightType::sphere) aim(l);
  return l;
}

AreaShape shape_of(const Light& l) {
  AreaShape shape;
  shape.kind = AreaShape::Kind(size_t(l.type) - size_t(LightType::sphere));
  shape.centre = dvec3(l.position), shape.right = dvec3(l.right), shape.up = dvec3(l.up);
  shape.radius = double(l.type == LightType::tube ? l.up.x : l.right.x);
  return shape;
}

struct Surface {
  dvec3 position, normal, eye{0.0};
  double metallic = 0, roughness = 1;
};

/// Half of the surfaces look at the light, of half of which the horizon cuts it.
Surface random_surface(const Light& l, RandomWords& random) {
  Surface s;
  s.position = dvec3(glm::vec3(random_triple(random) * std::exp(double_between(random, -1.0, 2.0))));
  const bool looks = random() % 2 == 0;
  s.normal = looks ? glm::normalize(dvec3(l.position) - s.position + random_triple(random) * glm::length(s.position))
                   : direction(random);
  s.eye = s.position + 3.0 * glm::normalize(s.normal + 0.7 * random_triple(random));
  return s;
}

void put(Numbers& out, const std::string& name, const dvec3& v) {
  for (int c = 0; c < 3; ++c) out[name + "." + "xyz"[c]] = bits_of(float(v[c]));
}

/// White light on a white surface.
Numbers numbers_of(const Light& l, const Surface& s) {
  Numbers out{{"light.type", uint32_t(l.type)},
              {"light.range", bits_of(l.range)},
              {"surface.metallic", bits_of(float(s.metallic))},
              {"surface.roughness", bits_of(float(s.roughness))},
              {"surface.occlusion", bits_of(1.0f)}};
  put(out, "light.position", dvec3(l.position)), put(out, "light.direction", dvec3(l.direction));
  put(out, "light.right", dvec3(l.right)), put(out, "light.up", dvec3(l.up)), put(out, "light.color", dvec3(l.color));
  put(out, "surface.position", s.position), put(out, "surface.normal", s.normal), put(out, "view.eye", s.eye);
  put(out, "surface.albedo", dvec3(1));
  return out;
}

Program program_of_model(std::string_view name) {
  const LightProgram given = shipped_program(name);
  return program_from_glsl(given.file, given.text);
}

double red(const Program& program, const Light& l, const Surface& s) {
  return double(float_of(run_once(program, numbers_of(l, s)).at("light.x")));
}

/// How far the thin tube's line may be from the cylinder, of which the radius is a part of the distance to its axis.
double tube_error(const Light& l, const Surface& s) {
  const dvec3 axis = glm::normalize(dvec3(l.right)), to = s.position - dvec3(l.position);
  const double radius = double(l.up.x), off = glm::length(glm::cross(axis, to));
  return off < 20 * radius ? 1.0 : 1e-3;
}

}  // namespace

TEST_CASE("Lambert under lights with an area is what integrals over them in double give, to 1e-5") {
  const Program program = program_of_model("area-lambert");
  for (const LightType type : kAreas) {
    RandomWords random(uint32_t(type) + 31);
    size_t lit = 0, cut = 0;
    double worst = 0;  // in parts of what is allowed
    for (int i = 0; i < 400; ++i) {
      const Light light = random_area_light(type, random);
      const Surface s = random_surface(light, random);
      const double wanted = form_factor(shape_of(light), s.position, s.normal), made = red(program, light, s);
      const double allowed = type == LightType::tube ? tube_error(light, s) : 1e-5;
      worst = std::max(worst, std::fabs(made - wanted) / allowed);
      lit += wanted > 1e-3;
      const double height = glm::dot(s.normal, dvec3(light.position) - s.position);
      cut += wanted > 1e-4 && height < double(std::max(light.right.x, glm::length(light.right)));
    }
    INFO(name_of(type));
    CAPTURE(lit, cut, worst);
    CHECK(worst <= 1);
    CHECK(lit > 60);
    CHECK(cut > 15);
  }
}

/// Half of the eyes see the light mirrored, or nearly.
Surface glossy_surface(const Light& l, bool mirrored, RandomWords& random) {
  Surface s = random_surface(l, random);
  s.normal = glm::normalize(-s.position + 0.6 * random_triple(random) * glm::length(s.position));
  const dvec3 to = glm::normalize(-s.position + 0.5 * random_triple(random));
  const dvec3 mirror = 2.0 * glm::dot(s.normal, to) * s.normal - to;
  s.eye = s.position + 3.0 * (mirrored ? mirror : glm::normalize(s.normal + 0.7 * random_triple(random)));
  s.metallic = 1;
  return s;
}

TEST_CASE("GGX by a representative point is as far from the integral over the light as docs/light_programs.md says") {
  const Program program = program_of_model("area");
  for (const auto& [type, most] : {std::pair(LightType::sphere, 0.3),
                                   {LightType::tube, 0.7},
                                   {LightType::rectangle, 0.45},
                                   {LightType::disk, 0.45}})
    for (const double roughness : {0.2, 0.5, 1.0}) {
      RandomWords random(uint32_t(type) + 57);
      double off = 0, all = 0, worst = 0;
      for (int i = 0; i < 250; ++i) {
        Light light = random_area_light(type, random);
        if (type == LightType::tube) light.up.x = 0.05f * glm::length(light.right);
        Surface s = glossy_surface(light, i % 2 == 0, random);
        s.roughness = roughness;
        const double white[] = {1, 1, 1};
        const double wanted = reflected(shape_of(light), s.position, s.normal, s.eye, white, 1, roughness).mirror[0];
        const double made = red(program, light, s);
        off += (made - wanted) * (made - wanted), all += wanted * wanted, worst = std::max(worst, wanted);
      }
      INFO(name_of(type) << ", roughness " << roughness << ": root mean square " << std::sqrt(off / all));
      CHECK(worst > 0.1);
      CHECK(std::sqrt(off / all) < most);
    }
}

TEST_CASE("A light whose area is small is the point light of the same intensity") {
  const Program area = program_of_model("area"), gltf = program_of_model("gltf");
  RandomWords random(91);
  for (int i = 0; i < 60; ++i) {
    Light ball;
    ball.type = LightType::sphere, ball.right.x = 0.002f;
    Surface s = random_surface(ball, random);
    s.position *= 2.0 / glm::length(s.position), s.metallic = 0.3, s.roughness = 0.6;
    s.normal = glm::normalize(glm::normalize(-s.position) + 0.5 * random_triple(random));
    Light point;
    point.color = glm::vec3(float(pi * 0.002 * 0.002));
    const double wanted = red(gltf, point, s), made = red(area, ball, s);
    CHECK(std::fabs(made - wanted) <= 2e-3 * wanted + 1e-12);
  }
}

TEST_CASE("Lights with an area make no NaN and nothing negative at their centres, planes and edges") {
  for (const char* const name : {"area", "area-lambert"}) {
    const Program program = program_of_model(name);
    for (const LightType type : kAreas) {
      RandomWords random(uint32_t(type) + 77);
      for (int i = 0; i < 60; ++i) {
        const Light light = random_area_light(type, random);
        Surface s = random_surface(light, random);
        const double x = double(int(random() % 3)) - 1, y = double(int(random() % 3)) - 1;
        if (i % 4 != 0) s.position = dvec3(glm::vec3(dvec3(light.right) * x + dvec3(light.up) * y));
        if (i % 4 == 2) s.position -= dvec3(light.direction) * 1e-6;
        if (i % 5 == 1) s.normal = dvec3(0);
        if (i % 5 == 2) s.normal = -dvec3(light.direction);
        if (i % 3 == 1) s.eye = s.position;
        s.roughness = i % 2, s.metallic = i % 7 == 0;
        const double made = red(program, light, s);
        INFO(name << ", " << name_of(type) << ", case " << i << ": " << made);
        CHECK((made >= 0 && made < 1e9));
      }
    }
  }
}

}  // namespace trueshade::programs
