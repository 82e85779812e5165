#include "cli/resolved_scene.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "cli/json_text.h"
#include "cli/notes.h"
#include "raster/view.h"
#include "scenes/files/content/faults.h"
#include "scenes/light_fields.h"
#include "scenes/material_fields.h"
#include "scenes/pipeline/light_mesh.h"
#include "shading/light/light_table.h"

namespace trueshade {
namespace {

template <typename Vector>
std::string json_of_vector(const Vector& v) {
  std::array<float, size_t(Vector::length())> values;
  for (size_t i = 0; i < values.size(); ++i) values[i] = v[int(i)];
  return json_of_floats(values);
}

void put_numbers(JsonObject& json, std::string_view key, float value) { json.put_raw(key, json_of_float(value)); }
template <typename Vector>
void put_numbers(JsonObject& json, std::string_view key, const Vector& value) {
  json.put_raw(key, json_of_vector(value));
}

/// Rows of a matrix, whose elements lie row after row.
std::string json_of_rows(const float* elements, size_t rows, size_t columns) {
  JsonArray out;
  for (size_t r = 0; r < rows; ++r) out.add_raw(json_of_floats({elements + r * columns, columns}));
  return out.text();
}

std::string json_of_doubles(std::span<const double> values) {
  JsonArray out;
  // A reader of JSON may take -0 for an integer, which has no sign.
  for (const double value : values) out.add_raw(value == 0.0 && std::signbit(value) ? "-0.0" : json_number(value));
  return out.text();
}

std::string json_of_indices(std::span<const uint32_t> values) {
  JsonArray out;
  for (const uint32_t value : values) out.add_raw(json_number(uint64_t(value)));
  return out.text();
}

/// Members of a document, one a line, whose values are arrays with an item a line.
class Document {
 public:
  void add(std::string_view key, std::string_view json) {
    text_ += (text_.empty() ? "{\n  " : ",\n  ") + json_string(key) + ": ";
    text_ += json;
  }
  /// `item(i)` is JSON.
  template <typename Item>
  void add_list(std::string_view key, size_t count, const Item& item) {
    add(key, "[");
    for (size_t i = 0; i < count; ++i) {
      text_ += i == 0 ? "\n    " : ",\n    ";
      text_ += item(i);
      if (text_.size() >= kPieceBytes) cut();
    }
    text_ += count == 0 ? "]" : "\n  ]";
  }
  std::vector<std::string> finished() {
    text_ += "\n}\n";
    cut();
    return std::move(pieces_);
  }

 private:
  static constexpr size_t kPieceBytes = size_t(1) << 20;
  void cut() {
    pieces_.push_back(std::move(text_));
    text_ = std::string();
  }
  std::string text_;
  std::vector<std::string> pieces_;
};

// --- Camera and objects --------------------------------------------------------------------------------------------

std::string viewport_json(const WindowTransform& window) {
  const int64_t width = window.scale[0] / 128, height = (window.upper_left ? -1 : 1) * window.scale[1] / 128;
  return JsonObject()
      .put_raw("x", std::to_string((window.offset[0] - 128 * width) / 256))
      .put_raw("y", std::to_string((window.offset[1] - 128 * height) / 256))
      .put_raw("width", std::to_string(width))
      .put_raw("height", std::to_string(height))
      .text();
}

std::string camera_json(const Scene& scene, const Pipeline& pipeline, const View& view) {
  const double width = double(view.window.scale[0]),
               height = double(view.window.upper_left ? -view.window.scale[1] : view.window.scale[1]);
  const Camera& camera = scene.camera;
  const Matrix4 clip = clip_from_world(camera, width / height, clip_range(pipeline.geometry));
  JsonArray rows;
  for (size_t r = 0; r < 4; ++r)
    rows.add_raw(json_of_doubles(std::array{clip[r], clip[4 + r], clip[8 + r], clip[12 + r]}));
  const bool ours = !camera.clip_from_world.has_value();
  const auto of_ours = [ours](const std::string& json) { return ours ? json : std::string("null"); };
  const bool by_width = camera.fov_x_rad.has_value();
  return JsonObject()
      .put_raw("eye", json_of_vector(camera.eye))
      .put_raw("target", of_ours(json_of_vector(camera.target)))
      .put_raw("up", of_ours(json_of_vector(camera.up)))
      .put_raw("fov_x_rad", by_width ? of_ours(json_of_float(*camera.fov_x_rad)) : "null")
      .put_raw("fov_y_rad", by_width ? "null" : of_ours(json_of_float(camera.fov_y_rad)))
      .put_raw("near", of_ours(json_of_float(camera.near)))
      .put_raw("far", of_ours(json_of_float(camera.far)))
      .put_raw("view_axis", json_of_vector(view_axis(camera)))
      .put_raw("clip_from_world", rows.text())
      .put_raw("clip_from_world_float", json_of_rows(view.clip_from_world.data(), 4, 4))
      .put_raw("world_from_clip", json_of_rows(view.world_from_clip.data(), 4, 4))
      .text();
}

std::string object_json(const Instance& instance, const InstanceTransform& transform) {
  return JsonObject()
      .put("mesh", uint64_t(instance.mesh))
      .put("material", uint64_t(instance.material))
      .put("mirrored", instance.mirrored)
      .put_raw("world_from_object", json_of_rows(transform.world[0], 3, 4))
      .put_raw("clip_from_object", json_of_rows(transform.clip[0], 4, 4))
      .put_raw("normal_from_object", json_of_rows(transform.normal[0], 3, 3))
      .text();
}

std::string mesh_json(const Mesh& mesh, ResolvedArrays& arrays) {
  const auto optional = [&](std::span<const FloatStream> streams) {
    return streams[0].empty() ? std::string("null") : arrays.streams(streams);
  };
  JsonObject json;
  json.put("name", mesh.name);
  json.put_raw("position", arrays.streams(mesh.position)).put_raw("normal", optional(mesh.normal));
  json.put_raw("color", optional(mesh.color)).put_raw("tangent", optional(mesh.tangent));
  JsonArray sets;
  sets.add_raw(optional(mesh.uv));
  for (const UvStreams& set : mesh.more_uv) sets.add_raw(optional(set));
  return json.put_raw("uv", sets.text()).put_raw("triangles", arrays.triangles(mesh.indices)).text();
}

// --- Materials -----------------------------------------------------------------------------------------------------

std::string map_json(const TextureSlot& slot) {
  if (!slot.used()) return "null";
  const Sampler& s = slot.sampler;
  JsonArray wrap;
  for (const Wrap w : s.wrap) wrap.add_raw(json_string(kWrapNames[size_t(w)]));
  return JsonObject()
      .put("texture", int(slot.texture))
      .put("uv_set", int(slot.uv_set))
      .put_raw("wrap", wrap.text())
      .put("mag_filter", kFilterNames[size_t(s.mag_filter)])
      .put("min_filter", kFilterNames[size_t(s.min_filter)])
      .put("mip_filter", kMipFilterNames[size_t(s.mip_filter)])
      .put_raw("lod_bias", json_of_float(s.lod_bias))
      .put_raw("lod_min", json_of_float(s.lod_min))
      .put_raw("lod_max", json_of_float(s.lod_max))
      .put_raw("border", json_of_vector(s.border))
      .text();
}

std::string material_json(const Material& m) {
  JsonObject json, maps;
  const auto slots = maps_of(m);
  for (size_t i = 0; i < kMaterialMaps; ++i) maps.put_raw(map_name(i), map_json(*slots[i]));
  json.put("name", m.name);
  visit_fields(m, [&]<typename T>(const MaterialField& row, const T& value) {
    if constexpr (std::is_same_v<T, bool>)
      json.put(row.member, value);
    else
      put_numbers(json, row.member, value);
  });
  return json.put_raw("maps", maps.text()).text();
}

std::string texture_json(const Texture& texture, ResolvedArrays& arrays) {
  JsonArray levels;
  for (const TextureLevel& level : texture.levels)
    levels.add_raw(arrays.texels(level.bytes, level.width, level.height, bytes_per_texel(texture.format) / 4));
  return JsonObject()
      .put("name", texture.name)
      .put("format", kTextureFormatNames[size_t(texture.format)])
      .put_raw("levels", levels.text())
      .text();
}

// --- Lights --------------------------------------------------------------------------------------------------------

/// What the light model makes of the light: section 8 of docs/arithmetic.md names the numbers of cones.
std::string light_in_model_json(const LightRow& row, const LightModel& model) {
  JsonObject json;
  json.put_raw("color", json_of_floats(row.color));
  if (row.kind != LightKind::coned) return json.put_raw("cone", "null").text();
  JsonObject cone;
  const auto put = [&](const char* key, float value) { cone.put_raw(key, json_of_float(value)); };
  if (model.cone == Cone::smooth_cutoff || model.cone == Cone::smooth_penumbra)
    put("e0", row.edge), put("one_over_e1_minus_e0", row.slope);
  if (model.cone == Cone::exponent) put("e0", row.edge);
  if (model.cone == Cone::squared_penumbra) put("offset", row.edge), put("scale", row.slope);
  return json.put_raw("cone", cone.text()).text();
}

std::string light_json(const Light& light, const LightRow& row, const Pipeline& pipeline, const LightMeshes& meshes,
                       ResolvedArrays& arrays) {
  const LightExtent extent = drawn_extent(light, pipeline.light_volumes);
  JsonObject json;
  json.put("type", name_of(light.type));
  visit_members(light, [&](const LightField& field, const auto& value) {
    if (field.hash == LightHash::area && !has_area(light.type)) return;
    put_numbers(json, field.member, value);
  });
  json.put_raw("in_model", light_in_model_json(row, pipeline.light_model)).put("extent", name_of(extent));
  if (pipeline.strategy != Strategy::deferred_volumes || !is_mesh(extent)) return json.text();
  std::vector<glm::vec3> vertices(meshes[extent].unit.size());
  light_vertices(meshes[extent], light, vertices);
  return json.put_raw("vertices", arrays.points(std::move(vertices))).text();
}

std::string light_mesh_json(const LightMesh& mesh) {
  JsonArray unit, triangles;
  for (const glm::dvec3& u : mesh.unit) unit.add_raw(json_of_doubles(std::array{u.x, u.y, u.z}));
  for (size_t i = 0; i < mesh.indices.size(); i += 3)
    triangles.add_raw(json_of_indices(std::span(mesh.indices).subspan(i, 3)));
  return JsonObject().put_raw("unit_vertices", unit.text()).put_raw("triangles", triangles.text()).text();
}

std::string light_meshes_json(const LightMeshes& meshes) {
  JsonObject json;
  for (const LightExtent extent : kMeshExtents) json.put_raw(name_of(extent), light_mesh_json(meshes[extent]));
  return json.text();
}

}  // namespace

ResolvedNumbers resolved_numbers(const Scene& scene, const Pipeline& pipeline) {
  ResolvedNumbers numbers;
  for (const Mesh& mesh : scene.meshes) {
    const uint64_t optional = (mesh.has_color() ? 4 : 0) + (mesh.has_tangents() ? 4 : 0);
    const uint64_t streams = 6 + optional + 2 * (1 + mesh.more_uv.size());
    numbers.of_scene += streams * mesh.vertex_count() + mesh.indices.size();
  }
  for (const Texture& texture : scene.textures)
    for (const TextureLevel& level : texture.levels)
      numbers.of_scene += 4 * uint64_t(level.width) * uint64_t(level.height);
  if (pipeline.strategy != Strategy::deferred_volumes) return numbers;
  const LightMeshes meshes(pipeline.light_volumes);
  for (const Light& light : scene.lights)
    if (const LightExtent extent = drawn_extent(light, pipeline.light_volumes); is_mesh(extent))
      numbers.of_lights += 3 * meshes[extent].unit.size();
  return numbers;
}

uint64_t resolved_text_bytes(const Scene& scene) {
  constexpr uint64_t kLight = 1024, kObject = 1024, kOther = 4096;  // of floats of 16 characters at most
  return kLight * scene.lights.size() + kObject * scene.instances.size() +
         kOther * (scene.meshes.size() + scene.materials.size() + scene.textures.size() + 256);
}

std::vector<std::string> resolved_text(const Scene& scene, const Pipeline& pipeline, double time,
                                       const std::string& file, ResolvedArrays& arrays) {
  const View view = make_view(scene, pipeline);
  const LightTable lights = make_light_table(scene.lights, pipeline.light_model, scene.camera);
  const LightMeshes meshes(pipeline.light_volumes);
  Document out;
  out.add("version", "1");
  out.add("scene", json_string(scene.spec));
  out.add("hash", json_string("sha256:" + scene_hash(scene)));
  if (const std::string text = lenient_text(scene); !text.empty()) out.add("lenient", json_string(text));
  out.add("time", json_number(time));
  out.add("file", file.empty() ? "null" : json_string(file));
  out.add("pipeline", pipeline_json(pipeline));
  out.add("viewport", viewport_json(view.window));
  out.add("camera", camera_json(scene, pipeline, view));
  out.add("clear", json_of_vector(scene.clear));
  out.add_list("objects", scene.instances.size(),
               [&](size_t i) { return object_json(scene.instances[i], view.instances[i]); });
  out.add_list("materials", scene.materials.size(), [&](size_t i) { return material_json(scene.materials[i]); });
  out.add_list("textures", scene.textures.size(), [&](size_t i) { return texture_json(scene.textures[i], arrays); });
  out.add_list("meshes", scene.meshes.size(), [&](size_t i) { return mesh_json(scene.meshes[i], arrays); });
  out.add_list("lights", scene.lights.size(),
               [&](size_t i) { return light_json(scene.lights[i], lights.row[i], pipeline, meshes, arrays); });
  if (pipeline.strategy == Strategy::deferred_volumes) out.add("light_meshes", light_meshes_json(meshes));
  return out.finished();
}

}  // namespace trueshade
