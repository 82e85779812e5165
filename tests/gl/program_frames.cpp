#include "tests/gl/program_frames.h"

#include <cmath>
#include <fstream>
#include <iterator>

#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/shipped_models.h"
#include "shading/frame.h"
#include "tests/area_scenes.h"
#include "tests/catch.hpp"
#include "tests/shading/many_lights_text.h"

namespace trueshade::testing {
namespace {

using oracle::Capture;

struct Difference {
  size_t compared = 0, far = 0, lit = 0;
  int x = 0, y = 0;  ///< of the first that is far, and its values
  double gl[4]{}, ours[4]{};
  double worst = 0;  ///< of those that are not far, in parts of the bound
};

/// Where both show the same object. `bound`: of 1, and where `relative` of the value too.
Difference difference(const Capture& gl, const Frame& ours, double bound, bool relative) {
  Difference d;
  const Image& ids = ours.aovs.at(0).image;
  const Image* gl_ids = gl.plane("id.object");
  REQUIRE(gl_ids != nullptr);
  for (int y = 0; y < ids.height; ++y)
    for (int x = 0; x < ids.width; ++x) {
      if (ids.value(x, y, 0) != gl_ids->value(x, y, 0)) continue;
      double apart = 0, most = 0;
      for (int c = 0; c < 4; ++c) {
        const double a = gl.color.value(x, y, c), b = ours.color.value(x, y, c);
        const double allowed = bound * (relative ? std::max(1.0, std::fabs(b)) : 1.0);
        apart = std::max(apart, std::isnan(a) && std::isnan(b) ? 0.0 : std::fabs(a - b) / allowed);
        if (!(apart < 1e30)) apart = 1e30;
        most = std::max(most, c < 3 ? std::fabs(b) : 0.0);
      }
      ++d.compared, d.lit += most > 0.01;
      if (apart > 1 && d.far == 0)
        for (int c = 0; c < 4; ++c) {
          d.gl[c] = gl.color.value(x, y, c), d.ours[c] = ours.color.value(x, y, c);
          d.x = x, d.y = y;
        }
      if (apart > 1)
        ++d.far;
      else
        d.worst = std::max(d.worst, apart);
    }
  return d;
}

Pipeline by_program(const std::string& text, std::vector<ProgramParameter> parameters = {}) {
  Pipeline p;
  p.width = 160, p.height = 120;
  p.light_program = {"lights.glsl", text, {}, std::move(parameters)};
  p.light_volumes.point = p.light_volumes.spot = LightExtent::range;
  return p;
}

/// A code of 8 bits more or less of the albedo would be seen.
void in_floats(Pipeline& pipeline) { pipeline.target = pipeline.gbuffer.albedo.format = Format::rgba32f; }

void check(const ProgramDrawer& drawn, const Scene& scene, const Pipeline& pipeline, double bound, bool relative) {
  const std::string aovs[] = {"id.object"};
  const Difference d = difference(drawn(scene, pipeline), render_frame(scene, pipeline, {}, aovs), bound, relative);
  INFO(name_of(pipeline.strategy) << ": " << pipeline.light_program.text);
  CAPTURE(d.compared, d.far, d.lit, d.worst);
  INFO("at " << d.x << ", " << d.y << ": " << d.gl[0] << ' ' << d.gl[1] << ' ' << d.gl[2] << ' ' << d.gl[3] << ", ours "
             << d.ours[0] << ' ' << d.ours[1] << ' ' << d.ours[2] << ' ' << d.ours[3]);
  CHECK(d.compared > size_t(pipeline.width) * size_t(pipeline.height) * 4 / 5);
  CHECK(d.far * 2000 <= d.compared);
  CHECK(d.lit * 50 > d.compared);
}

constexpr Strategy kStrategies[] = {Strategy::deferred_loop, Strategy::forward_loop, Strategy::deferred_volumes,
                                    Strategy::forward_multipass};

void check_all(const ProgramDrawer& drawn, const Scene& scene, Pipeline pipeline, double bound, bool relative) {
  for (const Strategy strategy : kStrategies) {
    pipeline.strategy = strategy;
    check(drawn, scene, pipeline, bound, relative);
  }
}

/// Cornell's box under a spot, with materials that have something of everything; the last one is unlit.
Scene furnished() {
  Scene scene = builtin_scene("cornell,lights=3");
  float k = 0;
  for (Material& m : scene.materials) {
    k += 0.07f;
    m.metallic = 0.2f + k, m.roughness = 0.9f - k, m.shininess = 8.0f + 10 * k;
    m.specular_color = {0.1f + k, 0.2f, 0.3f + k}, m.emission = {k, 0.5f * k, 0.25f};
  }
  Light& spot = scene.lights.back();
  spot.type = LightType::spot;
  spot.cone_rad = 0.5f, spot.penumbra_rad = 0.25f, spot.spot_exponent = 3;
  spot.direction = {0.6f, -0.8f, 0.0f};
  for (Light& light : scene.lights) light.attenuation = {1.0f, 0.5f, 0.25f}, light.ambient = {0.1f, 0.2f, 0.3f};
  return scene;
}

struct Kind {
  const char* text;
  std::vector<ProgramParameter> parameters;
};

const Kind kKinds[] = {
    {R"glsl(
#define N normalize(s.normal)
#define P gain
uniform Parameters { int count; vec3 tint; float gain; } settings;
vec3 start(Surface s, View v) { return s.emission * s.occlusion; }
vec4 finish(Surface s, View v, vec3 sum) { return vec4(sum * settings.P + settings.tint, 0.5 + 0.25 * sum.r); }
bool reaches(Surface s, Light l, View v) { return l.index != 1u; }
vec3 light(Surface s, Light l, View v) {
  float c = max(dot(N, normalize(l.position - s.position)), 0.0), cone = 1.0;
  c *= 0.45 * float(settings.count);
  if (l.type == light_type_spot)
    cone = clamp(dot(normalize(s.position - l.position), l.direction) * l.cone_scale + l.cone_offset, 0.0, 1.0);
  return s.albedo.rgb * l.color * (c * cone * 0.25);
}
)glsl",
     {{"count", {2}}, {"tint", {0.1f, 0.2f, 0.3f}}, {"gain", {0.5f}}}},
    {R"glsl(
struct Tally { vec2 seen[2]; bool odd; };
int calls;                      // never started: 0
float share = 0.25, others[2] = float[2](0.5, 0.125);
Tally tally;
float rough;
vec3 light(inout Surface s, Light l, View v) {
  ++calls;
  share *= 2.0;
  tally.seen[1].y += 1.0;
  tally.odd = !tally.odd;
  rough = s.roughness;
  vec3 added = s.albedo.rgb * l.color * (share * float(calls) * tally.seen[1].y * others[0] * 0.01);
  s.albedo = vec4(0.0);
  return tally.odd ? added : vec3(7.0);
}
bool reaches(Surface s, Light l, View v) { share = s.albedo.r; return true; }
vec3 start(Surface s, View v) { ++calls; return vec3(rough * 0.5, share * 0.5, float(calls)); }
vec4 finish(Surface s, View v, vec3 sum) { return vec4(sum, rough + float(calls)); }
)glsl",
     {}},
    {R"glsl(
layout(row_major) uniform Parameters { mat3 unread; vec2 a; float b[2]; vec4 c; };
vec3 light(Surface s, Light l, View v) {
  float q = dot(normalize(s.normal), normalize(l.position - s.position));
  return (a.x + a.y * c.w) * max(q, 0.0) * s.specular * (s.shininess / 64.0) * l.color;
}
)glsl",
     {{"a", {0.5f, 0.25f}}, {"c", {9, 9, 9, 0.5f}}}},
};

/// Of lights and surfaces of every type.
constexpr const char* kRoom = R"glsl(
vec3 light(Surface s, Light l, View v) {
  vec3 d = l.position - s.position, to = normalize(d);
  if (l.type == light_type_ambient) return s.albedo.rgb * l.color * s.occlusion;
  float c = max(dot(normalize(s.normal), to), 0.0), cone = 1.0;
  if (l.type == light_type_spot) cone = smoothstep(l.cos_outer, l.cos_inner, dot(-to, l.direction));
  vec3 reflected = s.albedo.rgb * (1.0 - s.metallic) + 0.2 * s.roughness;
  return reflected * l.color * (c * cone / dot(l.attenuation, vec3(1.0, length(d), dot(d, d))));
}
vec3 start(Surface s, View v) { return 0.1 * s.emission; }
)glsl";

/// A room whose materials have maps of every kind.
Scene papered() {
  Scene scene = builtin_scene("lecture,lights=6");
  for (Material& m : scene.materials) {
    m.metallic_roughness_map.texture = m.emission_map.texture = m.occlusion_map.texture = 0;
    m.metallic = m.roughness = 0.9f, m.emission = glm::vec3(0.5f);
  }
  return scene;
}

/// What the fields say, each of a scale near 1.
const char* const kFields[] = {
    "s.position * 0.01",  // a driver's grid of edges moves what slopes
    "s.normal",
    "s.albedo.rgb",
    "vec3(s.albedo.a, s.occlusion, 1.0)",
    "s.specular",
    "vec3(s.shininess * 0.1, 1.0, 1.0)",
    "vec3(s.metallic, s.roughness, 1.0)",
    "s.emission",
    "vec3(s.uv, 1.0)",
    "vec3(float(s.object), float(s.material), 1.0)",
    "vec3(float(s.pixel_x), float(s.pixel_y), 1.0) * 0.01",
    "vec3(float(l.type), float(l.index), 1.0)",
    "l.position * 0.1",
    "vec3(l.range, 1.0, 1.0)",
    "l.direction + vec3(0.0, 0.0, 0.5)",
    "l.color",
    "l.attenuation",
    "l.ambient",
    "vec3(l.cone, l.penumbra, 1.0)",
    "vec3(l.cos_inner, l.cos_outer, l.spot_exponent + 1.0)",
    "vec3(l.cone_scale, l.cone_offset, 1.0)",
    "vec3(l.penumbra_slope, l.cutoff_slope, 1.0)",
    "l.right * 10.0 + l.up * 2.0 + vec3(float(l.shadow), float(l.cookie), 1.0)",
    "v.eye",
    "v.axis",
    "vec3(v.size * 0.01, 1.0)",
    "vec3(v.time * 0.1, float(v.frame & 65535u) * 0.001, float(v.frame >> 16))",
    "(v.view * vec4(1.0, 2.0, 3.0, 1.0)).xyz * 0.1",
    "(v.projection * vec4(1.0, 2.0, -3.0, 1.0)).xyw * 0.1",
    "(v.view_projection * vec4(1.0, 2.0, 3.0, 1.0)).xyw",
    "vec3(v.view_projection[0].x, v.view_projection[1].y, v.view_projection[2].w)",
};

}  // namespace

void check_many_lights(const ProgramDrawer& drawn) {
  for (const char* name : {"city,objects=300,lights=60", "cornell", "atrium,lights=32"}) {
    INFO(name);
    const Scene scene = builtin_scene(name);
    for (const Strategy strategy : kStrategies) {
      Pipeline pipeline = by_program(kManyLights);
      pipeline.strategy = strategy;
      // Codes of sums are one apart. Of lights each may be: values that are less than two codes apart are as near.
      if (blends_lights(strategy)) in_floats(pipeline);
      check(drawn, scene, pipeline, (blends_lights(strategy) ? 2.0 : 1.001) / 255, false);
    }
  }
}

void check_program_kinds(const ProgramDrawer& drawn) {
  Pipeline room = by_program(kRoom);
  in_floats(room);
  check_all(drawn, papered(), room, 0.005, true);  // what lookups in maps may differ by
  Scene scene = furnished();
  std::vector<Kind> kinds(std::begin(kKinds), std::end(kKinds));
  const std::string ggx = documented_ggx();
  kinds.push_back({ggx.c_str(), {{"gain", {8}}}});
  for (const Kind& kind : kinds) {
    Pipeline pipeline = by_program(kind.text, kind.parameters);
    in_floats(pipeline);
    check_all(drawn, scene, pipeline, 0.0005, true);
  }
  scene.materials.back().unlit = true;  // shows its albedo
  scene.materials.front().transparent = true, scene.materials.front().base_color.a = 0.5f;
  Pipeline glass = by_program(ggx, {{"gain", {8}}});
  in_floats(glass);
  glass.transparency.mode = TransparencyMode::after_lights;
  check_all(drawn, scene, glass, 0.0005, true);
  glass.transparency.mode = TransparencyMode::into_albedo;
  check(drawn, scene, glass, 0.0005, true);
  scene.materials.front().transparent = false;
  Pipeline thin = glass;  // positions by the depth, normals as halves of codes, no w that tells what is covered
  thin.gbuffer.position_from_depth = true;
  thin.gbuffer.normal.format = Format::rgb10_a2;
  check(drawn, scene, thin, 0.005, true);
}

void check_area_lights(const ProgramDrawer& drawn) {
  for (const std::string_view name : {"box", "mixed"})
    for (const char* const model : {"area", "area-lambert"}) {
      INFO(name << ", " << model);
      Pipeline pipeline = by_program(shipped_program(model).text);
      in_floats(pipeline);
      pipeline.light_volumes.point = LightExtent::sphere, pipeline.light_volumes.spot = LightExtent::cone;
      check_all(drawn, area_scene(name), pipeline, 0.002, true);
    }
}

void check_program_fields(const ProgramDrawer& drawn) {
  Scene scene = furnished();
  scene.timeline.fps = 20000.0;  // a frame's number that is more than 16 bits
  set_time(scene, 7.25);
  for (const char* field : kFields) {
    Pipeline pipeline = by_program(std::string("vec3 light(Surface s, Light l, View v) { return ") + field + "; }\n");
    pipeline.light_volumes.point = pipeline.light_volumes.spot = LightExtent::unbounded;
    pipeline.width = 64, pipeline.height = 48;
    in_floats(pipeline);
    const bool has_areas = std::string_view(field).starts_with("l.right");
    check_all(drawn, has_areas ? area_scene("box") : scene, pipeline, 1e-4, true);
  }
}

std::string documented_ggx() {
  std::ifstream file(std::string(TRUESHADE_SOURCE_DIR) + "/docs/light_programs.md");
  const std::string page(std::istreambuf_iterator<char>(file), {});
  const size_t first = page.find("```glsl\n") + 8;
  return page.substr(first, page.find("```", first) - first);
}

}  // namespace trueshade::testing
