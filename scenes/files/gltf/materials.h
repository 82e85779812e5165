#pragma once
#include <map>
#include <string>
#include <vector>

#include "scenes/files/gltf/pictures.h"

namespace trueshade::gltf {

/// Adds a document's materials to a scene when they are first asked for, and asks for the pictures that these read. The
/// index of a map's texture coordinates is left to bake_uv().
/// Borrows all it is given.
class Materials {
 public:
  Materials(const Document& document, Pictures& pictures, Faults& faults, Scene& scene)
      : document_(document), pictures_(pictures), faults_(faults), scene_(scene) {}

  /// Index into Scene::materials; kNone stands for glTF's default material.
  uint32_t scene_material(uint32_t index);

  /// Whether a material draws nothing: its alpha cutoff is over 1.
  bool is_invisible(uint32_t index) const;

  /// What the maps of each of the scene's materials read.
  const std::vector<UvSources>& uv_sources() const { return uv_sources_; }

 private:
  void set_map(const TextureInfo& info, TextureFormat format, TextureSlot Material::*map, Material& m);

  const Document& document_;
  Pictures& pictures_;
  Faults& faults_;
  Scene& scene_;
  std::map<uint32_t, uint32_t> materials_;  ///< by index in the document
  std::vector<UvSources> uv_sources_;       ///< by index in the scene
};

}  // namespace trueshade::gltf
