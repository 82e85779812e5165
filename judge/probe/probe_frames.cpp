#include "judge/probe/probe_frames.h"

#include <cmath>

#include "scenes/builtin/pcg32.h"

namespace trueshade::oracle {

namespace {

constexpr int kShards = 150;

/// A triangle of random corners before the camera, some beyond the view's sides: edges at all places of a grid, w that
/// varies, colours and normals that differ from corner to corner.
void add_shard(Mesh& mesh, Pcg32& random) {
  const double x = random.between(-4.5, 4.5), y = random.between(-3.5, 3.5), z = random.between(-6, 1.5);
  for (int corner = 0; corner < 3; ++corner) {
    mesh.indices.push_back(uint32_t(mesh.vertex_count()));
    const double at[] = {x + random.between(-1.6, 1.6), y + random.between(-1.6, 1.6), z + random.between(-2, 2)};
    for (size_t k = 0; k < 3; ++k) mesh.position[k].push_back(float(at[k]));
    const double n[] = {random.between(-0.6, 0.6), random.between(-0.6, 0.6), 1};
    for (size_t k = 0; k < 3; ++k) mesh.normal[k].push_back(float(n[k]));
    for (size_t k = 0; k < 2; ++k) mesh.uv[k].push_back(float(random.between(-2, 3)));
    for (size_t k = 0; k < 4; ++k) mesh.color[k].push_back(float(random.between(0.05, 1)));
  }
}

void add_lights(Scene& scene, Pcg32& random) {
  for (int i = 0; i < 9; ++i) {
    Light light;
    light.position = {random.between(-4, 4), random.between(-3, 3), random.between(0, 4)};
    light.color = {random.between(0.02, 0.5), random.between(0.02, 0.5), random.between(0.02, 0.5)};
    light.range = float(random.between(3, 9));
    scene.lights.push_back(light);
  }
}

/// A shard of one colour with corners behind the camera. What is seen of its planes is far from those corners, so that
/// a snap of such a corner shows enlarged.
void add_shard_behind_eye(Mesh& mesh, Pcg32& random) {
  add_shard(mesh, random);
  for (size_t corner = mesh.vertex_count() - 3; corner < mesh.vertex_count(); ++corner) {
    mesh.position[2][corner] += float(corner % 3 == 0 ? 0 : random.between(2, 12));
    for (size_t k = 0; k < 4; ++k) mesh.color[k][corner] = mesh.color[k][mesh.vertex_count() - 3];
  }
}

Scene shards(Pcg32& random, void (*add)(Mesh&, Pcg32&) = add_shard) {
  Scene scene;
  scene.spec = "probe";
  scene.meshes.resize(1);
  for (int i = 0; i < kShards; ++i) add(scene.meshes[0], random);
  scene.materials.push_back({"", {0.9f, 0.8f, 0.7f, 1.0f}});
  scene.instances.push_back({});
  scene.camera.eye = {0.0f, 0.0f, 5.0f};
  scene.camera.fov_y_rad = 0.9f;
  add_lights(scene, random);
  return scene;
}

Texture noise(TextureFormat format, Pcg32& random) {
  constexpr int kSide = 32;
  Texture texture{"", format, {{kSide, kSide, {}}}};
  for (int i = 0; i < kSide * kSide; ++i) {
    std::array<float, 4> texel;
    for (float& channel : texel) channel = float(random.below(256)) / 255.0f;
    append_texel(format, texel, texture.levels[0].bytes);
  }
  build_mip_chain(texture);
  return texture;
}

/// The same shards with a map: texels of this format, filtered so.
Scene mapped_shards(Pcg32& random, TextureFormat format, MipFilter mip) {
  Scene scene = shards(random);
  for (FloatStream& channel : scene.meshes[0].color) channel = {};
  scene.textures.push_back(noise(format, random));
  TextureSlot& slot = scene.materials[0].color_map;
  slot.texture = 0;
  slot.sampler.mip_filter = mip;
  return scene;
}

/// Squares whose corners lie on centres of pixels, of a picture of 64x64, one beside the other: every edge goes through
/// centres, and each centre has one owner.
Scene aligned_squares(Pcg32& random) {
  constexpr int kSide = 64, kSquares = 40;
  Scene scene;
  scene.spec = "probe";
  Mesh& mesh = scene.meshes.emplace_back();
  for (int i = 0; i < kSquares; ++i) {
    const int x = int(random.below(kSide - 12)), y = int(random.below(kSide - 12));
    const int w = 2 + int(random.below(10)), h = 2 + int(random.below(10));
    const float z = 0.9f - 0.04f * float(i);
    const auto first = uint32_t(mesh.vertex_count());
    for (const auto& [cx, cy] : {std::pair(x, y), std::pair(x + w, y), std::pair(x + w, y + h), std::pair(x, y + h)}) {
      const float at[] = {(float(cx) + 0.5f) / 32 - 1, (float(cy) + 0.5f) / 32 - 1, z};
      for (size_t k = 0; k < 3; ++k) mesh.position[k].push_back(at[k]), mesh.normal[k].push_back(k == 2 ? 1.0f : 0.0f);
      for (size_t k = 0; k < 4; ++k) mesh.color[k].push_back(float(i % 8 + 1) / 8);
    }
    for (const uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + corner);
  }
  scene.materials.push_back({"", glm::vec4(1.0f)});
  scene.instances.push_back({});
  scene.camera.clip_from_world = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  add_lights(scene, random);
  return scene;
}

/// The same squares under a map, each at another number of texels a pixel, the same along both axes: what there is of
/// rho is one number, and the level shows how its logarithm is made. Where a texel is as large as a pixel its value is
/// seen.
Scene scaled_squares(Pcg32& random) {
  Scene scene = aligned_squares(random);
  Mesh& mesh = scene.meshes[0];
  for (FloatStream& channel : mesh.color) channel = {};
  scene.textures.push_back(noise(TextureFormat::srgb8_a8, random));
  TextureSlot& slot = scene.materials[0].color_map;
  slot.texture = 0;
  slot.sampler.mag_filter = slot.sampler.min_filter = Filter::nearest;
  slot.sampler.mip_filter = MipFilter::linear;
  const double side = scene.textures[0].levels[0].width;
  for (size_t first = 0; first < mesh.vertex_count(); first += 4) {
    const double texels = std::exp2(random.between(-1.5, 4)), pixels = 32;  // of half the window
    for (size_t corner = first; corner < first + 4; ++corner)
      for (size_t k = 0; k < 2; ++k)
        mesh.uv[k].push_back(float(double(mesh.position[k][corner]) * pixels * texels / side));
  }
  return scene;
}

/// White ambient light and nothing else: the target is the albedo as it is read back.
Scene in_ambient_light(Scene scene) {
  scene.lights = {ambient_light(glm::vec3(1.0f))};
  return scene;
}

Pipeline plan_pipeline(Strategy strategy, Format target) {
  Pipeline p;
  p.width = 96, p.height = 72;
  p.strategy = strategy;
  p.target = target;
  return p;
}

/// Lights over what is there by its alpha: products of codes, where adding them has none.
Pipeline by_alpha(Pipeline p) {
  p.blend.rgb = p.blend.alpha = {BlendEquation::add, BlendFactor::src_color, BlendFactor::one_minus_src_color};
  p.light_model.alpha_from_albedo = true;
  return p;
}

Pipeline of_halves(Pipeline p) {
  for (PlaneState* plane : {&p.gbuffer.position, &p.gbuffer.normal, &p.gbuffer.albedo, &p.gbuffer.uv})
    plane->format = Format::rgba16f;
  return p;
}

Pipeline offset(Pipeline p, Format depth, float factor = 1.5f, float units = 37.0f) {
  p.geometry.depth_format = depth;
  p.geometry.polygon_offset_factor = factor, p.geometry.polygon_offset_units = units;
  return p;
}

}  // namespace

std::vector<ProbePlan> probe_plans(uint64_t seed) {
  using enum Strategy;
  Pcg32 random(seed, 29);
  std::vector<ProbePlan> plans;
  const auto add = [&](const char* name, Scene scene, const Pipeline& pipeline) {
    plans.push_back({name, std::move(scene), pipeline});
  };
  add("shards into rgba8", shards(random), plan_pipeline(deferred_loop, Format::rgba8));
  Pipeline aligned = plan_pipeline(deferred_loop, Format::rgba8);
  aligned.width = aligned.height = 64;
  add("squares on centres of pixels", aligned_squares(random), aligned);
  add("albedo read back", in_ambient_light(shards(random)), plan_pipeline(deferred_loop, Format::rgba32f));
  add("shards into rgba32f", shards(random), plan_pipeline(deferred_loop, Format::rgba32f));
  add("shards into rgba16f, planes of halves", shards(random),
      of_halves(plan_pipeline(deferred_loop, Format::rgba16f)));
  add("shards into srgb8_a8", shards(random), plan_pipeline(deferred_loop, Format::srgb8_a8));
  add("shards into rgb10_a2", shards(random), plan_pipeline(deferred_loop, Format::rgb10_a2));
  add("shards at an offset, depth of 24 bits", shards(random),
      offset(plan_pipeline(deferred_loop, Format::rgba8), Format::d24));
  add("shards at an offset, depth of 16 bits", shards(random),
      offset(plan_pipeline(deferred_loop, Format::rgba8), Format::d16));
  add("lights blended into rgba8", shards(random), plan_pipeline(deferred_volumes, Format::rgba8));
  add("lights over rgba8 by their colour", shards(random), by_alpha(plan_pipeline(deferred_volumes, Format::rgba8)));
  add("lights blended into rgba16f", shards(random), plan_pipeline(deferred_volumes, Format::rgba16f));
  for (const MipFilter mip : {MipFilter::none, MipFilter::linear})
    for (const TextureFormat format : {TextureFormat::rgba8, TextureFormat::srgb8_a8, TextureFormat::rgba32f}) {
      Pipeline p = plan_pipeline(deferred_loop, Format::rgba8);
      p.gbuffer.albedo.format = Format::rgba32f;
      add(("a map of " + std::string(kTextureFormatNames[size_t(format)]) +
           (mip == MipFilter::none ? ", level 0" : ", all levels"))
              .c_str(),
          mapped_shards(random, format, mip), p);
    }
  Pipeline floats = plan_pipeline(deferred_loop, Format::rgba32f);
  floats.gbuffer.albedo.format = Format::rgba32f;
  add("shards behind the eye", shards(random, add_shard_behind_eye), floats);
  add("shards into r11g11b10f", shards(random), plan_pipeline(deferred_loop, Format::r11g11b10f));
  Pipeline faced = aligned;
  faced.gbuffer.albedo.format = Format::rgba32f;
  add("squares under a map", scaled_squares(random), faced);
  aligned.geometry.clip_origin = ClipOrigin::upper_left;
  add("squares on centres, from the upper left", aligned_squares(random), aligned);
  add("shards at an offset of many units", shards(random),
      offset(plan_pipeline(deferred_loop, Format::rgba8), Format::d16, 0.0f, -4095.0f));
  return plans;
}

}  // namespace trueshade::oracle
