#pragma once
#include <optional>
#include <string>
#include <vector>

#include "scenes/files/gltf/document.h"
#include "scenes/scene.h"

namespace trueshade::gltf {

inline constexpr uint32_t kExtrasVersion = 1;
inline constexpr std::string_view kExtrasName = "trueshade";

struct MapExtras {
  uint32_t texture = kNone;  ///< into SceneExtras::textures
  uint32_t uv_set = 0;
  TextureSlot slot;  ///< its sampler and transform alone
};

struct MaterialExtras {
  Material material;  ///< but for its maps
  std::optional<MapExtras> color_map, specular_map, normal_map, metallic_roughness_map, emission_map, occlusion_map;
};

/// Where the levels of a texture come from.
enum class Levels : uint8_t {
  one,       ///< the first is `image`, and there is no other
  filtered,  ///< the first is `image`, the others those of build_mip_chain()
  stored,    ///< each is a view of its bytes
};

struct TextureExtras {
  std::string name;
  TextureFormat format = TextureFormat::srgb8_a8;
  Levels levels = Levels::filtered;
  uint32_t image = kNone;                  ///< into Document::images; not read where levels are stored
  uint32_t width = kNone, height = kNone;  ///< of the first level, where levels are stored
  std::vector<uint32_t> views;             ///< into Document::views, one a stored level
};

struct NodeExtras {
  uint32_t parent = kNone;
  SceneNode node;
};

/// What `extras.trueshade` of a document's root holds. All of a scene is in it, but for what the document has as well:
/// vertices and indices, texels of 8 bits, and where instances stand, which are the document's first nodes.
struct SceneExtras {
  uint32_t version = 0;
  Scene scene;  ///< clear colour, camera, lights, timeline, pipeline; no meshes, materials, textures, instances
  std::vector<MaterialExtras> materials;
  std::vector<TextureExtras> textures;
  uint32_t mesh_count = 0;
  std::vector<uint32_t> meshes;     ///< of each mesh of the scene, the document's mesh; kNone: it has no vertices
  std::vector<uint32_t> instances;  ///< mesh and material of each instance
  std::vector<uint32_t> colors;  ///< of each mesh, an accessor of its colours where glTF has no room for them, or kNone
  std::vector<uint32_t> mirrored;  ///< instances whose front is the other face
  std::vector<uint32_t> uv_sets;   ///< of each mesh, a bit a set of texture coordinates that it has
  std::vector<NodeExtras> nodes;   ///< of the timeline
};

/// Reads and checks the member: keys, types, and that all indices are in range. Empty where the document has none.
/// Error(bad_input) with a JSON pointer; Error(limit) for lists over limits.geometry_bytes.
std::optional<SceneExtras> read_extras(const Document& document, const SceneLimits& limits);

/// Checks what set_time() relies on: indices, steps, parents before their children. Error(bad_input) behind `where`.
void check_timeline(const Scene& scene, const std::string& where);

/// The member as JSON.
std::string extras_text(const SceneExtras& extras);

}  // namespace trueshade::gltf
