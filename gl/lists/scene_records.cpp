#include "gl/lists/scene_records.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "gl/emit/light_text.h"
#include "oracle/matrices.h"
#include "scenes/pipeline/transparency.h"

namespace trueshade::oracle {

namespace {

/// Of each triangle of unshared() where u and where v of a set grow, unit vectors in the object; zero where uv has no
/// area. The first is put at `first`, each triangle's `stride` floats behind the last.
void add_tangents(const Mesh& mesh, const UvStreams& uv, size_t first, size_t stride, std::vector<float>& out) {
  for (size_t i = 0; !uv[0].empty() && i < mesh.indices.size(); i += 3) {
    const auto edge = [&](size_t k, int c) {
      return double(mesh.position[size_t(c)][i + k]) - double(mesh.position[size_t(c)][i]);
    };
    const double a1 = double(uv[0][i + 1]) - double(uv[0][i]), b1 = double(uv[1][i + 1]) - double(uv[1][i]);
    const double a2 = double(uv[0][i + 2]) - double(uv[0][i]), b2 = double(uv[1][i + 2]) - double(uv[1][i]);
    const double area = a1 * b2 - a2 * b1, sign = area < 0 ? -1 : 1;
    glm::dvec3 u(0.0), v(0.0);
    for (int c = 0; c < 3 && area != 0; ++c) {
      u[c] = sign * (edge(1, c) * b2 - edge(2, c) * b1);
      v[c] = sign * (edge(2, c) * a1 - edge(1, c) * a2);
    }
    for (glm::dvec3* axis : {&u, &v})
      if (const double length = std::hypot(axis->x, axis->y, axis->z); length > 0) *axis /= length;
    for (int c = 0; c < 3; ++c) {
      out[stride * (i / 3) + first + size_t(c)] = float(u[c]);
      out[stride * (i / 3) + first + 4 + size_t(c)] = float(v[c]);
    }
  }
}

/// 2 / max(roughness, 0.04)^4 - 2 as the nearest integer from 1 to 8192.
float shininess_of_glossiness(float roughness) {
  const double r = std::max(double(roughness), 0.04);
  return float(std::clamp(std::rint(2 / std::pow(r, 4) - 2), 1.0, 8192.0));
}

template <typename Has>
bool any_material(const Scene& scene, const Has& has) {
  return std::any_of(scene.materials.begin(), scene.materials.end(), has);
}

template <typename Has>
bool any_instance(const Scene& scene, const Has& has) {
  return std::any_of(scene.instances.begin(), scene.instances.end(),
                     [&](const Instance& i) { return has(scene.materials[i.material]); });
}

}  // namespace

std::vector<InstanceRecord> instance_records(const Scene& scene, const Pipeline& pipeline) {
  const Matrix4 clip = projection_of(scene.camera, pipeline.geometry, pipeline.width, pipeline.height);
  std::vector<InstanceRecord> records;
  records.reserve(scene.instances.size());
  for (uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const InstanceRows rows = instance_rows(instance, clip);
    InstanceRecord record{};
    auto next = record.values.begin();
    for (const auto& row : rows.clip) next = std::copy(row.begin(), row.end(), next);
    for (const auto& row : rows.world) next = std::copy(row.begin(), row.end(), next);
    for (const auto& row : rows.normal) next = std::copy(row.begin(), row.end(), next);
    const glm::vec4& base = scene.materials[instance.material].base_color;
    for (const float channel : {base.r, base.g, base.b, base.a}) *next++ = channel;
    record.ids = {i + 1, instance.material + 1};
    records.push_back(record);
  }
  return records;
}

InstanceRun run_of(const Scene& scene, uint32_t instance) {
  const Instance& i = scene.instances[instance];
  const Material& m = scene.materials[i.material];
  return {i.mesh, i.material, instance, 1, m.transparent, m.double_sided, i.mirrored};
}

std::vector<InstanceRun> instance_runs(const Scene& scene, bool by_material) {
  std::vector<InstanceRun> runs;
  for (uint32_t i = 0; i < scene.instances.size(); ++i) {
    const InstanceRun alone = run_of(scene, i);
    const auto joins = [&](const InstanceRun& run) {
      return run.mesh == alone.mesh && run.transparent == alone.transparent && run.double_sided == alone.double_sided &&
             run.mirrored == alone.mirrored && (!by_material || run.material == alone.material);
    };
    if (!runs.empty() && joins(runs.back()))
      ++runs.back().count;
    else
      runs.push_back(alone);
  }
  return runs;
}

std::pair<CullFace, FrontFace> faces_of(const InstanceRun& run, const GeometryState& state) {
  CullFace culled = state.cull_face;
  if (run.double_sided)
    culled = culled == CullFace::none || culled == CullFace::back ? CullFace::none : CullFace::front;
  return {culled, run.mirrored == (state.front_face == FrontFace::ccw) ? FrontFace::cw : FrontFace::ccw};
}

std::vector<float> interleaved(const Mesh& mesh, bool color, bool uv) {
  std::vector<float> out;
  out.reserve((6 + (color ? 4 : 0) + (uv ? 2 : 0)) * mesh.vertex_count());
  for (size_t v = 0; v < mesh.vertex_count(); ++v) {
    for (const auto& stream : mesh.position) out.push_back(stream[v]);
    for (const auto& stream : mesh.normal) out.push_back(stream.empty() ? 0.0f : stream[v]);
    for (size_t c = 0; color && c < 4; ++c) out.push_back(mesh.has_color() ? mesh.color[c][v] : 1.0f);
    for (size_t c = 0; uv && c < 2; ++c) out.push_back(mesh.has_uv() ? mesh.uv[c][v] : 0.0f);
  }
  return out;
}

Mesh unshared(const Mesh& mesh) {
  Mesh out;
  const auto copied = [&mesh](const auto& streams, auto& to) {
    for (size_t c = 0; c < streams.size(); ++c)
      for (size_t i = 0; i < mesh.indices.size() && !streams[c].empty(); ++i)
        to[c].push_back(streams[c][mesh.indices[i]]);
  };
  copied(mesh.position, out.position);
  copied(mesh.normal, out.normal);
  copied(mesh.color, out.color);
  copied(mesh.uv, out.uv);
  copied(mesh.tangent, out.tangent);
  out.more_uv.resize(mesh.more_uv.size());
  for (size_t k = 0; k < mesh.more_uv.size(); ++k) copied(mesh.more_uv[k], out.more_uv[k]);
  out.indices.resize(mesh.indices.size());
  std::iota(out.indices.begin(), out.indices.end(), 0u);
  return out;
}

std::vector<float> tangent_texels(const Mesh& mesh, bool all_sets) {
  const size_t sets = all_sets ? kMaxUvSets : 1;
  std::vector<float> out(8 * sets * (mesh.indices.size() / 3));
  for (size_t set = 0; set < sets; ++set) add_tangents(mesh, mesh.uv_set(set), 8 * set, 8 * sets, out);
  return out;
}

std::vector<float> vertex_tangent_texels(const Mesh& mesh) {
  std::vector<float> out(4 * mesh.vertex_count());
  for (size_t v = 0; v < mesh.vertex_count() && mesh.has_tangents(); ++v) {
    for (size_t c = 0; c < 3; ++c) out[4 * v + c] = mesh.tangent[c][v];
    const FloatStream& side = mesh.tangent[3];
    const size_t first = v - v % 3;
    out[4 * v + 3] = side[first] + side[first + 1] + side[first + 2] < 0 ? -1.0f : 1.0f;
  }
  return out;
}

std::vector<float> more_uv_texels(const Mesh& mesh) {
  constexpr size_t kFloats = 4 * (kMaxUvSets - 1);
  std::vector<float> out(kFloats * mesh.vertex_count());
  for (size_t set = 1; set < kMaxUvSets; ++set)
    for (size_t v = 0; v < mesh.vertex_count() && !mesh.uv_set(set)[0].empty(); ++v)
      for (size_t k = 0; k < 2; ++k) out[kFloats * v + 4 * (set - 1) + k] = mesh.uv_set(set)[k][v];
  return out;
}

std::vector<float> material_records(const Scene& scene, const Pipeline& pipeline) {
  const LightModel& model = pipeline.light_model;
  std::vector<float> records;
  const bool glass_in_albedo = pipeline.transparency.mode == TransparencyMode::into_albedo;
  for (const Material& m : scene.materials) {
    const float shininess = maps_metals(model) ? shininess_of_glossiness(m.roughness) : m.shininess;
    const bool unlit =
        m.unlit && (pipeline.light_program.used() || (shows_unlit(model) && !(m.transparent && glass_in_albedo)));
    const bool metal_map = m.metallic_roughness_map.used() && !unlit;
    for (const float v :
         {m.specular_color.r, m.specular_color.g, m.specular_color.b, shininess, m.emission.r, m.emission.g,
          m.emission.b, m.metallic, m.roughness, m.occlusion_strength, unlit ? 1.0f : 0.0f, metal_map ? 1.0f : 0.0f})
      records.push_back(v);
  }
  return records;
}

bool has_double_sided(const Scene& scene) {
  return any_instance(scene, [](const Material& m) { return m.double_sided; });
}

bool has_transparent(const Scene& scene) {
  return any_instance(scene, [](const Material& m) { return m.transparent; });
}

bool reads_more_uv(const Scene& scene) {
  return any_material(scene, [](const Material& m) {
    const auto maps = maps_of(m);
    return std::any_of(maps.begin(), maps.end(), [](const TextureSlot* map) { return map->used() && map->uv_set > 0; });
  });
}

bool reads_tangents(const Scene& scene) {
  return any_material(scene, [](const Material& m) { return m.normal_map.used(); }) &&
         std::any_of(scene.meshes.begin(), scene.meshes.end(), [](const Mesh& m) { return m.has_tangents(); });
}

GlslOptions scene_options(const Scene& scene) {
  GlslOptions options;
  const auto has = [&](const TextureSlot Material::*map) {
    return any_material(scene, [map](const Material& m) { return (m.*map).used(); });
  };
  options.maps = any_material(scene, [](const Material& m) { return m.textured() || m.masked(); });
  options.specular_maps = has(&Material::specular_map);
  options.normal_maps = has(&Material::normal_map);
  options.vertex_tangents = reads_tangents(scene);
  options.metal_maps = has(&Material::metallic_roughness_map);
  options.emission_maps = has(&Material::emission_map);
  options.occlusion_maps = has(&Material::occlusion_map);
  options.more_uv = reads_more_uv(scene);
  options.double_sided = has_double_sided(scene);
  options.unlit = any_material(scene, [](const Material& m) { return m.unlit; });
  options.transparent = has_transparent(scene);
  for (const Light& light : scene.lights) options.light_types |= 1u << uint32_t(light.type);
  return options;
}

}  // namespace trueshade::oracle
