#include "tests/judge/random_frame.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <iterator>

#include "core/error.h"
#include "scenes/pipeline/presets.h"
#include "scenes/shapes.h"
#include "tests/judge/random_light_text.h"
#include "tests/judge/random_scene.h"
#include "tests/stated_presets.h"

namespace trueshade::testing {

namespace {

bool one_in(Pcg32& random, uint32_t count) { return random.below(count) == 0; }

template <class Value, size_t N>
Value any_of(Pcg32& random, const Value (&values)[N]) {
  return values[random.below(uint32_t(N))];
}

/// An enumerator from 0 to `last`.
template <class Enum>
Enum any_to(Pcg32& random, Enum last) {
  return Enum(random.below(uint32_t(last) + 1));
}

constexpr float kLargestObject = 1.6f;  // of random_scene()'s; larger ones may reach behind the eye

glm::vec3 any_color(Pcg32& random, double most) {
  return {random.between(0, most), random.between(0, most), random.between(0, most)};
}

/// All maps that are not there yet, by the sampler of the colour's.
void add_maps(Material& m, Pcg32& random) {
  for (TextureSlot* slot : maps_of(m)) {
    if (slot == &m.color_map || !one_in(random, 3)) continue;
    *slot = m.color_map;
    slot->texture = int32_t(random.below(2));
  }
  // A texel above 1 is refused in these two, and the textures' are not.
  m.occlusion_strength = float(random.between(0, 1));
}

void vary_material(Material& m, Pcg32& random) {
  if (m.color_map.used()) add_maps(m, random);
  m.metallic = float(random.between(0, 1)), m.roughness = float(random.between(0, 1));
  if (one_in(random, 3)) m.emission = any_color(random, 0.5);
  m.unlit = one_in(random, 8);
  m.double_sided = one_in(random, 3);
  if (one_in(random, 4)) m.transparent = true, m.base_color.a = float(random.between(0.1, 0.95));
  if (one_in(random, 5)) m.alpha_cutoff = float(random.between(0.05, 0.6));
}

/// Two triangles of a slanted quad, as large as the view.
Instance large_quad(Pcg32& random) {
  Instance quad{2, random.below(3), {}};
  quad.world_from_object = placed({random.between(-1, 1), random.between(-1.5, 0.5), random.between(-3, 3)},
                                  {random.between(2, 30), 1, random.between(2, 30)}, random.between(0, 6));
  if (one_in(random, 2)) std::swap(quad.world_from_object[1], quad.world_from_object[2]);
  return quad;
}

void add_instances(Scene& scene, Pcg32& random) {
  for (uint32_t more = random.below(3); more > 0; --more) scene.instances.push_back(large_quad(random));
  if (one_in(random, 4)) {  // one over another, with the same depths
    Instance again = scene.instances[random.below(uint32_t(scene.instances.size()))];
    again.material = random.below(3);
    scene.instances.push_back(again);
  }
  for (Instance& i : scene.instances)
    if (one_in(random, 6)) i.world_from_object[0] *= -1.0f, i.mirrored = one_in(random, 2);
}

void vary_lights(Scene& scene, Pcg32& random) {
  for (Light& light : scene.lights) {
    if (one_in(random, 8)) light.type = LightType::ambient;
    if (one_in(random, 3)) light.ambient = any_color(random, 0.3);
    if (one_in(random, 6)) light.range = std::numeric_limits<float>::infinity();
  }
}

Scene wide_scene(Pcg32& random) {
  Scene scene = random_scene(random);
  scene.meshes[1] = sphere_mesh(1 + int(random.below(9)));
  for (Material& m : scene.materials) vary_material(m, random);
  for (Mesh& mesh : scene.meshes)
    if (!mesh.has_uv()) {  // where maps may be asked for, there are coordinates
      mesh.uv[0] = mesh.position[0], mesh.uv[1] = mesh.position[2];
    }
  add_instances(scene, random);
  vary_lights(scene, random);
  scene.camera.near = any_of(random, {0.1f, 1.0f, 4.0f}), scene.camera.far = any_of(random, {5.5f, 20.0f, 1000.0f});
  if (one_in(random, 2)) scene.clear = {any_color(random, 1), float(random.between(0, 1))};
  return scene;
}

void vary_light_model(LightModel& m, Pcg32& random) {
  m.renormalize = one_in(random, 2);
  m.specular_masked = one_in(random, 2);
  m.falloff = any_to(random, Falloff::inverse_square);
  m.order = any_to(random, TermOrder::with_ambient);
  m.alpha_from_albedo = one_in(random, 2);
  m.cone = any_to(random, Cone::squared_penumbra);
  m.diffuse = one_in(random, 4) ? Diffuse::unclamped : Diffuse::clamped;
  m.specular = any_to(random, Specular::none);
  m.specular_source = any_to(random, SpecularSource::metallic_roughness);
  m.viewer = any_to(random, Viewer::infinite);
  m.emission = one_in(random, 2);
  m.clamp_result = one_in(random, 4);
  if (one_in(random, 3)) m.global_ambient = any_color(random, 0.3);
  if (m.order == TermOrder::albedo_last && m.specular != Specular::none) m.specular_source = SpecularSource::albedo;
}

void vary_planes(GBufferState& g, Pcg32& random) {
  for (PlaneState* plane : {&g.position, &g.normal, &g.albedo, &g.uv})
    if (one_in(random, 4)) plane->interpolation = any_to(random, Interpolation::noperspective);
  g.position.format = any_of(random, kPositionFormats), g.uv.format = any_of(random, kPositionFormats);
  g.normal.format = any_of(random, kNormalFormats), g.albedo.format = any_of(random, kAlbedoFormats);
  g.specular = any_of(random, kSpecularFormats), g.emission = any_of(random, kEmissionFormats);
  g.position_from_depth = one_in(random, 4);
}

/// A depth test that something passes against the clear depth, or once in eight any.
void vary_depth_test(GeometryState& g, Pcg32& random) {
  constexpr DepthFunc kUsual[] = {DepthFunc::less, DepthFunc::lequal, DepthFunc::greater, DepthFunc::gequal,
                                  DepthFunc::always};
  g.depth_func = one_in(random, 4) ? any_to(random, DepthFunc::always) : any_of(random, kUsual);
  const bool greater = g.depth_func == DepthFunc::greater || g.depth_func == DepthFunc::gequal;
  g.clear_depth = greater ? 0.0f : 1.0f;
  if (one_in(random, 8)) g.clear_depth = any_of(random, {0.0f, 0.5f, 1.0f, 0.98f});
  if (one_in(random, 4)) std::swap(g.depth_near, g.depth_far);
  if (one_in(random, 4)) g.depth_near = 0.25f, g.depth_far = 0.75f;
  g.depth_format = any_of(random, kDepthFormats);
  g.depth_clamp = one_in(random, 4);
}

void vary_geometry(Pipeline& p, Pcg32& random) {
  GeometryState& g = p.geometry;
  vary_depth_test(g, random);
  if (one_in(random, 3)) g.cull_face = any_of(random, {CullFace::front, CullFace::back});
  g.front_face = any_to(random, FrontFace::cw);
  g.clip_origin = any_to(random, ClipOrigin::upper_left), g.clip_depth = any_to(random, ClipDepth::zero_to_one);
  g.provoking = any_to(random, Provoking::first);
  if (one_in(random, 6)) g.viewport = {3, -2, p.width - 5, p.height - 1};
  if (!one_in(random, 2)) return;
  g.polygon_offset_factor = any_of(random, {0.0f, 1.5f, -1.5f, 300.0f, -300.0f, float(random.between(-4, 4))});
  g.polygon_offset_units = any_of(random, {0.0f, 20.0f, -7.0f, 3e4f, 5e6f, -5e6f, float(random.between(-50, 50))});
}

BlendTerm any_term(Pcg32& random) {
  return {any_to(random, BlendEquation::max), any_to(random, BlendFactor::src_alpha_saturate),
          any_to(random, BlendFactor::src_alpha_saturate)};
}

void vary_blend(BlendState& b, Pcg32& random) {
  b.rgb = any_term(random), b.alpha = any_term(random);
  for (float& c : b.constant) c = float(random.between(0, 1));
  if (one_in(random, 3)) b.mask[random.below(4)] = false;
}

void vary_light_volumes(LightVolumes& v, Pcg32& random) {
  v.point = any_to(random, LightExtent::cone), v.spot = any_to(random, LightExtent::cone);
  v.slices = 3 + int(random.below(14)), v.stacks = 2 + int(random.below(7));
  v.cull_face = any_of(random, {CullFace::none, CullFace::front, CullFace::back});
  v.depth_clamp = !one_in(random, 4), v.base = !one_in(random, 4);
}

Pipeline wide_pipeline(Pcg32& random) {
  const std::vector<Preset> rows = stated_presets();
  Pipeline p = rows[random.below(uint32_t(rows.size()))].pipeline;
  p.strategy = Strategy(random.below(uint32_t(std::size(kStrategyNames))));
  p.width = 32 + int(random.below(33)), p.height = 24 + int(random.below(25));
  p.target = any_of(random, kTargetFormats);
  if (one_in(random, 2)) vary_light_model(p.light_model, random);
  if (one_in(random, 2)) vary_planes(p.gbuffer, random);
  if (!one_in(random, 4)) vary_geometry(p, random);
  if (one_in(random, 2)) vary_light_volumes(p.light_volumes, random);
  if (one_in(random, 4)) vary_blend(p.blend, random);
  p.transparency.mode = any_to(random, TransparencyMode::after_lights);
  if (one_in(random, 3)) vary_blend(p.transparency.blend, random);
  return p;
}

void take_to_an_end(Pipeline& p, Pcg32& random) {
  GeometryState& g = p.geometry;
  p.strategy = Strategy::forward_multipass;
  vary_depth_test(g, random);
  const float sign = one_in(random, 4) ? -1.0f : 1.0f;
  g.polygon_offset_factor = sign * any_of(random, {0.0f, 30.0f, 300.0f});
  g.polygon_offset_units = sign * any_of(random, {0.0f, 3e4f, 5e6f});
}

void slope_depths(RandomFrame& frame, Pcg32& random) {
  GeometryState& g = frame.pipeline.geometry;
  g.polygon_offset_factor = any_of(random, {1.5f, -1.5f, float(random.between(-8, 8))});
  g.depth_func = any_of(random, {DepthFunc::less, DepthFunc::lequal, DepthFunc::always});
  g.clear_depth = 1.0f;
  frame.scene.meshes[1] = sphere_mesh(8 + int(random.below(20)));
  for (size_t i = 0; i < frame.scene.instances.size(); i += 2) frame.scene.instances[i].mesh = 1;
}

void take_glass_in_halves(RandomFrame& frame, Pcg32& random) {
  Pipeline& p = frame.pipeline;
  if (is_forward(p.strategy)) p.strategy = one_in(random, 2) ? Strategy::deferred_loop : Strategy::deferred_volumes;
  p.transparency.mode = TransparencyMode::into_albedo;
  p.gbuffer.albedo.format = Format::rgb16f;
  frame.scene.materials[random.below(3)].transparent = true;
}

void take_program(Pipeline& p, Pcg32& random) {
  const std::string text = random_light_text(random);
  p.light_program = {"random.glsl", text, {}, {}};
}

/// Mesa's clip stage hands on NaN where it cuts some triangles of noperspective attributes, and our own frames follow
/// another rule there: those are left out.
void keep_uncut(RandomFrame& frame) {
  const GBufferState& g = frame.pipeline.gbuffer;
  const PlaneState planes[] = {g.position, g.normal, g.albedo, g.uv};
  if (std::none_of(std::begin(planes), std::end(planes),
                   [](const PlaneState& plane) { return plane.interpolation == Interpolation::noperspective; }))
    return;
  frame.scene.camera.near = 0.1f, frame.scene.camera.far = 1000.0f;
  frame.scene.camera.eye.z = 16.0f;  // from where all of it is in view
  std::erase_if(frame.scene.instances, [](const Instance& i) {
    return std::max(glm::length(i.world_from_object[0]), glm::length(i.world_from_object[2])) > kLargestObject;
  });
}

}  // namespace

RandomFrame random_frame(uint64_t seed, FrameTheme theme) {
  Pcg32 random(seed, 1 + uint64_t(theme));
  RandomFrame frame{wide_scene(random), wide_pipeline(random)};
  if (theme == FrameTheme::clamped_depths) take_to_an_end(frame.pipeline, random);
  if (theme == FrameTheme::sloped_depths) slope_depths(frame, random);
  if (theme == FrameTheme::glass_in_halves) take_glass_in_halves(frame, random);
  if (theme == FrameTheme::light_program) take_program(frame.pipeline, random);
  if (is_forward(frame.pipeline.strategy) && frame.pipeline.transparency.mode == TransparencyMode::into_albedo)
    frame.pipeline.transparency.mode = TransparencyMode::after_lights;
  keep_uncut(frame);
  frame.pipeline.gbuffer.unit_normals = any_of(random, {UnitNormals::vertex, UnitNormals::fragment, UnitNormals::both});
  validate(frame.scene);
  validate(frame.pipeline);
  return frame;
}

}  // namespace trueshade::testing
