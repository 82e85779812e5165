#include "gl/driver/scene_buffers.h"

#include <algorithm>
#include <array>

#include "gl/driver/geometry_state.h"
#include "gl/emit/glsl.h"
#include "gl/emit/light_text.h"

namespace trueshade::oracle {

namespace {

constexpr GLuint kPosition = 0, kNormal = 1, kColor = 2, kUv = 3, kInstance = 4, kIds = 15;  // as in vertex_text()
constexpr size_t kLargeMesh = 3 * 1000;                                                      // indices an instance

std::vector<uint32_t> rotated(std::span<const uint32_t> indices, int rotation) {
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

SceneBuffers::SceneBuffers(const Scene& scene, int rotation)
    : scene_(&scene), maps_(scene), double_sided_(has_double_sided(scene)) {
  for (const Mesh& mesh : scene.meshes) meshes_.push_back(upload(mesh, rotation));
  runs_ = instance_runs(scene, maps_.used());
  has_own_faces_ =
      std::any_of(runs_.begin(), runs_.end(), [](const InstanceRun& r) { return r.double_sided || r.mirrored; });
}

void SceneBuffers::set_faces_of(const InstanceRun& run) const {
  if (!has_own_faces_) return;
  const auto [culled, front] = faces_of(run, faces_);
  set_faces(culled, front);
}

SceneBuffers::MeshBuffers SceneBuffers::upload(const Mesh& shared, int rotation) const {
  MeshBuffers out;
  const Mesh own = maps_.normal() ? unshared(shared) : Mesh{};
  const Mesh& mesh = maps_.normal() ? own : shared;
  if (maps_.normal()) out.tangents = make_texel_buffer(tangent_texels(mesh, maps_.more_uv()));
  if (maps_.vertex_tangents()) out.vertex_tangents = make_texel_buffer(vertex_tangent_texels(mesh));
  if (maps_.more_uv()) out.more_uv = make_texel_buffer(more_uv_texels(mesh));
  out.array = make_vertex_array();
  glBindVertexArray(out.array);
  const size_t stride = 6 + (mesh.has_color() ? 4 : 0) + (mesh.has_uv() ? 2 : 0);
  out.vertices =
      make_buffer(GL_ARRAY_BUFFER, std::span<const float>(interleaved(mesh, mesh.has_color(), mesh.has_uv())));
  vertex_attribute(kPosition, 3, 0, stride);
  vertex_attribute(kNormal, 3, 3, stride);
  if (mesh.has_color()) vertex_attribute(kColor, 4, 6, stride);
  if (mesh.has_uv()) vertex_attribute(kUv, 2, mesh.has_color() ? 10 : 6, stride);
  const std::vector<uint32_t> turned = rotation == 0 ? std::vector<uint32_t>{} : rotated(mesh.indices, rotation);
  out.indices = make_buffer(GL_ELEMENT_ARRAY_BUFFER, rotation == 0 ? std::span<const uint32_t>(mesh.indices) : turned);
  out.index_count = GLsizei(mesh.indices.size());
  return out;
}

bool SceneBuffers::has_vertex_colors() const {
  return std::any_of(scene_->meshes.begin(), scene_->meshes.end(), [](const Mesh& m) { return m.has_color(); });
}

uint32_t SceneBuffers::light_types() const {
  uint32_t types = 0;
  for (const Light& light : scene_->lights) types |= 1u << uint32_t(light.type);
  return types;
}

void SceneBuffers::upload_instances(const Pipeline& pipeline) {
  faces_ = pipeline.geometry;
  records_ = instance_records(*scene_, pipeline);
  instances_ = make_buffer(GL_ARRAY_BUFFER, std::span<const InstanceRecord>(records_));
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
  // Of vertex shaders alone: fragment shaders are sure of the units below 16 only.
  constexpr int kMoreUvUnit = 16, kVertexTangentUnit = 20;
  const MeshBuffers& mesh = meshes_[run.mesh];
  // Constant values of the attributes a mesh may lack.
  glVertexAttrib4f(kColor, 1, 1, 1, 1);
  glVertexAttrib2f(kUv, 0, 0);
  set_faces_of(run);
  if (double_sided_) set_uniform(program, "double_sided", int(run.double_sided));
  if (maps_.used()) maps_.bind(program, run.material);
  if (maps_.normal()) bind_texture(program, "tangents", kTangentUnit, GL_TEXTURE_BUFFER, mesh.tangents.texture);
  if (maps_.vertex_tangents())
    bind_texture(program, "vertex_tangents", kVertexTangentUnit, GL_TEXTURE_BUFFER, mesh.vertex_tangents.texture);
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

void SceneBuffers::draw_transparent(uint32_t instance) const { draw_run(run_of(*scene_, instance), program_in_use()); }

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
    set_faces_of(run_of(*scene_, i));
    if (double_sided_) set_uniform(program, "double_sided", int(scene_->materials[instance.material].double_sided));
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

GLuint SceneBuffers::light_texels(const Pipeline& pipeline) {
  if (lights_of_ && lights_of_->light_model == pipeline.light_model &&
      lights_of_->light_program == pipeline.light_program)
    return lights_.texture;
  lights_ = make_texel_buffer(light_records(scene_->lights, oracle::light_texels(pipeline)));
  lights_of_ = pipeline;
  return lights_.texture;
}

GLuint SceneBuffers::material_texels(const Pipeline& pipeline) {
  const LightModel& model = pipeline.light_model;
  if (materials_of_ && materials_of_->light_model == model && materials_of_->transparency == pipeline.transparency &&
      materials_of_->light_program.used() == pipeline.light_program.used())
    return materials_.texture;
  materials_ = make_texel_buffer(material_records(*scene_, pipeline));
  materials_of_ = pipeline;
  return materials_.texture;
}

}  // namespace trueshade::oracle
