// Double-sided materials, mirrored instances and maps at several sets of texture coordinates: our own frames and
// llvmpipe's are explained, wrong ones are not.
#include "gl/driver/renderer.h"
#include "judge/stages/validate.h"
#include "scenes/builtin/texture_pattern.h"
#include "scenes/pipeline/presets.h"
#include "scenes/shapes.h"
#include "tests/catch.hpp"
#include "tests/judge/captured.h"
#include "tests/judge/drivers.h"

using namespace trueshade;
using namespace trueshade::oracle;
using namespace trueshade::testing;

namespace {

Mesh with_sets(Mesh mesh, float times) {
  const auto set = [&](float a, float b, float c) {
    UvStreams uv;
    for (size_t v = 0; v < mesh.vertex_count(); ++v) {
      uv[0].push_back((mesh.position[0][v] + a * mesh.position[1][v]) * times);
      uv[1].push_back((b * mesh.position[2][v] - c * mesh.position[1][v]) * times);
    }
    return uv;
  };
  mesh.uv = set(0.37f, 1.0f, 0.21f);
  mesh.more_uv = {set(-0.5f, 0.7f, 0.3f), set(0.25f, -1.3f, 0.6f)};
  return mesh;
}

/// A floor, a wall that shows its back, a ball with holes through which the inside shows, and two that mirror.
Scene room_of_two_sides() {
  Scene scene;
  scene.spec = "two sides";
  scene.meshes = {with_sets(plane_mesh(14), 3.0f), with_sets(sphere_mesh(28), 1.3f)};
  for (const Pattern pattern : {Pattern::checker, Pattern::noise}) {
    TexturePattern p;
    p.pattern = pattern, p.width = p.height = 64;
    p.format = pattern == Pattern::noise ? TextureFormat::rgba8 : TextureFormat::srgb8_a8;
    p.colors = {glm::vec4(0.9f, 0.6f, 0.7f, 1.0f), glm::vec4(0.2f, 0.4f, 0.8f, 0.0f)};
    scene.textures.push_back(texture_of(p));
    build_mip_chain(scene.textures.back());
  }
  scene.materials.resize(4);
  for (size_t i = 0; i < 4; ++i) {
    Material& m = scene.materials[i];
    m.base_color = {0.9f, 0.8f, 1.0f, 1.0f};
    m.double_sided = i == 1 || i == 2;
    if (i == 0) continue;
    m.color_map.texture = 0, m.color_map.uv_set = uint8_t(i % 3);
    m.normal_map.texture = 1, m.normal_map.uv_set = uint8_t((i + 1) % 3);
    m.normal_scale = 0.6f;
  }
  scene.materials[2].alpha_cutoff = 0.45f;
  const auto ball = [&](uint32_t material, float width, glm::vec3 at) {
    const glm::mat4x3 m(glm::vec3(width, 0, 0), glm::vec3(0, 0.7f, 0), glm::vec3(0, 0, 0.7f), at);
    scene.instances.push_back({1, material, m, width < 0.0f});
  };
  scene.instances = {
      {0, 0, glm::mat4x3(glm::vec3(6, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 12), glm::vec3(0, -1, -3))},
      {0, 1, glm::mat4x3(glm::vec3(4, 0, 0), glm::vec3(0, 0, -1), glm::vec3(0, 3, 0.5f), glm::vec3(0, 0, -4))}};
  ball(2, 0.7f, {0.2f, 0.1f, -1.5f});
  ball(3, -0.5f, {-0.9f, 0.0f, -1.8f});
  ball(1, -0.4f, {1.1f, 0.1f, -1.7f});
  scene.lights.resize(2);
  scene.lights[0].position = {1, 2, 1}, scene.lights[0].range = 12.0f;
  scene.lights[1].position = {-1, 0.5f, -2.5f}, scene.lights[1].range = 6.0f;
  scene.camera.eye = {0.1f, 0.2f, 1.5f};
  scene.camera.near = 0.1f, scene.camera.far = 50.0f;
  return scene;
}

/// The same whose balls have tangents, mirrored on one half: along circles about the y axis, unless a pole is near.
Scene room_with_tangents() {
  Scene scene = room_of_two_sides();
  Mesh& ball = scene.meshes[1];
  for (size_t v = 0; v < ball.vertex_count(); ++v) {
    const float x = ball.position[0][v], z = ball.position[2][v], side = ball.position[1][v] < 0.1f ? 1.0f : -1.0f;
    const float along[4] = {z, 0.3f * side, -x, side};
    for (size_t c = 0; c < 4; ++c) ball.tangent[c].push_back(along[c]);
  }
  for (Material& m : scene.materials) m.double_sided = m.double_sided || m.normal_map.used();
  return scene;
}

std::vector<Pipeline> two_sided_pipelines() {
  std::vector<Pipeline> all;
  for (const Strategy strategy : {Strategy::deferred_loop, Strategy::deferred_volumes, Strategy::forward_loop})
    for (int i = 0; i < 3; ++i) {
      Pipeline p = presets().front().pipeline;
      p.width = 96, p.height = 72;
      p.strategy = strategy;
      GeometryState& g = p.geometry;
      g.cull_face = i == 2 ? CullFace::front_and_back : CullFace::back;
      // As the clip origin turns the window, so does the winding that is seen.
      if (i == 1) g.clip_origin = ClipOrigin::upper_left, g.front_face = FrontFace::cw;
      if (i == 2) g.front_face = FrontFace::cw, g.clip_depth = ClipDepth::zero_to_one;
      all.push_back(p);
    }
  return all;
}

uint64_t violations(const Scene& scene, const Pipeline& pipeline, const Capture& capture, const char* name, int bits) {
  Profile profile = *profile_named(name);
  if (profile.name == "unknown") profile.subpixel_bits = bits;
  const Verdict v = validate_capture(scene, pipeline, capture, {profile, false});
  INFO(name << ": " << verdict_json(v));
  CHECK(v.stages[0].covered > 500);
  return v.violations();
}

/// What each wrong renderer makes of the scene.
struct Wrong {
  const char* name;
  void (*change)(Scene&, Pipeline&);
};
constexpr Wrong kWrong[] = {
    {"backs drawn, their normals not turned",
     [](Scene& s, Pipeline& p) {
       for (Material& m : s.materials) m.double_sided = false;
       p.geometry.cull_face = CullFace::none;
     }},
    {"double-sided backs culled", [](Scene& s, Pipeline&) { s.materials[1].double_sided = false; }},
    {"fronts turned instead of backs",
     [](Scene& s, Pipeline& p) {
       for (Material& m : s.materials) m.double_sided = true;
       p.geometry.front_face = p.geometry.front_face == FrontFace::cw ? FrontFace::ccw : FrontFace::cw;
     }},
    {"mirrored instances faced as others",
     [](Scene& s, Pipeline&) {
       for (Instance& i : s.instances) i.mirrored = false;
     }},
    {"colours read at the first set",
     [](Scene& s, Pipeline&) {
       for (Material& m : s.materials) m.color_map.uv_set = 0;
     }},
    {"bumps read at the next set",
     [](Scene& s, Pipeline&) {
       for (Material& m : s.materials) m.normal_map.uv_set = uint8_t((m.normal_map.uv_set + 1) % 3);
     }},
    {"sets exchanged in the mesh",
     [](Scene& s, Pipeline&) {
       for (Mesh& m : s.meshes) std::swap(m.more_uv[0], m.more_uv[1]);
     }},
};

}  // namespace

TEST_CASE("Both sides and every set of texture coordinates in our own frames are explained, wrong ones are not") {
  const Scene scene = room_of_two_sides();
  for (const Pipeline& pipeline : two_sided_pipelines()) {
    INFO(pipeline_json(pipeline));
    const Capture right = captured(scene, pipeline);
    for (const char* profile : {"ideal", "unknown"}) CHECK(violations(scene, pipeline, right, profile, 8) == 0);
    for (const Wrong& wrong : kWrong) {
      Scene other = scene;
      Pipeline drawn = pipeline;
      wrong.change(other, drawn);
      const Capture capture = captured(other, drawn);
      INFO(wrong.name);
      if (capture.color.texels == right.color.texels) {
        CHECK(pipeline.geometry.cull_face == CullFace::front_and_back);  // which leaves few faces
        continue;
      }
      CHECK(violations(scene, pipeline, capture, "unknown", 8) > 7);
    }
  }
}

TEST_CASE("What llvmpipe makes of both sides, mirrored instances and further texture coordinates is legal") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  KeptPrograms programs;
  const Scene scene = room_of_two_sides();
  for (const Pipeline& pipeline : two_sided_pipelines()) {
    INFO(pipeline_json(pipeline));
    GlRenderer renderer(*context, scene, 0, &programs);
    const Capture capture = renderer.draw(pipeline).capture;
    CHECK(violations(scene, pipeline, capture, "unknown", context->info().subpixel_bits) == 0);
    if (is_of_known_profile(*context)) CHECK(violations(scene, pipeline, capture, "mesa-llvmpipe-22.3", 8) == 0);
    if (pipeline.geometry.cull_face != CullFace::back || pipeline.strategy != Strategy::forward_loop) continue;
    for (const Wrong& wrong : kWrong) {
      Scene other = scene;
      Pipeline drawn = pipeline;
      wrong.change(other, drawn);
      const Capture wrong_capture = GlRenderer(*context, other).draw(drawn).capture;
      INFO(wrong.name);
      CHECK(violations(scene, pipeline, wrong_capture, "unknown", context->info().subpixel_bits) > 7);
    }
  }
}

namespace {

/// Renderers that do wrong with tangents, as scenes that a right one draws so.
constexpr Wrong kWrongTangents[] = {
    {"w taken for 1",
     [](Scene& s, Pipeline&) {
       for (float& side : s.meshes[1].tangent[3]) side = 1.0f;
     }},
    {"w turned round",
     [](Scene& s, Pipeline&) {
       for (float& side : s.meshes[1].tangent[3]) side = -side;
     }},
    {"a matrix that mirrors forgotten",
     [](Scene& s, Pipeline&) {  // a mesh of its own for each instance that mirrors
       s.meshes.push_back(s.meshes[1]);
       for (float& side : s.meshes.back().tangent[3]) side = -side;
       for (Instance& i : s.instances)
         if (i.mirrored) i.mesh = uint32_t(s.meshes.size() - 1);
     }},
    {"tangents of the file ignored", [](Scene& s, Pipeline&) { s.meshes[1].tangent = {}; }},
};

}  // namespace

TEST_CASE("Vertices' tangents in our own frames are explained, wrong ones are not") {
  const Scene scene = room_with_tangents();
  for (const Pipeline& pipeline : two_sided_pipelines()) {
    INFO(pipeline_json(pipeline));
    const Capture right = captured(scene, pipeline);
    for (const char* profile : {"ideal", "unknown"}) CHECK(violations(scene, pipeline, right, profile, 8) == 0);
    if (pipeline.geometry.cull_face != CullFace::back) continue;
    for (const Wrong& wrong : kWrongTangents) {
      Scene other = scene;
      Pipeline drawn = pipeline;
      wrong.change(other, drawn);
      INFO(wrong.name);
      CHECK(violations(scene, pipeline, captured(other, drawn), "unknown", 8) > 7);
    }
  }
}

namespace {

/// The shaders of the frame with a part of their text replaced, which must be there.
GlslShaders replaced(GlslShaders shaders, const std::string& part, const std::string& by) {
  int found = 0;
  for (std::string* text : {&shaders.geometry_vert, &shaders.geometry_frag, &shaders.light_vert, &shaders.light_frag})
    for (size_t at = text->find(part); at != std::string::npos; at = text->find(part, at + by.size()), ++found)
      text->replace(at, part.size(), by);
  CHECK(found > 0);
  return shaders;
}

/// Shaders that do wrong with tangents.
constexpr struct {
  const char *part, *by;
} kWrongText[] = {
    {"< 0.0 ? -own.w : own.w;", "< 0.0 ? own.w : own.w;"},  // a matrix that mirrors forgotten
    // A back face's T and B not turned with its N.
    {"return (T * t.x + B * t.y) +", "return (gl_FrontFacing ? T * t.x + B * t.y : -(T * t.x + B * t.y)) +"},
    {"vec3 T = U - N * (dot(N, U) / n2);", "vec3 T = U;"},    // not laid across N
    {"T = T * inversesqrt(t2);", "T = T * 1.0;"},             // not of unit length
    {"tangent_side == 0.0 ? dot(C, along_v)", "true ? 1.0"},  // w dropped
    {"own.xyz), linear(world_from_object[1]", "own.xyz), linear(-world_from_object[1]"},
};

}  // namespace

TEST_CASE("What llvmpipe makes of vertices' tangents is legal, and what it makes of wrong ones is not") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  KeptPrograms programs;
  const Scene scene = room_with_tangents();
  for (const Pipeline& pipeline : two_sided_pipelines()) {
    INFO(pipeline_json(pipeline));
    const Capture capture = GlRenderer(*context, scene).draw(pipeline).capture;
    CHECK(violations(scene, pipeline, capture, "unknown", context->info().subpixel_bits) == 0);
    if (is_of_known_profile(*context)) CHECK(violations(scene, pipeline, capture, "mesa-llvmpipe-22.3", 8) == 0);
    if (pipeline.geometry.cull_face != CullFace::back || pipeline.strategy != Strategy::forward_loop) continue;
    for (const Wrong& wrong : kWrongTangents) {
      Scene other = scene;
      Pipeline drawn = pipeline;
      wrong.change(other, drawn);
      INFO(wrong.name);
      CHECK(violations(scene, pipeline, GlRenderer(*context, other).draw(drawn).capture, "unknown",
                       context->info().subpixel_bits) > 7);
    }
    GlRenderer renderer(*context, scene, 0, &programs);
    GlDraw draw;
    draw.shader_options = renderer.shader_options(draw);
    for (const auto& wrong : kWrongText) {
      const GlslShaders shaders = replaced(shaders_of(pipeline, draw.shader_options), wrong.part, wrong.by);
      draw.shaders = &shaders;
      INFO(wrong.by);
      CHECK(violations(scene, pipeline, renderer.draw(pipeline, draw).capture, "unknown",
                       context->info().subpixel_bits) > 7);
    }
  }
}
