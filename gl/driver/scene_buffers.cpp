#include "gl/driver/scene_buffers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "gl/driver/geometry_state.h"
#include "gl/emit/glsl.h"
#include "oracle/matrices.h"

namespace trueshade::oracle {

namespace {

constexpr GLuint kPosition = 0, kNormal = 1, kColor = 2, kUv = 3, kInstance = 4, kIds = 15;  // as in vertex_text()
constexpr size_t kLargeMesh = 3 * 1000;                                                      // indices an instance

/// Vertex attributes of a mesh side by side, as GPUs like them: position, normal, then colour and uv if there are any.
std::vector<float> interleaved(const Mesh& mesh) {
  std::vector<float> out;
  const size_t floats = 6 + (mesh.has_color() ? 4 : 0) + (mesh.has_uv() ? 2 : 0);
  out.reserve(floats * mesh.vertex_count());
  for (size_t v = 0; v < mesh.vertex_count(); ++v) {
    for (const auto& stream : mesh.position) out.push_back(stream[v]);
    for (const auto& stream : mesh.normal) out.push_back(stream.empty() ? 0.0f : stream[v]);
    if (mesh.has_color())
      for (const auto& stream : mesh.color) out.push_back(stream[v]);
    if (mesh.has_uv())
      for (const auto& stream : mesh.uv) out.push_back(stream[v]);
  }
  return out;
}

/// The same triangles, none of which shares a vertex: triangle i has vertices 3 i to 3 i + 2.
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
  out.more_uv.resize(mesh.more_uv.size());
  for (size_t k = 0; k < mesh.more_uv.size(); ++k) copied(mesh.more_uv[k], out.more_uv[k]);
  out.indices.resize(mesh.indices.size());
  std::iota(out.indices.begin(), out.indices.end(), 0u);
  return out;
}

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

/// The frames of all triangles: of the first set, or of each of kMaxUvSets in turn.
std::vector<float> tangents(const Mesh& mesh, bool all_sets) {
  const size_t sets = all_sets ? kMaxUvSets : 1;
  std::vector<float> out(8 * sets * (mesh.indices.size() / 3));
  for (size_t set = 0; set < sets; ++set) add_tangents(mesh, mesh.uv_set(set), 8 * set, 8 * sets, out);
  return out;
}

/// u and v of the sets behind the first, kMaxUvSets - 1 texels a vertex.
std::vector<float> more_uv_texels(const Mesh& mesh) {
  constexpr size_t kFloats = 4 * (kMaxUvSets - 1);
  std::vector<float> out(kFloats * mesh.vertex_count());
  for (size_t set = 1; set < kMaxUvSets; ++set)
    for (size_t v = 0; v < mesh.vertex_count() && !mesh.uv_set(set)[0].empty(); ++v)
      for (size_t k = 0; k < 2; ++k) out[kFloats * v + 4 * (set - 1) + k] = mesh.uv_set(set)[k][v];
  return out;
}

std::vector<uint32_t> rotated(const std::vector<uint32_t>& indices, int rotation) {
  std::vector<uint32_t> out(indices.size());
  for (size_t i = 0; i < indices.size(); ++i) out[i] = indices[i - i % 3 + (i + size_t(rotation)) % 3];
  return out;
}

const void* byte_offset(size_t bytes) { return reinterpret_cast<const void*>(bytes); }

void vertex_attribute(GLuint index, int components, size_t floats, size_t stride_floats) {
  glEnableVertexAttribArray(index);
  glVertexAttribPointer(index, components, GL_FLOAT, GL_FALSE, GLsizei(stride_floats * sizeof(float)),
                        byte_offset(floats * sizeof(float)));
}

/// Points the per-instance attributes at a run's first record. An offset, because GL before 4.2 has no base instance.
void point_at_instances(uint32_t first) {
  const size_t start = size_t(first) * sizeof(InstanceRecord);
  size_t floats = 0;
  GLuint index = kInstance;
  for (const int components : {4, 4, 4, 4, 4, 4, 4, 3, 3, 3, 4}) {
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, components, GL_FLOAT, GL_FALSE, GLsizei(sizeof(InstanceRecord)),
                          byte_offset(start + floats * sizeof(float)));
    glVertexAttribDivisor(index++, 1);
    floats += size_t(components);
  }
  glEnableVertexAttribArray(kIds);
  glVertexAttribIPointer(kIds, 2, GL_UNSIGNED_INT, GLsizei(sizeof(InstanceRecord)),
                         byte_offset(start + InstanceRecord::kFloats * sizeof(float)));
  glVertexAttribDivisor(kIds, 1);
}

}  // namespace

ConeNumbers cone_numbers(const Light& light, Cone cone) {
  if (light.type != LightType::spot || cone == Cone::none) return {};
  const double inner = std::cos(double(light.cone_rad)), outer_rad = double(light.cone_rad + light.penumbra_rad);
  const double outer = std::cos(outer_rad);
  switch (cone) {
    case Cone::none:
      break;
    case Cone::smooth_cutoff:
      return {true, float(outer), float(outer * 0.9 + 0.1)};
    case Cone::smooth_penumbra:
      return {true, float(outer), float(inner)};
    case Cone::exponent:
      return {outer_rad < double(3.14159265f), float(outer), light.spot_exponent};
    case Cone::squared_penumbra: {
      const double scale = 1 / std::max(0.001, inner - outer);
      return {true, float(scale), float(-outer * scale)};
    }
  }
  return {};
}

/// 2 / max(roughness, 0.04)^4 - 2 as the nearest integer from 1 to 8192.
float shininess_of_glossiness(float roughness) {
  const double r = std::max(double(roughness), 0.04);
  return float(std::clamp(std::rint(2 / std::pow(r, 4) - 2), 1.0, 8192.0));
}

std::vector<float> light_records(const Scene& scene, const LightModel& model) {
  const LightLayout layout(model);
  std::vector<float> out;
  out.reserve(4 * size_t(layout.texels()) * scene.lights.size());
  for (const Light& light : scene.lights) {
    const bool directional = light.type == LightType::directional;
    const glm::vec3 place = directional ? -light.direction : light.position;
    const ConeNumbers cone = cone_numbers(light, model.cone);
    const float type = light.type == LightType::ambient ? 0.0f
                       : directional                    ? 1.0f
                       : cone.narrow                    ? 3.0f
                       : light.type == LightType::spot  ? 2.5f
                                                        : 2.0f;
    const glm::vec3 color = light.color * model.damping;
    const auto add = [&](const glm::vec3& v, float w) { out.insert(out.end(), {v.x, v.y, v.z, w}); };
    add(place, type);
    add(color, light.range);
    if (layout.attenuation) add(light.attenuation, 0.0f);
    if (layout.cone) add(light.direction, 0.0f);
    if (layout.cone) add({cone.first, cone.second, 0.0f}, 0.0f);
    if (layout.ambient) add(light.ambient, 0.0f);
  }
  return out;
}

SceneBuffers::SceneBuffers(const Scene& scene, int rotation) : scene_(&scene), maps_(scene) {
  for (const Mesh& mesh : scene.meshes) meshes_.push_back(upload(mesh, rotation));
  for (uint32_t i = 0; i < scene.instances.size(); ++i) {
    const InstanceRun alone = run_of(i);
    has_own_faces_ = has_own_faces_ || alone.double_sided || alone.mirrored;
    const auto joins = [&](const InstanceRun& run) {
      return run.mesh == alone.mesh && run.transparent == alone.transparent && run.double_sided == alone.double_sided &&
             run.mirrored == alone.mirrored && (!maps_.used() || run.material == alone.material);
    };
    if (!runs_.empty() && joins(runs_.back()))
      ++runs_.back().count;
    else
      runs_.push_back(alone);
  }
}

InstanceRun SceneBuffers::run_of(uint32_t instance) const {
  const Instance& i = scene_->instances[instance];
  const Material& m = scene_->materials[i.material];
  return {i.mesh, i.material, instance, 1, m.transparent, m.double_sided, i.mirrored};
}

void SceneBuffers::set_faces_of(const InstanceRun& run) const {
  if (!has_own_faces_) return;
  CullFace culled = culled_;
  if (run.double_sided)
    culled = culled_ == CullFace::none || culled_ == CullFace::back ? CullFace::none : CullFace::front;
  set_faces(culled, run.mirrored == (front_ == FrontFace::ccw) ? FrontFace::cw : FrontFace::ccw);
}

SceneBuffers::MeshBuffers SceneBuffers::upload(const Mesh& shared, int rotation) const {
  MeshBuffers out;
  const Mesh own = maps_.normal() ? unshared(shared) : Mesh{};
  const Mesh& mesh = maps_.normal() ? own : shared;
  if (maps_.normal()) out.tangents = make_texel_buffer(tangents(mesh, maps_.more_uv()));
  if (maps_.more_uv()) out.more_uv = make_texel_buffer(more_uv_texels(mesh));
  out.array = make_vertex_array();
  glBindVertexArray(out.array);
  const size_t stride = 6 + (mesh.has_color() ? 4 : 0) + (mesh.has_uv() ? 2 : 0);
  out.vertices = make_buffer(GL_ARRAY_BUFFER, std::span<const float>(interleaved(mesh)));
  vertex_attribute(kPosition, 3, 0, stride);
  vertex_attribute(kNormal, 3, 3, stride);
  if (mesh.has_color()) vertex_attribute(kColor, 4, 6, stride);
  if (mesh.has_uv()) vertex_attribute(kUv, 2, mesh.has_color() ? 10 : 6, stride);
  const std::vector<uint32_t> turned = rotation == 0 ? std::vector<uint32_t>{} : rotated(mesh.indices, rotation);
  out.indices = make_buffer(GL_ELEMENT_ARRAY_BUFFER, std::span<const uint32_t>(rotation == 0 ? mesh.indices : turned));
  out.index_count = GLsizei(mesh.indices.size());
  return out;
}

bool SceneBuffers::has_vertex_colors() const {
  return std::any_of(scene_->meshes.begin(), scene_->meshes.end(), [](const Mesh& m) { return m.has_color(); });
}

bool SceneBuffers::has_type(LightType type) const {
  return std::any_of(scene_->lights.begin(), scene_->lights.end(), [type](const Light& l) { return l.type == type; });
}

void SceneBuffers::upload_instances(const Pipeline& pipeline) {
  const Matrix4 clip = projection_of(scene_->camera, pipeline.geometry, pipeline.width, pipeline.height);
  culled_ = pipeline.geometry.cull_face, front_ = pipeline.geometry.front_face;
  std::vector<InstanceRecord>& records = records_;
  records.clear();
  records.reserve(scene_->instances.size());
  for (uint32_t i = 0; i < scene_->instances.size(); ++i) {
    const Instance& instance = scene_->instances[i];
    const InstanceRows rows = instance_rows(instance, clip);
    InstanceRecord record{};
    auto next = record.values.begin();
    for (const auto& row : rows.clip) next = std::copy(row.begin(), row.end(), next);
    for (const auto& row : rows.world) next = std::copy(row.begin(), row.end(), next);
    for (const auto& row : rows.normal) next = std::copy(row.begin(), row.end(), next);
    const glm::vec4& base = scene_->materials[instance.material].base_color;
    for (const float channel : {base.r, base.g, base.b, base.a}) *next++ = channel;
    record.ids = {i + 1, instance.material + 1};
    records.push_back(record);
  }
  instances_ = make_buffer(GL_ARRAY_BUFFER, std::span<const InstanceRecord>(records));
}

bool SceneBuffers::has_double_sided() const {
  return std::any_of(runs_.begin(), runs_.end(), [](const InstanceRun& r) { return r.double_sided; });
}

bool SceneBuffers::has_transparent() const {
  return std::any_of(runs_.begin(), runs_.end(), [](const InstanceRun& r) { return r.transparent; });
}

namespace {

GLuint program_in_use() {
  GLint program = 0;
  glGetIntegerv(GL_CURRENT_PROGRAM, &program);
  return GLuint(program);
}

}  // namespace

void SceneBuffers::draw_run(const InstanceRun& run, GLuint program) const {
  constexpr int kTangentUnit = 11;
  constexpr int kMoreUvUnit = 16;  // of vertex shaders alone: fragment shaders are sure of the units below it only
  const MeshBuffers& mesh = meshes_[run.mesh];
  // Constant values of the attributes a mesh may lack.
  glVertexAttrib4f(kColor, 1, 1, 1, 1);
  glVertexAttrib2f(kUv, 0, 0);
  set_faces_of(run);
  if (has_double_sided()) set_uniform(program, "double_sided", int(run.double_sided));
  if (maps_.used()) maps_.bind(program, run.material);
  if (maps_.normal()) bind_texture(program, "tangents", kTangentUnit, GL_TEXTURE_BUFFER, mesh.tangents.texture);
  if (maps_.more_uv()) bind_texture(program, "more_uv", kMoreUvUnit, GL_TEXTURE_BUFFER, mesh.more_uv.texture);
  glBindVertexArray(mesh.array);
  glBindBuffer(GL_ARRAY_BUFFER, instances_);
  point_at_instances(run.first);
  glDrawElementsInstanced(GL_TRIANGLES, mesh.index_count, GL_UNSIGNED_INT, nullptr, GLsizei(run.count));
}

void SceneBuffers::draw_instances(Surfaces which) const {
  const GLuint program = program_in_use();
  for (const InstanceRun& run : runs_)
    if (which == Surfaces::all || run.transparent == (which == Surfaces::transparent)) draw_run(run, program);
}

void SceneBuffers::draw_transparent(uint32_t instance) const { draw_run(run_of(instance), program_in_use()); }

void SceneBuffers::draw_each_instance(GLuint program, Surfaces which) const {
  glVertexAttrib4f(kColor, 1, 1, 1, 1);
  glVertexAttrib2f(kUv, 0, 0);
  const auto place = [&](const char* name) { return glGetUniformLocation(program, name); };
  const GLint clip = place("clip_from_object"), world = place("world_from_object");
  const GLint normal = place("normal_from_object"), base = place("base"), ids = place("instance_ids");
  for (uint32_t i = 0; i < records_.size(); ++i) {
    const Instance& instance = scene_->instances[i];
    const bool transparent = scene_->materials[instance.material].transparent;
    if (which != Surfaces::all && transparent != (which == Surfaces::transparent)) continue;
    const MeshBuffers& mesh = meshes_[instance.mesh];
    set_faces_of(run_of(i));
    if (has_double_sided())
      set_uniform(program, "double_sided", int(scene_->materials[instance.material].double_sided));
    glBindVertexArray(mesh.array);
    const float* values = records_[i].values.data();
    glUniform4fv(clip, 4, values);
    glUniform4fv(world, 3, values + 16);
    glUniform3fv(normal, 3, values + 28);
    glUniform4fv(base, 1, values + 37);
    glUniform2uiv(ids, 1, records_[i].ids.data());
    glDrawElements(GL_TRIANGLES, mesh.index_count, GL_UNSIGNED_INT, nullptr);
  }
}

bool SceneBuffers::has_large_meshes() const {
  size_t indices = 0;
  for (const InstanceRun& run : runs_) indices += size_t(meshes_[run.mesh].index_count) * run.count;
  return indices >= kLargeMesh * scene_->instances.size();
}

GLuint SceneBuffers::light_texels(const LightModel& model) {
  if (!uploaded_ || *uploaded_ != model) {
    lights_ = make_texel_buffer(light_records(*scene_, model));
    uploaded_ = model;
  }
  return lights_.texture;
}

bool SceneBuffers::has_unlit() const {
  return std::any_of(scene_->materials.begin(), scene_->materials.end(), [](const Material& m) { return m.unlit; });
}

GLuint SceneBuffers::material_texels(const Pipeline& pipeline) {
  const LightModel& model = pipeline.light_model;
  if (materials_of_ && materials_of_->light_model == model && materials_of_->transparency == pipeline.transparency)
    return materials_.texture;
  std::vector<float> records;
  const bool glass_in_albedo = pipeline.transparency.mode == TransparencyMode::into_albedo;
  for (const Material& m : scene_->materials) {
    const float shininess = maps_metals(model) ? shininess_of_glossiness(m.roughness) : m.shininess;
    const bool unlit = m.unlit && shows_unlit(model) && !(m.transparent && glass_in_albedo);
    const bool metal_map = m.metallic_roughness_map.used() && !unlit;
    for (const float v :
         {m.specular_color.r, m.specular_color.g, m.specular_color.b, shininess, m.emission.r, m.emission.g,
          m.emission.b, m.metallic, m.roughness, m.occlusion_strength, unlit ? 1.0f : 0.0f, metal_map ? 1.0f : 0.0f})
      records.push_back(v);
  }
  materials_ = make_texel_buffer(records);
  materials_of_ = pipeline;
  return materials_.texture;
}

}  // namespace trueshade::oracle
