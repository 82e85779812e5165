// What a finding says can be checked: its proof is a pixel that it explains, its share is what its command prints.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/half.h"
#include "judge/diagnosis/finding.h"
#include "judge/stages/validate.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "tests/catch.hpp"
#include "tests/judge/captured.h"
#include "tests/judge/diagnosis/planted.h"
#include "tests/judge/diagnosis/wrong_lights.h"

namespace trueshade::testing {

using namespace trueshade::oracle;

namespace {

constexpr const char* kScenes[] = {"city,lights=60,objects=300", "circle,lights=24"};

Pipeline small_pipeline() {
  Pipeline p = *preset_pipeline("many-lights");
  p.width = 128, p.height = 96, p.strategy = Strategy::deferred_loop, p.target = Format::rgba8;
  return p;
}

std::vector<Finding> found(const Scene& scene, const Capture& capture, const std::vector<std::string>& supposed = {}) {
  const Pipeline pipeline = small_pipeline();
  Profile profile;
  profile.subpixel_bits = 8;
  const Verdict verdict = validate_capture(scene, pipeline, capture, {profile, false, {}, {}});
  return diagnose(scene, pipeline, profile, capture, verdict.stages, supposed);
}

/// A number that looks like chance and is always the same.
uint32_t chance(int x, int y, int k = 0) {
  uint32_t v = uint32_t(x) * 0x9e3779b1u ^ uint32_t(y) * 0x85ebca77u ^ uint32_t(k) * 0xc2b2ae3du;
  v ^= v >> 15, v *= 0x2c1b3c6du, v ^= v >> 12, v *= 0x297a2d39u;
  return v ^ v >> 15;
}

template <class Change>
void each_code(Image& image, const Change& change) {
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int k = 0; k < 3; ++k)
        image.set_code(x, y, k, uint32_t(std::clamp(change(int(image.code(x, y, k)), x, y, k), 0, 255)));
}

std::string names_of(const std::vector<Finding>& findings) {
  std::string names;
  for (const Finding& f : findings) names += f.name + ' ';
  return names;
}

bool is_named(const std::vector<Finding>& findings, std::string_view part) {
  return names_of(findings).find(part) != std::string::npos;
}

/// Every proof is of a pixel that is wrong, and that the fault explains.
void check_proofs(const std::vector<Finding>& findings) {
  for (const Finding& f : findings) {
    CAPTURE(f.name, f.proof.x, f.proof.y, f.proof.plane, f.proof.given, f.proof.right, f.proof.predicted);
    CHECK_FALSE(f.proof.plane.empty());
    CHECK(f.proof.given != f.proof.right);
    CHECK(f.proof.predicted != f.proof.right);
    CHECK(std::fabs(f.proof.given - f.proof.predicted) < std::fabs(f.proof.given - f.proof.right));
    if (f.plane == "picture") CHECK(f.proof.given == f.proof.predicted);
  }
}

/// As two octahedral codes of 8 bits give them back.
glm::vec3 through_two_codes(glm::vec3 n) {
  const auto packed = [](float v) { return std::nearbyint((v * 0.5f + 0.5f) * 255) / 255 * 2 - 1; };
  const auto sign = [](float v) { return v < 0 ? -1.0f : 1.0f; };
  n /= std::fabs(n.x) + std::fabs(n.y) + std::fabs(n.z);
  glm::vec2 e(n.x, n.y);
  if (n.z < 0) e = {(1 - std::fabs(n.y)) * sign(n.x), (1 - std::fabs(n.x)) * sign(n.y)};
  e = {packed(e.x), packed(e.y)};
  glm::vec3 r(e.x, e.y, 1 - std::fabs(e.x) - std::fabs(e.y));
  const float folded = std::max(-r.z, 0.0f);
  r.x -= sign(r.x) * folded, r.y -= sign(r.y) * folded;
  return r / std::sqrt(r.x * r.x + r.y * r.y + r.z * r.z);
}

void pack_normals(Image& image) {
  const bool halves = image.format == Format::rgba16f;
  REQUIRE((halves || image.format == Format::rgba32f));
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      glm::vec3 n;
      for (int k = 0; k < 3; ++k) n[k] = float(image.value(x, y, k));
      if (n == glm::vec3(0.0f)) continue;
      n = through_two_codes(n);
      for (int k = 0; k < 3; ++k)
        image.set_code(x, y, k, halves ? half_from_float(n[k], HalfRound::nearest) : std::bit_cast<uint32_t>(n[k]));
    }
}

Capture right_capture(const Scene& scene) { return captured(scene, small_pipeline()); }

}  // namespace

TEST_CASE("An exposure a little off is named by its number, not as dithering") {
  for (const char* spec : kScenes)
    for (const float factor : {1.001f, 1.003f}) {
      const Scene scene = builtin_scene(spec);
      Scene bright = scene;
      for (Light& l : bright.lights) l.color *= factor;
      const std::vector<Finding> findings = found(scene, right_capture(bright));
      CAPTURE(spec, factor, names_of(findings));
      CHECK_FALSE(is_named(findings, "picture-dithered"));
      REQUIRE_FALSE(findings.empty());
      const std::string& first = findings[0].name;
      CHECK((first.starts_with("picture-exposure=1.00") || first.starts_with("light-intensity=1.00")));
      CHECK(findings[0].explained > 0.9);
      check_proofs(findings);
    }
}

/// The numbers of a finding of one light: `light-moved=3:0.3,0,0`.
std::array<double, 3> vector_of(const Finding& finding) {
  std::array<double, 3> v{};
  const size_t at = finding.name.find(':');
  if (at != std::string::npos) std::sscanf(finding.name.c_str() + at, ":%lf,%lf,%lf", &v[0], &v[1], &v[2]);
  return v;
}

/// The light is named first, and its three numbers.
void check_light(const std::vector<Finding>& findings, const std::string& name, const std::array<double, 3>& vector,
                 double margin) {
  CAPTURE(name, names_of(findings));
  REQUIRE_FALSE(findings.empty());
  CHECK(findings[0].name.starts_with(name + ":"));
  const std::array<double, 3> v = vector_of(findings[0]);
  for (size_t k = 0; k < 3; ++k) CHECK(v[k] == Approx(vector[k]).margin(margin));
  CHECK(findings[0].explained > 0.8);
}

TEST_CASE("One light moved a little is named with its way, and is neither dithering nor stale tiles") {
  for (const char* spec : kScenes) {
    const Scene scene = builtin_scene(spec);
    for (const size_t light : {size_t(3), size_t(11)}) {
      Scene moved = scene;
      moved.lights[light].position += glm::vec3(0.3f, 0, 0);
      const std::vector<Finding> findings = found(scene, right_capture(moved));
      CAPTURE(spec, light, names_of(findings));
      // Of 73 pixels that are a code off each, three numbers cannot be told.
      const bool too_little = std::string_view(spec).starts_with("city") && light == 11;
      if (!too_little) check_light(findings, "light-moved=" + std::to_string(light), {0.3, 0, 0}, 0.05);
      CHECK_FALSE(is_named(findings, "picture-dithered"));
      CHECK_FALSE(is_named(findings, "tile-stale"));
      CHECK_FALSE(is_named(findings, "picture-gamma"));
      check_proofs(findings);
    }
  }
}

TEST_CASE("One light that is turned, or has another colour, is named with its numbers") {
  const char* spec = kScenes[1];
  Scene scene = builtin_scene(spec);
  scene.lights[2].type = LightType::directional, scene.lights[2].direction = {0.6f, -0.8f, 0.0f};
  scene.lights[2].color = glm::vec3(0.3f);
  Scene turned = scene, tinted = scene;
  turned.lights[2].direction = {0.6f, -0.64f, 0.48f};
  tinted.lights[5].color *= glm::vec3(1.5f, 1.0f, 0.5f);
  CAPTURE(spec);
  const std::vector<Finding> of_turned = found(scene, right_capture(turned));
  REQUIRE_FALSE(of_turned.empty());
  // A direction has a length to spare: what counts is where the sum points.
  const std::array<double, 3> v = vector_of(of_turned[0]);
  const double length = std::sqrt((0.6 + v[0]) * (0.6 + v[0]) + (v[1] - 0.8) * (v[1] - 0.8) + v[2] * v[2]);
  CAPTURE(names_of(of_turned));
  CHECK(of_turned[0].name.starts_with("light-turned=2:"));
  CHECK((0.6 + v[0]) / length == Approx(0.6).margin(0.01));
  CHECK((v[1] - 0.8) / length == Approx(-0.64).margin(0.01));
  CHECK(v[2] / length == Approx(0.48).margin(0.01));
  check_light(found(scene, right_capture(tinted)), "light-colored=5", {1.5, 1, 0.5}, 0.05);
  const std::vector<Finding> again = found(scene, right_capture(tinted), {"light-colored=5:1.5,1,0.5"});
  REQUIRE(again.size() == 1);
  CHECK(again[0].explained > 0.98);
  check_proofs(again);
}

TEST_CASE("Normals in view space are found where the camera is a matrix") {
  const Scene by_eye = builtin_scene(kScenes[0]);
  const Pipeline pipeline = small_pipeline();
  const Matrix4 matrix = clip_from_world(by_eye.camera, double(pipeline.width) / pipeline.height);
  Scene scene = by_eye;
  scene.camera.clip_from_world.emplace();
  for (size_t i = 0; i < 16; ++i) (*scene.camera.clip_from_world)[i] = float(matrix[i]);
  scene.camera.target = scene.camera.eye + glm::vec3(1, 0, 0), scene.camera.up = {0, 0, 1};  // the matrix counts
  const Capture right = right_capture(scene);
  Capture lit = right;
  lit.color = slipped_picture(by_eye, pipeline, right, LightSlip::normals_in_view);
  const std::vector<Finding> of_light = found(scene, lit);
  CAPTURE(names_of(of_light));
  REQUIRE_FALSE(of_light.empty());
  CHECK(of_light[0].name == "lighting-normal-in-view");
  CHECK(of_light[0].explained > 0.98);
  for (const char* name : {"normals in view space in the G-buffer", "positions in view space"})
    for (const Plant& plant : plants()) {
      if (plant.name != name) continue;
      Capture stored = right;
      plant.output(by_eye, pipeline, stored, 0);
      const std::vector<Finding> of_plane = found(scene, stored);
      CAPTURE(name, names_of(of_plane));
      REQUIRE_FALSE(of_plane.empty());
      CHECK(of_plane[0].name == plant.names[0]);
      CHECK(of_plane[0].explained > 0.9);  // a matrix of floats has its eye where floats have it
    }
}

TEST_CASE("Where no fault fits nothing is named") {
  for (const char* spec : kScenes) {
    const Scene scene = builtin_scene(spec);
    const Capture right = right_capture(scene);
    Capture few = right, noise = right;
    each_code(few.color, [](int code, int x, int y, int) { return code + (chance(x, y) % 50 == 0 ? 1 : 0); });
    each_code(noise.color, [](int code, int x, int y, int k) { return code + int(chance(x, y, k) % 41) - 20; });
    CAPTURE(spec);
    CHECK(names_of(found(scene, few)).empty());
    CHECK(names_of(found(scene, noise)).empty());
  }
}

TEST_CASE("A picture that was lit before its normals were packed into 8 bits is not dithered") {
  for (const char* spec : kScenes) {
    const Scene scene = builtin_scene(spec);
    Capture capture = right_capture(scene);
    for (NamedImage& plane : capture.planes)
      if (plane.name == "normal") pack_normals(plane.image);
    capture.decoded.push_back({"normal", true, {1e-6f}, {0.02f}});
    const std::vector<Finding> findings = found(scene, capture);
    CAPTURE(spec, names_of(findings));
    CHECK_FALSE(is_named(findings, "picture-dithered"));
    CHECK_FALSE(is_named(findings, "picture-gamma"));
    check_proofs(findings);
  }
}

TEST_CASE("Dithered pictures and stale tiles are named, with a pixel that shows it") {
  for (const char* name : {"dithering", "a stale tile"})
    for (const Plant& plant : plants()) {
      if (plant.name != name) continue;
      int tries = 0, first = 0;
      for (const Ground& ground : grounds("many-lights", 1)) {
        if (ground.target != Format::rgba8 || blends_lights(ground.strategy)) continue;
        const PlantedTry t = planted_try(ground, plant, 0);
        if (t.changed < 100) continue;
        ++tries, first += t.first ? 1 : 0;
        UNSCOPED_INFO(ground.scene << ": " << t.found);
      }
      CAPTURE(name);
      CHECK(tries >= 1);
      CHECK(first == tries);
    }
}

TEST_CASE("Dithering is named where a first look at few pixels does not show that it is random") {
  for (const Plant& plant : plants()) {
    if (plant.name != "dithering") continue;
    const PlantedTry t =
        planted_try({"circle,lights=24", "many-lights", Strategy::deferred_loop, Format::rgba8, 1}, plant, 0);
    CAPTURE(t.found);
    CHECK(t.changed > 4000);
    CHECK(t.first);
  }
}

TEST_CASE("sRGB twice too often is named") {
  for (const Plant& plant : plants()) {
    if (plant.name != "sRGB twice too often") continue;
    for (const Ground& ground : grounds("many-lights", 1)) {
      const PlantedTry t = planted_try(ground, plant, 0);
      CAPTURE(ground.scene, info(ground.target).name, t.found);
      CHECK(t.first);
    }
  }
}

TEST_CASE("Of two faults each prints its own share and proof, and supposing it again prints the same") {
  const Scene scene = builtin_scene(kScenes[0]);
  for (const auto& [one, other] : {std::pair("picture upside down", "exposure"),
                                   std::pair("positions in view space", "normals in view space in the G-buffer")}) {
    Capture capture = right_capture(scene);
    int planted = 0;
    for (const Plant& plant : plants())
      if (plant.name == one || plant.name == other) {
        plant.output(scene, small_pipeline(), capture, 1);
        ++planted;
      }
    REQUIRE(planted == 2);
    const std::vector<Finding> both = found(scene, capture);
    CAPTURE(one, other, names_of(both));
    REQUIRE(both.size() >= 2);
    REQUIRE(both[1].together);
    CHECK(both[0].alone == both[0].explained);
    CHECK(both[1].explained > 0.9);
    CHECK(both[1].explained >= both[1].alone);
    CHECK(both[1].proof.by_both);
    check_proofs({both[0], both[1]});
    const std::vector<Finding> alone = found(scene, capture, {both[0].name});
    REQUIRE(alone.size() == 1);
    CHECK(alone[0].explained == both[0].explained);
    CHECK(alone[0].changed == both[0].changed);
    CHECK((both[0].proof.by_both || (alone[0].proof.x == both[0].proof.x && alone[0].proof.y == both[0].proof.y)));
    const std::vector<Finding> again = found(scene, capture, {both[0].name, both[1].name});
    REQUIRE(again.size() == 2);
    for (size_t i = 0; i < 2; ++i) {
      CHECK(again[i].explained == both[i].explained);
      CHECK(again[i].proof.x == both[i].proof.x);
      CHECK(again[i].proof.predicted == both[i].proof.predicted);
    }
  }
}

}  // namespace trueshade::testing
