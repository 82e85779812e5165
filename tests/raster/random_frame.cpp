#include "tests/raster/random_frame.h"

#include <algorithm>

namespace trueshade::testing {
namespace {

template <typename T>
T one_of(Random& random, std::initializer_list<T> values) {
  return *(values.begin() + random() % values.size());
}

}  // namespace

double between(Random& random, double low, double high) {
  return low + (high - low) * double(random() >> 11) * 0x1p-53;
}

Scene random_scene(Random& random) {
  Scene scene;
  scene.materials.resize(2);
  scene.materials[1].base_color = {0.5f, 0.25f, 2.0f, 0.75f};
  for (int m = 0; m < 2; ++m) {
    Mesh mesh;
    const auto add_vertex = [&](double x, double y, double z) {
      const double position[3] = {x, y, z};
      for (size_t k = 0; k < 3; ++k) mesh.position[k].push_back(float(position[k]));
      for (size_t k = 0; k < 3; ++k) mesh.normal[k].push_back(float(between(random, -1, 1)));
      for (size_t k = 0; k < 2; ++k) mesh.uv[k].push_back(float(between(random, -3, 5)));
      for (size_t k = 0; k < 4; ++k) mesh.color[k].push_back(float(between(random, 0, 1)));
    };
    if (m == 0) {
      for (int i = 0; i < 60; ++i)
        add_vertex(between(random, -2, 2), between(random, -2, 2), between(random, -2, 2)),
            mesh.indices.push_back(uint32_t(i));
    } else {
      for (uint32_t y = 0; y < 6; ++y)
        for (uint32_t x = 0; x < 6; ++x) {
          add_vertex(x * 0.6 - 1.5, y * 0.6 - 1.5, between(random, -0.4, 0.4));
          if (x == 5 || y == 5) continue;
          const uint32_t corner = y * 6 + x;
          for (const uint32_t index : {corner, corner + 1, corner + 6, corner + 1, corner + 7, corner + 6})
            mesh.indices.push_back(index);
        }
    }
    scene.meshes.push_back(std::move(mesh));
  }
  for (uint32_t i = 0; i < 5; ++i) {
    Instance instance;
    instance.mesh = i % 2;
    instance.material = uint32_t(random() % 2);
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) instance.world_from_object[c][r] = float(between(random, -1, 1) + (c == r ? 0.5 : 0));
    for (int r = 0; r < 3; ++r) instance.world_from_object[3][r] = float(between(random, -2, 2));
    scene.instances.push_back(instance);
  }
  scene.camera.eye = {float(between(random, -1, 1)), float(between(random, -1, 1)), float(between(random, 1, 6))};
  // A perspective of random slant whose elements are floats: x, y and z mixed, w = distance along -z; or orthographic.
  std::array<float, 16> m{};
  const bool perspective = random() % 4 != 0;
  for (size_t c = 0; c < 3; ++c)
    for (size_t r = 0; r < 2; ++r)
      m[4 * c + r] = float(between(random, -0.1, 0.1) + (c == r ? (perspective ? 1.3 : 0.4) : 0));
  const float near = 0.5f, far = 9.0f, eye_z = scene.camera.eye.z;
  m[10] = perspective ? -(far + near) / (far - near) : -2 / (far - near);
  m[14] = perspective ? -2 * far * near / (far - near) - eye_z * m[10] : -(far + near) / (far - near) - eye_z * m[10];
  m[11] = perspective ? -1.0f : 0.0f;
  m[15] = perspective ? eye_z : 1.0f;
  scene.camera.clip_from_world = m;
  return scene;
}

Pipeline random_pipeline(Random& random) {
  Pipeline pipeline = window_pipeline();
  pipeline.width = int(20 + random() % 80);
  pipeline.height = int(20 + random() % 80);
  GeometryState& state = pipeline.geometry;
  if (random() % 2 == 0)
    state.viewport = {int(random() % 60) - 40, int(random() % 60) - 40, int(1 + random() % 150),
                      int(1 + random() % 150)};
  state.depth_near = one_of(random, {0.0f, 0.0f, 0.25f, 1.0f, 0.4f});
  state.depth_far = one_of(random, {1.0f, 1.0f, 0.75f, 0.0f, 0.4f});
  state.depth_func = DepthFunc(random() % 8);
  state.clear_depth = one_of(random, {1.0f, 1.0f, 0.5f, 0.0f});
  state.depth_clamp = random() % 3 == 0;
  state.depth_format = one_of(random, {Format::d32f, Format::d32f, Format::d24, Format::d16});
  if (random() % 3 == 0) {
    state.polygon_offset_factor = one_of(random, {0.0f, 1.0f, -2.0f, 0.375f});
    state.polygon_offset_units = one_of(random, {0.0f, 1.0f, -3.0f, 500.0f, -0.75f});
  }
  state.cull_face = CullFace(random() % 4);
  if (random() % 2 == 0) state.cull_face = CullFace::none;
  state.front_face = FrontFace(random() % 2);
  state.clip_origin = ClipOrigin(random() % 2);
  state.clip_depth = ClipDepth(random() % 2);
  state.provoking = Provoking(random() % 2);
  pipeline.gbuffer.position.interpolation = Interpolation(random() % 3);
  pipeline.gbuffer.normal.interpolation = Interpolation(random() % 3);
  pipeline.gbuffer.albedo.interpolation = Interpolation(random() % 3);
  pipeline.gbuffer.uv.interpolation = Interpolation(random() % 3);
  pipeline.gbuffer.unit_normals = UnitNormals(random() % 3);
  return pipeline;
}

void add_maps(Random& random, Scene& scene) {
  const std::pair<int, int> sizes[] = {{1, 1}, {4, 4}, {7, 3}, {32, 16}, {33, 65}};
  for (int t = 0; t < 3; ++t) {
    const auto [width, height] = sizes[random() % std::size(sizes)];
    Texture texture{"", TextureFormat(random() % 4), {{width, height, {}}}};
    for (int i = 0; i < width * height; ++i) {
      std::array<float, 4> texel;
      for (float& channel : texel) channel = float(between(random, 0, 1));
      append_texel(texture.format, texel, texture.levels[0].bytes);
    }
    build_mip_chain(texture);
    scene.textures.push_back(std::move(texture));
  }
  const auto slot = [&](int texture) {
    TextureSlot out;
    out.texture = texture;
    out.sampler.wrap = {Wrap(random() % std::size(kWrapNames)), Wrap(random() % std::size(kWrapNames))};
    out.sampler.mag_filter = Filter(random() % 2), out.sampler.min_filter = Filter(random() % 2);
    out.sampler.mip_filter = MipFilter(random() % 3);
    out.sampler.lod_bias = float(between(random, -2, 2));
    out.sampler.border = {0.25f, 0.5f, 0.75f, 0.5f};
    return out;
  };
  for (Material& m : scene.materials) {
    m.color_map = slot(0);
    if (random() % 2 == 0) m.alpha_cutoff = float(between(random, 0.05, 0.6));
    if (random() % 2 == 0) m.normal_map = slot(1);
    m.normal_scale = float(between(random, 0, 2));
  }
}

void add_uv_sets(Random& random, Scene& scene) {
  for (Mesh& mesh : scene.meshes) {
    mesh.more_uv.resize(kMaxUvSets - 1);
    for (UvStreams& set : mesh.more_uv)
      for (auto& stream : set)
        for (size_t v = 0; v < mesh.vertex_count(); ++v) stream.push_back(float(between(random, -3, 5)));
  }
  for (Material& m : scene.materials)
    for (TextureSlot* map : maps_of(m)) map->uv_set = uint8_t(random() % kMaxUvSets);
}

void drop_uv_sets(Random& random, Scene& scene) {
  for (Mesh& mesh : scene.meshes) {
    for (UvStreams& set : mesh.more_uv)
      if (random() % 4 == 0) set = {};
    mesh.more_uv.resize(random() % kMaxUvSets);
  }
}

void add_tangents(Random& random, Scene& scene) {
  for (Mesh& mesh : scene.meshes) {
    if (random() % 4 == 0) continue;
    const bool one = random() % 3 == 0;  // a tangent for all vertices
    for (size_t c = 0; c < 4; ++c)
      for (size_t v = 0; v < mesh.vertex_count(); ++v) {
        const float value = c == 3 ? (random() % 2 == 0 ? 1.0f : -1.0f) : float(between(random, -2, 2));
        mesh.tangent[c].push_back(one && v > 0 ? float(mesh.tangent[c][0]) : value);
      }
  }
}

void add_faces(Random& random, Scene& scene) {
  for (Material& m : scene.materials) m.double_sided = random() % 3 != 0;
  for (Instance& i : scene.instances) i.mirrored = random() % 2 == 0;
}

}  // namespace trueshade::testing
