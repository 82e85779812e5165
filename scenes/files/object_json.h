#pragma once
#include <map>
#include <optional>
#include <string>
#include <tuple>

#include "scenes/files/content/scene_files.h"
#include "scenes/files/load_ply.h"
#include "scenes/files/material_json.h"
#include "scenes/files/steps_json.h"
#include "scenes/scene.h"

namespace trueshade {

/// The keys of materials, objects and their parts.
std::span<const json::ObjectKeys> object_json_keys();

/// Adds textures, materials and objects of a scene's text to a scene; each geometry file, generated mesh and colour
/// once.
class ObjectReader {
 public:
  /// `path` of the scene file; geometry is read from its folder.
  ObjectReader(Scene& scene, const std::string& path, const SceneLimits& limits, const ImageDecoder& decode)
      : scene_(scene),
        path_(path),
        folder_(path, limits.named_paths),
        limits_(limits),
        decode_(decode),
        surfaces_(scene, path_, folder_, limits_, decode) {}

  void read_textures(const json::Node& list) { surfaces_.read_textures(list); }
  void read_materials(const json::Node& list);
  void read_objects(const json::Node& list);
  /// After the last object: texels of patterns, and texture coordinates.
  void finish();

 private:
  /// A mesh that an object draws, with the material that its file gives it, if any.
  struct Part {
    uint32_t mesh;
    std::optional<uint32_t> material;
  };

  void check_grids(const json::Node& list) const;
  void read_object(const json::Node& node);
  void add(const Instance& instance, const Placement& copy, std::optional<uint32_t> motion, const ObjectMotion& placed);
  void add_grid(const json::Node& grid, std::vector<Instance> instances, std::optional<uint32_t> motion,
                const ObjectMotion& placed);
  const std::vector<Part>& parts(const json::Node& node);
  std::vector<Part> parts_of_ply(const std::string& file, MissingNormals missing, const std::string& where);
  std::vector<Part> parts_of_models(const std::string& file, MissingNormals missing, const std::string& where);
  const std::vector<Part>& generated_mesh(const json::Node& node);
  uint32_t material(const json::Node& node, const StepReader& steps);
  uint32_t material_of(const glm::vec4& color);
  const glm::dvec3& reach(uint32_t mesh);

  Scene& scene_;
  std::string path_;
  SceneFolder folder_;
  SceneLimits limits_;
  const ImageDecoder& decode_;
  MaterialReader surfaces_;
  std::map<std::tuple<std::string, MissingNormals>, std::vector<Part>> files_;
  std::map<size_t, std::vector<Part>> generated_;
  std::map<std::string, uint32_t, std::less<>> named_;
  std::map<std::tuple<float, float, float, float>, uint32_t> colored_;
  std::map<uint32_t, glm::dvec3> reaches_;
  std::vector<UvSources> uv_sources_;  ///< of materials; those behind the last have no maps
};

}  // namespace trueshade
