#include "tests/judge/random_scene.h"

#include "scenes/shapes.h"
#include "scenes/builtin/texture_pattern.h"

namespace trueshade::testing {

namespace {

/// Of every format, wrap and filter, on all meshes; the first material has none.
void add_textures(Scene& scene, Pcg32& random) {
  for (Mesh& mesh : scene.meshes)
    for (size_t v = 0; v < mesh.vertex_count(); ++v) {
      mesh.uv[0].resize(mesh.vertex_count()), mesh.uv[1].resize(mesh.vertex_count());
      mesh.uv[0][v] = mesh.position[0][v] + 0.37f * mesh.position[1][v];
      mesh.uv[1][v] = mesh.position[2][v] - 0.21f * mesh.position[1][v];
    }
  for (int k = 1; k < 3; ++k) {
    TexturePattern p;
    p.pattern = Pattern(random.below(3));
    p.width = 16 << random.below(2), p.height = 12 + int(random.below(30));
    p.columns = p.rows = 4;
    p.format = TextureFormat(random.below(4));
    p.colors = {glm::vec4(random.between(0, 1), random.between(0, 1), random.between(0, 1), 1),
                glm::vec4(random.between(0, 1), 0.1f, 0.4f, 0.5f)};
    scene.textures.push_back(texture_of(p));
    build_mip_chain(scene.textures.back());
    Material& m = scene.materials[size_t(k)];
    m.color_map.texture = k - 1;
    Sampler& s = m.color_map.sampler;
    s.wrap = {Wrap(random.below(5)), Wrap(random.below(5))};
    s.mag_filter = Filter(random.below(2)), s.min_filter = Filter(random.below(2)),
    s.mip_filter = MipFilter(random.below(3));
    s.lod_bias = random.below(4) == 0 ? -0.75f : 0.0f;
  }
}

/// Bumps of both textures, gloss of the other one.
void add_bumps(Scene& scene, Pcg32& random) {
  for (Material& m : scene.materials) {
    if (!m.color_map.used()) continue;
    m.normal_map = m.specular_map = m.color_map;
    m.normal_map.texture = int32_t(random.below(2));
    m.specular_map.texture = 1 - m.normal_map.texture;
    m.normal_scale = random.below(2) == 0 ? 1.0f : float(random.between(0.1, 2));
  }
}

BlendState random_blend(Pcg32& random) {
  using enum BlendFactor;
  BlendState b = kBlendOver;
  switch (random.below(5)) {
    case 0:
      b.rgb = {BlendEquation::add, one, one_minus_src_alpha};
      break;
    case 1:
      b.rgb = {BlendEquation::add, src_alpha, one};
      break;
    case 2:
      b.rgb = b.alpha = {BlendEquation::add, dst_color, zero};
      break;
    default:
      break;
  }
  return b;
}

}  // namespace

void add_tangents(Scene& scene) {
  for (Mesh* mesh : {&scene.meshes[0], &scene.meshes[1]})  // along circles about an axis beside the mesh
    for (size_t v = 0; v < mesh->vertex_count(); ++v) {
      const float along[4] = {mesh->position[2][v] + 0.3f, 0.2f, 0.1f - mesh->position[0][v],
                              mesh->position[1][v] < 0.0f ? -1.0f : 1.0f};
      for (size_t c = 0; c < 4; ++c) mesh->tangent[c].push_back(along[c]);
    }
}

Scene random_scene(Pcg32& random) {
  Scene scene;
  scene.spec = "random";
  scene.meshes = {cube_mesh(), sphere_mesh(2), plane_mesh(2)};
  for (int k = 0; k < 3; ++k)
    scene.materials.push_back({"", {random.between(0, 1), random.between(0, 1), random.between(0, 1), 1}});
  for (Material& m : scene.materials) {
    m.specular_color = {random.between(0, 1), random.between(0, 1), random.between(0, 1)};
    m.shininess = float(1 + random.below(40));
  }
  if (random.below(2) == 0) {
    add_textures(scene, random);
    if (random.below(2) == 0) add_bumps(scene, random);
  }
  if (random.below(4) == 0)
    for (int k = 1; k < 3; ++k) {
      scene.materials[size_t(k)].transparent = k == 1 || random.below(2) == 0;
      scene.materials[size_t(k)].base_color.a = float(random.between(0.1, 0.9));
    }
  const uint32_t objects = 2 + random.below(5);
  for (uint32_t i = 0; i < objects; ++i) {
    Instance instance{random.below(3), random.below(3), {}};
    const auto coordinate = [&](double reach) { return random.between(-reach, reach); };
    instance.world_from_object =
        placed({coordinate(1.5), coordinate(1), coordinate(1.5)},
               {random.between(0.2, 1.5), random.between(0.2, 1.5), random.between(0.2, 1.5)}, random.between(0, 6));
    scene.instances.push_back(instance);
  }
  const uint32_t lights = random.below(6);
  for (uint32_t i = 0; i < lights; ++i) {
    Light light;
    constexpr LightType kinds[] = {LightType::directional, LightType::spot,  LightType::spot,
                                   LightType::point,       LightType::point, LightType::point};
    light.type = kinds[random.below(6)];
    light.position = {random.between(-2, 2), random.between(-2, 2), random.between(-1, 4)};
    light.direction = {0.0f, -0.6f, -0.8f};
    light.color = {random.between(0, 0.6), random.between(0, 0.6), random.between(0, 0.6)};
    light.range = float(random.between(1, 6));
    light.cone_rad = float(random.between(0.2, 1)), light.penumbra_rad = float(random.between(0.05, 0.5));
    light.spot_exponent = float(random.below(20));
    light.attenuation = {1.0f, float(random.between(0, 1)), float(random.between(0, 1))};
    scene.lights.push_back(light);
  }
  scene.camera.eye = {random.between(-0.5, 0.5), random.between(-0.5, 1), 5};
  scene.camera.target = {0.0f, 0.0f, 0.0f};
  scene.camera.near = 1.0f;
  scene.camera.far = 20.0f;
  return scene;
}

Pipeline random_pipeline(Pcg32& random) {
  Pipeline p;
  p.width = 32;
  p.height = 24;
  constexpr float shininess[] = {1, 8, 32, 64, 7.5f};
  p.light_model.shininess = shininess[random.below(5)];
  p.light_model.renormalize = random.below(2) == 0;
  p.light_model.specular_masked = random.below(2) == 0;
  constexpr Falloff falloffs[] = {Falloff::linear_range, Falloff::linear_range, Falloff::quadratic,     Falloff::none,
                                  Falloff::linear,       Falloff::attenuation,  Falloff::inverse_square};
  constexpr TermOrder orders[] = {TermOrder::factored, TermOrder::separate, TermOrder::albedo_last};
  constexpr Format targets[] = {Format::rgba8, Format::rgba32f, Format::rgba16f, Format::srgb8_a8};
  constexpr Format depths[] = {Format::d32f, Format::d32f, Format::d24, Format::d16};
  p.light_model.falloff = falloffs[random.below(7)];
  p.light_model.order = orders[random.below(3)];
  p.light_model.cone = Cone(random.below(5));
  const bool of_albedo = random.below(4) == 0;
  // The albedo can come last only where the highlight has its colour too.
  if (of_albedo || p.light_model.order == TermOrder::albedo_last)
    p.light_model.specular_source = SpecularSource::albedo;
  p.target = targets[random.below(4)];
  constexpr Format normals[] = {Format::rgba32f, Format::rgba16f, Format::rgba16f, Format::rgb10_a2};
  p.gbuffer.normal.format = normals[random.below(4)];
  if (random.below(4) == 0 && p.light_model.specular_source == SpecularSource::model)
    p.light_model.specular_source = SpecularSource::material;
  if (random.below(4) == 0) {
    constexpr LightExtent extents[] = {LightExtent::unbounded, LightExtent::range};
    const uint32_t first = random.below(2);
    p.light_volumes.point = extents[first], p.light_volumes.spot = extents[1 - first];
  }
  p.transparency.mode = TransparencyMode(random.below(3));
  p.transparency.blend = random_blend(random);
  p.geometry.depth_format = depths[random.below(4)];
  if (random.below(4) == 0) {
    p.geometry.polygon_offset_factor = float(random.between(-2, 2));
    p.geometry.polygon_offset_units = float(random.between(-20, 20));
  }
  return p;
}

}  // namespace trueshade::testing
