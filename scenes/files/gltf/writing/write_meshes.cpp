#include <algorithm>
#include <bit>

#include "scenes/files/gltf/extras/field_writer.h"
#include "scenes/files/gltf/writing/scene_writer.h"
#include "scenes/json/json_value.h"

namespace trueshade::gltf {
namespace {

/// COLOR_0 holds numbers from 0 to 1.
bool fits_gltf(const Mesh& mesh) {
  for (const FloatStream& stream : mesh.color)
    for (const float x : stream)
      if (!(x >= 0.0f && x <= 1.0f)) return false;
  return true;
}

std::array<FloatStream, 4> clamped(std::array<FloatStream, 4> color) {
  for (FloatStream& stream : color)
    for (float& x : stream) x = std::clamp(x, 0.0f, 1.0f);
  return color;
}

class MeshWriter {
 public:
  explicit MeshWriter(Writing& out) : out_(out), scene_(out.scene) {}

  void write() {
    out_.extras.mesh_count = uint32_t(scene_.meshes.size());
    out_.extras.meshes.assign(scene_.meshes.size(), kNone);
    find_uv_sets();
    primitives_.resize(scene_.meshes.size());
    for (size_t i = 0; i < scene_.meshes.size(); ++i) primitives_[i] = primitive(i);
    for (const Instance& instance : scene_.instances) add_node(instance);
    for (uint32_t i = 0; i < scene_.meshes.size(); ++i)
      if (out_.extras.meshes[i] == kNone && !primitives_[i].empty()) drawing(i, kNone);
  }

 private:
  /// glTF wants the texture coordinates that a material reads; where a mesh has none, zeros stand in for other
  /// programs.
  void find_uv_sets() {
    padding_.assign(scene_.meshes.size(), 0);
    for (const Instance& instance : scene_.instances) {
      const Material& m = scene_.materials[instance.material];
      for (const TextureSlot* map :
           {&m.color_map, &m.normal_map, &m.metallic_roughness_map, &m.emission_map, &m.occlusion_map})
        if (map->used()) padding_[instance.mesh] |= uint8_t(1 << map->uv_set);
    }
    bool any = false;
    std::vector<uint32_t> sets;
    for (size_t i = 0; i < scene_.meshes.size(); ++i) {
      const Mesh& mesh = scene_.meshes[i];
      uint32_t there = 0;
      for (size_t set = 0; set < kMaxUvSets; ++set) there |= uint32_t(!mesh.uv_set(set)[0].empty()) << set;
      sets.push_back(there);
      const uint32_t numbered = std::bit_ceil((there | padding_[i]) + 1) - 1;  // sets are numbered from 0 on
      padding_[i] = uint8_t(numbered & ~there);
      any = any || padding_[i] != 0;
    }
    if (any) out_.extras.uv_sets = std::move(sets);
  }

  /// Attributes and indices of a mesh; nothing for one without vertices.
  std::string primitive(size_t index) {
    const Mesh& mesh = scene_.meshes[index];
    if (mesh.vertex_count() == 0) return {};
    std::string text = "\"attributes\":{\"POSITION\":" + std::to_string(out_.glb.accessor(mesh.position, true)) +
                       ",\"NORMAL\":" + std::to_string(out_.glb.accessor(mesh.normal, false));
    for (size_t set = 0; set < kMaxUvSets; ++set) {
      const UvStreams& streams = mesh.uv_set(set);
      if (streams[0].empty() && (padding_[index] >> set & 1) == 0) continue;
      const uint32_t accessor =
          streams[0].empty() ? out_.glb.zeros(mesh.vertex_count()) : out_.glb.accessor(streams, false);
      text += ",\"TEXCOORD_" + std::to_string(set) + "\":" + std::to_string(accessor);
    }
    if (mesh.has_tangents()) text += ",\"TANGENT\":" + std::to_string(out_.glb.accessor(mesh.tangent, false));
    if (mesh.has_color()) text += ",\"COLOR_0\":" + std::to_string(colors(mesh, index));
    text += '}';
    if (mesh.indices.empty()) return text + ",\"mode\":0";
    return text + ",\"indices\":" + std::to_string(out_.glb.accessor(mesh.indices, mesh.vertex_count()));
  }

  uint32_t colors(const Mesh& mesh, size_t index) {
    if (fits_gltf(mesh)) return out_.glb.accessor(mesh.color, false);
    out_.extras.colors.resize(scene_.meshes.size(), kNone);
    out_.extras.colors[index] = out_.glb.accessor(mesh.color, false);
    return out_.glb.accessor(clamped(mesh.color), false);
  }

  /// The document's mesh that draws a mesh of the scene in a material.
  uint32_t drawing(uint32_t mesh, uint32_t material) {
    const auto [found, is_new] = drawings_.try_emplace({mesh, material}, 0);
    if (!is_new) return found->second;
    std::string text = "{\"primitives\":[{" + primitives_[mesh];
    if (material != kNone) text += ",\"material\":" + std::to_string(material);
    text += "}]";
    if (!scene_.meshes[mesh].name.empty()) json::append_string(text += ",\"name\":", scene_.meshes[mesh].name);
    found->second = out_.glb.add("meshes", text + '}');
    if (out_.extras.meshes[mesh] == kNone) out_.extras.meshes[mesh] = found->second;
    return found->second;
  }

  void add_node(const Instance& instance) {
    std::string text;
    if (!primitives_[instance.mesh].empty())
      text = "\"mesh\":" + std::to_string(drawing(instance.mesh, instance.material));
    const glm::mat4x3& m = instance.world_from_object;
    if (m != glm::mat4x3(1.0f)) {
      std::vector<float> values;
      for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 3; ++row) values.push_back(m[column][row]);
        values.push_back(column == 3 ? 1.0f : 0.0f);
      }
      append_json(text += text.empty() ? "\"matrix\":" : ",\"matrix\":", std::span<const float>(values));
    }
    out_.glb.add("nodes", '{' + text + '}');
    if (instance.mirrored) out_.extras.mirrored.push_back(uint32_t(out_.extras.instances.size() / 2));
    out_.extras.instances.insert(out_.extras.instances.end(), {instance.mesh, instance.material});
  }

  Writing& out_;
  const Scene& scene_;
  std::vector<std::string> primitives_;  ///< JSON but for the material, by mesh
  std::vector<uint8_t> padding_;         ///< a bit for each set of texture coordinates that zeros stand in for
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> drawings_;
};

}  // namespace

void write_meshes(Writing& out) { MeshWriter(out).write(); }

}  // namespace trueshade::gltf
