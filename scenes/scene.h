#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <glm/mat4x3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/image.h"
#include "core/sha256.h"
#include "scenes/camera.h"
#include "scenes/light.h"
#include "scenes/mesh.h"
#include "scenes/scene_limits.h"
#include "scenes/scene_parts.h"
#include "scenes/texture.h"
#include "scenes/timeline.h"

namespace trueshade {

/// What a surface is made of.
struct Material {
  std::string name;
  glm::vec4 base_color{1.0f};  ///< linear RGBA, times the vertex colour
  // What lights beside the albedo; a light model reads the fields it names (scenes/pipeline/light_model.h).
  glm::vec3 specular_color{0.25f};  ///< each in [0, 1e18]
  float shininess = 32.0f;          ///< an integer from 0 to 8192
  glm::vec3 emission{0.0f};         ///< each in [0, 1e18]
  float metallic = 0.0f;            ///< in [0, 1]
  float roughness = 1.0f;           ///< in [0, 1]
  TextureSlot color_map{};          ///< times the colour, alpha too
  TextureSlot specular_map{};       ///< RGB times the specular colour
  TextureSlot normal_map{};         ///< tangent space, (n + 1) / 2
  float normal_scale = 1.0f;        ///< of the map's x and y
  float alpha_cutoff = 0.0f;        ///< fragments with less alpha are not drawn; 0: all are
  bool transparent = false;         ///< drawn as Pipeline::transparency says, its alpha the source's when blended
  // What glTF has beside these.
  TextureSlot metallic_roughness_map{};  ///< G times the roughness, B times metallic; texels at most 1
  TextureSlot emission_map{};            ///< RGB times the emission
  TextureSlot occlusion_map{};           ///< R: the share of ambient light that arrives; texels at most 1
  float occlusion_strength = 1.0f;       ///< in [0, 1]: ambient light is multiplied by 1 + strength (R - 1)
  bool unlit = false;                    ///< shows its colour as it is; no light changes it (KHR_materials_unlit)
  bool double_sided = false;             ///< its back faces are never culled, and lit with their normals turned round

  /// Whether alpha_cutoff is above 0, by bits: a caller's flush-to-zero would take a denormal for 0.
  bool masked() const { return std::bit_cast<int32_t>(alpha_cutoff) > 0; }
  /// Whether any map is used.
  bool textured() const {
    return color_map.used() || specular_map.used() || normal_map.used() || metallic_roughness_map.used() ||
           emission_map.used() || occlusion_map.used();
  }
};

inline constexpr size_t kMaterialMaps = 6;
/// The keys of a material's maps in scene files, and the names of the maps, which are the keys without `_map`.
inline constexpr std::string_view kMaterialMapKeys[kMaterialMaps] = {
    "color_map", "specular_map", "normal_map", "metallic_roughness_map", "emission_map", "occlusion_map"};
/// The name of a map by its index, which is below kMaterialMaps: `color`.
constexpr std::string_view map_name(size_t map) {
  const std::string_view key = kMaterialMapKeys[map];
  return key.substr(0, key.size() - std::string_view("_map").size());
}
/// The maps of a material, in the order of their keys.
template <class M>  // Material, const or not
auto maps_of(M& m) {
  return std::array{&m.color_map,    &m.specular_map, &m.normal_map, &m.metallic_roughness_map,
                    &m.emission_map, &m.occlusion_map};
}

/// glTF's roughness as a Blinn-Phong exponent: 2 / max(roughness, 0.04)^4 - 2 to the nearest integer from 1 to 8192.
float shininess_of_roughness(float roughness);

/// One drawing of a mesh. Geometry is stored once however often it is drawn.
struct Instance {
  uint32_t mesh = 0;                    ///< index into Scene::meshes
  uint32_t material = 0;                ///< index into Scene::materials
  glm::mat4x3 world_from_object{1.0f};  ///< affine: 4 columns of 3
  /// Whether its front faces are those that GeometryState::front_face calls back. Set of a glTF node whose transform
  /// has a negative determinant (glTF 2.0, 3.7.4); other instances are faced as the window shows them.
  bool mirrored = false;
};

/// What scene_hash() makes of a scene's meshes, and of its textures where they have many texels: these arrays, which
/// may lie on disk, need not be read for it again.
struct SceneDigests {
  Sha256 meshes;  ///< fed with all of them
  std::vector<std::string> textures;
};

/// Everything that is drawn, at one time: 0 where it was just loaded. Instances are drawn in order; lights are summed
/// in order.
struct Scene {
  std::string spec;  ///< what the user wrote: `builtin:city,seed=3`, or the file's name without its folder
  std::vector<Mesh> meshes;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<Instance> instances;
  std::vector<Light> lights;
  Camera camera;
  glm::vec4 clear{0.0f};      ///< linear RGBA of the target where nothing is drawn
  std::string pipeline_text;  ///< JSON of the scene file's "pipeline", for pipeline_from_json(); empty if it has none

  Timeline timeline;  ///< what set_time() moves
  double time = 0.0;  ///< seconds: where set_time() has left it

  /// Lights are in candela and lux, and materials of glTF's model: without a preset the pipeline is that of
  /// default_pipeline() in scenes/pipeline/presets.h.
  bool photometric = false;
  bool lights_of_ours = false;  ///< the last kLightsOfOurs lights are ours (scenes/lights_of_ours.h)
  bool is_model = false;        ///< a model file of others: what it lacks may be chosen so that it looks well
  bool camera_of_ours = false;  ///< the file has no camera: that of add_camera_of_ours() stands in, for square pictures
  bool seen_from_inside = false;  ///< that camera stands in the model, which is a room
  bool ground_of_ours = false;  ///< the last instance is the ground of add_ground()
  std::vector<SceneCamera> cameras{};        ///< of a glTF file; empty where its cameras are not the scene's
  std::vector<SceneAnimation> animations{};  ///< of a glTF file
  std::vector<SceneExtension> extensions{};  ///< of a glTF file, in its order
  std::shared_ptr<const SceneDigests>
      digests{};                     ///< null unless meshes and textures lie in a cache file (scene_cache/)
  std::vector<std::string> notes{};  ///< what of its file the scene leaves out, a full sentence without full stop each
  std::vector<std::string>
      passed_over{};  ///< faults of its file, as --lenient asks: it is no reference. Full sentences

  uint64_t triangle_count() const;  ///< over all instances
};

/// Texels of an image file's content: rgba8 or rgba16 as the codes are, rgba16f or rgba32f. Made by who links an image
/// library; scenes does not. `where` stands in errors. Error(limit) for more than `most_bytes`, before they are
/// allocated.
using ImageDecoder =
    std::function<Image(std::span<const uint8_t> content, const std::string& where, uint64_t most_bytes)>;

/// Throws Error(bad_input or limit) unless every index, number and count is in its stated range: finite positions with
/// |x| <= 1e18, colours in [0, 1e18], ranges > 0, unit directions, indices below the vertex count.
void validate(const Scene& scene, const SceneLimits& limits = {});

enum class ErrorKind : int;  // core/error.h
/// The same of a camera alone: finite numbers, angles in (0, pi), 0 < near < far, and a target and an up that leave a
/// direction to the side. `where` and `kind` are the error's.
void validate_camera(const Camera& camera, const std::string& where, ErrorKind kind);

/// Largest |x|, |y|, |z| of a mesh's vertices.
glm::dvec3 reach_of(const Mesh& mesh);

inline constexpr double kLatestTime = 1e6;
/// Moves instances, lights, camera and colours to a time in seconds, |time| <= 1e6, and poses the meshes that deform
/// (Timeline::posed); other meshes stay. The same bits whatever the time was before. Error(usage) for a time out of
/// range, Error(bad_input) where what moves leaves its range.
void set_time(Scene& scene, double time);

/// The number of the frame that is nearest to the scene's time, 0 before the first.
uint32_t frame_at(const Scene& scene);

/// validate() of what set_time() moves. Throws Error(bad_input) with the time.
void validate_moving(const Scene& scene, double time);

/// Reads `builtin:NAME[,key=value...]`, a scene file (.json), glTF (.gltf, .glb), geometry (.obj, .ply, and these with
/// .gz), endings in small letters or capitals, or `-`: standard input without OBJ and .gz; and validates it. glTF
/// without a camera or lights gets them as geometry does. Geometry alone has smooth normals if it has none, creased
/// ones (MissingNormals) if it is an OBJ file. It is grey where it has no material, and gets a camera, lights and a
/// ground of ours. Without `decode` a scene that names an image file is refused. Errors: bad_input with file and place;
/// limit; io for a file that cannot be read; usage for `parts` that the scene has not.
Scene load_scene(const std::string& spec, const SceneLimits& limits = {}, const ImageDecoder& decode = {},
                 const SceneParts& parts = {});

/// The digests of a scene without posed meshes, whose uv sets behind the first are absent.
SceneDigests digests_of(const Scene& scene);

/// SHA-256 over the loaded values (not over file bytes): meshes, materials, textures (decoded texels), instances,
/// lights, camera, clear colour.
std::string scene_hash(const Scene& scene);

}  // namespace trueshade
