#include "scenes/files/gltf/extras/extras_scene.h"

#include <algorithm>

#include "core/error.h"
#include "scenes/files/gltf/extras/punctual_lights.h"
#include "scenes/files/gltf/meshes.h"
#include "scenes/files/gltf/pictures.h"

namespace trueshade::gltf {
namespace {

class ExtrasSceneMaker {
 public:
  ExtrasSceneMaker(SceneExtras extras, Buffers& buffers, const SceneFolder& folder, const SceneLimits& limits,
                   const ImageDecoder& decode)
      : extras_(std::move(extras)),
        scene_(std::move(extras_.scene)),
        document_(buffers.document()),
        buffers_(buffers),
        limits_(limits),
        accessors_(buffers, limits),
        pictures_(buffers, folder, limits, decode, faults_, decoded_) {}

  Scene make() {
    scene_.spec = document_.file;
    for (size_t i = 0; i < extras_.meshes.size(); ++i) add_mesh(i);
    add_textures();
    for (MaterialExtras& material : extras_.materials) add_material(material);
    for (size_t i = 0; i < extras_.instances.size(); i += 2) {
      const NodeSource& node = document_.nodes[i / 2];
      Instance instance{extras_.instances[i], extras_.instances[i + 1], glm::mat4x3(1.0f)};
      if (node.matrix) instance.world_from_object = glm::mat4x3(*node.matrix);
      scene_.instances.push_back(instance);
    }
    for (const uint32_t mirrored : extras_.mirrored) scene_.instances[mirrored].mirrored = true;
    check_timeline(scene_, document_.file + ": /extras/trueshade");
    add_reaches();
    if (std::string note = note_of_lights(document_, scene_); !note.empty()) scene_.notes.push_back(std::move(note));
    return std::move(scene_);
  }

 private:
  void add_mesh(size_t i) {
    Mesh mesh;
    if (extras_.meshes[i] != kNone) {
      const MeshSource& source = document_.meshes[extras_.meshes[i]];
      const Primitive& primitive = source.primitives[0];
      mesh = read_geometry(accessors_, primitive, {std::min(primitive.attributes.uv.size(), kMaxUvSets), true},
                           pointer_to("meshes", extras_.meshes[i], "primitives", 0))
                 .mesh;
      mesh.name = source.name;
      if (primitive.mode == Mode::points) mesh.indices.clear();
    }
    if (!extras_.uv_sets.empty()) {
      if ((extras_.uv_sets[i] & 1u) == 0) mesh.uv = {};
      for (size_t k = 0; k < mesh.more_uv.size(); ++k)
        if ((extras_.uv_sets[i] >> (k + 1) & 1u) == 0) mesh.more_uv[k] = {};
    }
    if (!extras_.colors.empty() && extras_.colors[i] != kNone)
      for (uint32_t k = 0; k < 4; ++k) mesh.color[k] = accessors_.floats(extras_.colors[i], k);
    scene_.meshes.push_back(std::move(mesh));
  }

  void add_textures() {
    std::vector<int32_t> sources;
    for (const TextureExtras& texture : extras_.textures)
      sources.push_back(texture.levels == Levels::stored
                            ? -1
                            : pictures_.texture(texture.image, texture.format, texture.levels == Levels::filtered));
    pictures_.check();
    pictures_.decode_all([] {});
    for (size_t i = 0; i < extras_.textures.size(); ++i) {
      const TextureExtras& from = extras_.textures[i];
      Texture texture = sources[i] < 0 ? stored(from) : decoded_.textures[size_t(sources[i])];
      if (from.levels == Levels::one) texture.levels.resize(1);
      texture.name = from.name;
      texture.format = from.format;
      scene_.textures.push_back(std::move(texture));
    }
  }

  Texture stored(const TextureExtras& from) {
    Texture texture;
    for (size_t level = 0; level < from.views.size(); ++level) {
      const std::span<const uint8_t> bytes = buffers_.view(from.views[level]);
      stored_bytes_ += bytes.size();
      if (stored_bytes_ > limits_.texture_bytes)
        throw Error(ErrorKind::limit, document_.file + ": /extras/trueshade/textures",
                    "the textures are over the limit",
                    "at most " + std::to_string(limits_.texture_bytes) + " bytes in all");
      texture.levels.push_back({std::max(1, int(from.width) >> level), std::max(1, int(from.height) >> level),
                                std::vector<uint8_t>(bytes.begin(), bytes.end())});
    }
    return texture;  // validate() compares sizes and bytes
  }

  static TextureSlot slot_of(const std::optional<MapExtras>& map) {
    TextureSlot slot;
    if (!map) return slot;
    slot = map->slot;
    slot.texture = int32_t(map->texture);
    slot.uv_set = uint8_t(map->uv_set);
    return slot;
  }

  void add_material(MaterialExtras& from) {
    Material& m = scene_.materials.emplace_back(std::move(from.material));
    m.color_map = slot_of(from.color_map);
    m.specular_map = slot_of(from.specular_map);
    m.normal_map = slot_of(from.normal_map);
    m.metallic_roughness_map = slot_of(from.metallic_roughness_map);
    m.emission_map = slot_of(from.emission_map);
    m.occlusion_map = slot_of(from.occlusion_map);
  }

  void add_reaches() {
    std::vector<std::optional<glm::dvec3>> reaches(scene_.meshes.size());
    const auto reach = [&](uint32_t instance) {
      const uint32_t mesh = scene_.instances[instance].mesh;
      if (!reaches[mesh]) reaches[mesh] = reach_of(scene_.meshes[mesh]);
      return *reaches[mesh];
    };
    for (MovingInstance& moving : scene_.timeline.instances) moving.reach = reach(moving.instance);
    for (NodeInstance& hung : scene_.timeline.node_instances) hung.reach = reach(hung.instance);
  }

  SceneExtras extras_;
  Scene scene_, decoded_;  ///< the second one's textures are those of the document's images
  const Document& document_;
  Buffers& buffers_;
  const SceneLimits& limits_;
  Accessors accessors_;
  Faults faults_{Leniency::refused};  // what this program has written holds none
  Pictures pictures_;
  uint64_t stored_bytes_ = 0;
};

}  // namespace

Scene scene_of_extras(SceneExtras extras, Buffers& buffers, const SceneFolder& folder, const SceneLimits& limits,
                      const ImageDecoder& decode) {
  return ExtrasSceneMaker(std::move(extras), buffers, folder, limits, decode).make();
}

}  // namespace trueshade::gltf
