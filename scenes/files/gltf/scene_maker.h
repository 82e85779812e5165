#pragma once
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scenes/files/gltf/accessors.h"
#include "scenes/files/gltf/hierarchy.h"
#include "scenes/files/gltf/materials.h"
#include "scenes/files/gltf/meshes.h"

namespace trueshade::gltf {

/// Puts the parts of a document together as a scene. Borrows all it is given.
class SceneMaker {
 public:
  SceneMaker(Buffers& buffers, const SceneFolder& folder, const SceneLimits& limits, const ImageDecoder& decode,
             const SceneParts& parts, bool keeps_tangents);

  /// The scene at time 0. Its timeline is empty where nothing moves. Once.
  Scene make();

 private:
  /// What a primitive's attributes and indices give, whichever meshes name them.
  struct Drawn {
    Geometry geometry;
    std::string pointer;  ///< empty until it is read
    glm::dvec3 reach{0.0};
    std::optional<uint32_t> mesh, shape;  ///< in the scene, once used
  };

  /// What of a mesh's primitives is drawn, by index, and how many are not.
  struct Parts {
    std::vector<size_t> drawn;
    uint64_t with_joints = 0;  ///< of those that are drawn
    uint64_t points = 0, lines = 0, without_positions = 0, with_unread_targets = 0;
  };

  void prepare();
  void plan_primitives();
  uint64_t instances_of(uint32_t place, const NodeSource& node, const Parts& parts, uint64_t before) const;
  void add_node(uint32_t place);
  void add_mesh(uint32_t place, const NodeSource& node);
  Parts parts_of(const MeshSource& mesh) const;
  void add_light(uint32_t place, uint32_t light);
  void add_primitive(uint32_t place, const NodeSource& node, size_t index, std::span<const glm::dmat4x3> copies);
  uint32_t add_posed_mesh(const NodeSource& node, uint32_t place, Drawn& drawn, bool skinned);
  uint32_t static_mesh(Drawn& drawn);
  Drawn& drawn_of(uint32_t mesh, size_t index);
  uint32_t scene_skin(uint32_t skin);
  Wanted wanted_of(const Primitive& primitive) const;
  void choose_parts();
  bool moves() const;
  void read_geometry_and_nodes();
  void add_notes();

  const Document& document_;
  const SceneLimits& limits_;
  const SceneParts& asked_;
  const bool keeps_tangents_;
  Scene scene_;
  Faults faults_;
  Accessors accessors_;
  Pictures pictures_;
  Materials materials_;
  Hierarchy hierarchy_;
  std::map<std::vector<uint32_t>, Drawn> drawn_;  ///< by all accessors
  std::map<std::pair<uint32_t, size_t>, Drawn*> drawn_of_primitive_;
  std::map<uint32_t, const Channel*> weight_channels_;  ///< by node
  std::map<uint32_t, size_t> weights_read_;             ///< by sampler, to those of timeline.posed with its track
  std::map<uint32_t, uint32_t> skins_;                  ///< of the document, to those of the timeline
  std::map<uint32_t, Parts> parts_;                     ///< by mesh of the document
  uint64_t points_ = 0, lines_ = 0, without_positions_ = 0, with_unread_targets_ = 0, ignored_copies_ = 0,
           passed_over_ = 0;
  uint32_t camera_place_ = kNone;  ///< in the hierarchy, of the camera that sees
  std::optional<AnimationSource> animation_;
};

}  // namespace trueshade::gltf
