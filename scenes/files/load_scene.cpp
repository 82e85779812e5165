#include <algorithm>

#include "core/error.h"
#include "core/file_ending.h"
#include "core/fp_env.h"
#include "core/standard_input.h"
#include "scenes/builtin/builtin.h"
#include "scenes/files/gltf_scene.h"
#include "scenes/files/load_geometry.h"
#include "scenes/files/obj/obj_scene.h"
#include "scenes/files/scene_json.h"
#include "scenes/lights_of_ours.h"
#include "scenes/scene.h"
#include "scenes/scene_defaults.h"

// load_scene() of scenes/scene.h. The function stands here because it knows every format and every built-in scene.
namespace trueshade {
namespace {

Scene scene_of_ply(const Bytes& file, const std::string& name, const SceneLimits& limits) {
  Faults faults(limits.leniency);
  Scene scene;
  scene.meshes.push_back(mesh_from_file(file, name, limits, MissingNormals::smooth, faults));
  scene.materials.push_back({"grey", {0.7f, 0.7f, 0.7f, 1.0f}});
  scene.instances.push_back({});
  faults.tell(scene);
  return scene;
}

/// Geometry alone: seen whole, under lights of ours, on a ground.
Scene shown(Scene scene) {
  scene.is_model = true;
  add_camera_of_ours(scene);
  add_lights_of_ours(scene);
  add_ground(scene);
  return scene;
}

/// A scene without a name, and so without an ending: its first bytes tell the format. Other files that it names lie in
/// the folder of the process.
Scene scene_of_standard_input(const SceneLimits& limits, const ImageDecoder& decode, const SceneParts& parts,
                              const SceneLoader& load) {
  const std::string where(kStandardInput);
  const Bytes bytes = read_standard_input(limits.file_bytes, "--max-file");
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.starts_with("glTF")) return scene_from_gltf(bytes, where, limits, decode, parts);
  if (text.starts_with("ply")) return shown(scene_of_ply(bytes, where, limits));
  if (!text.substr(std::min(text.find_first_not_of(" \t\r\n"), text.size())).starts_with('{'))
    throw Error(ErrorKind::bad_input, where, "its first bytes are neither of JSON nor of glTF, GLB or PLY",
                "send one of these, or name a file");
  if (text.size() > limits.json_bytes)
    throw Error(ErrorKind::limit, where, std::to_string(text.size()) + " bytes are over the limit",
                within_limit(limits.json_bytes, "bytes", "--max-json"));
  const json::Value root = json::parse(text, where);
  return json::Node(root, where).find("asset") ? scene_from_gltf(bytes, where, limits, decode, parts)
                                               : scene_from_json(text, where, limits, decode, load);
}

std::string name_without_folder(const std::string& path) { return path.substr(path.rfind('/') + 1); }  // npos + 1 is 0

enum class References : uint8_t { followed, refused };  ///< of a scene file to another one: one step, no chains

/// Parts that were asked for are those of a list, or camera 0 of a scene that has no list.
void check_parts(const Scene& scene, const SceneParts& parts) {
  if (parts.camera && scene.cameras.empty()) camera_named(*parts.camera, {}, scene.spec);
  if (parts.animation && scene.animations.empty()) animation_named(*parts.animation, {}, scene.spec);
}

Scene loaded_scene(const std::string& spec, const SceneLimits& limits, const ImageDecoder& decode,
                   const SceneParts& parts, References references) {
  constexpr std::string_view kBuiltin = "builtin:";
  Scene scene;
  if (spec.starts_with(kBuiltin)) {
    scene = builtin_scene(std::string_view(spec).substr(kBuiltin.size()), limits);
    check_parts(scene, parts);
    return scene;
  }
  SceneLoader load;
  if (references == References::followed)
    load = [&](const std::string& other) { return loaded_scene(other, limits, decode, parts, References::refused); };
  if (spec == kStandardInputName && references == References::followed) {
    scene = scene_of_standard_input(limits, decode, parts, load);
  } else if (has_ending(spec, ".json")) {
    const Bytes text = read_user_file(spec, limits.json_bytes, "--max-json");
    scene = scene_from_json({reinterpret_cast<const char*>(text.data()), text.size()}, spec, limits, decode, load);
  } else if (is_gltf_name(spec)) {
    scene = scene_from_gltf(read_user_file(spec, limits.file_bytes), spec, limits, decode, parts);
  } else if (is_geometry_name(spec)) {
    scene = shown(scene_of_ply(read_user_file(spec, limits.file_bytes), spec, limits));
  } else if (is_obj_name(spec)) {
    const Bytes file = read_user_file(spec, limits.file_bytes);
    scene = shown(scene_from_obj(file, spec, limits, decode, MissingNormals::creased));
  } else {
    const auto& known = builtin_scenes();
    const std::string name = spec.substr(0, spec.find(','));
    const bool bare = std::any_of(known.begin(), known.end(), [&](const BuiltinInfo& b) { return b.name == name; });
    throw Error(ErrorKind::bad_input, spec, "the ending names no scene or geometry format",
                bare ? "a built-in scene is builtin:" + spec
                     : "builtin:NAME, .json, .gltf, .glb, .obj, .obj.gz, .ply or .ply.gz");
  }
  scene.spec = name_without_folder(spec);
  validate(scene, limits);
  check_parts(scene, parts);
  return scene;
}

}  // namespace

Scene load_scene(const std::string& spec, const SceneLimits& limits, const ImageDecoder& decode,
                 const SceneParts& parts) {
  const FpScope fp;
  return loaded_scene(spec, limits, decode, parts, References::followed);
}

}  // namespace trueshade
