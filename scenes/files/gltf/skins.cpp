#include "scenes/files/gltf/skins.h"

#include "scenes/files/gltf/animations.h"

namespace trueshade::gltf {

Skin skin_of(Accessors& accessors, uint32_t index, const Hierarchy& hierarchy) {
  const Document& document = accessors.document();
  const SkinSource& from = document.skins[index];
  Skin skin;
  for (size_t j = 0; j < from.joints.size(); ++j) {
    const uint32_t place = hierarchy.placed[from.joints[j]];
    if (place == kNone)
      document.fail(pointer_to("skins", index, "joints", j), "the joint is not in the scene that is drawn",
                    "joints in the scene of the skinned node");
    skin.joints.push_back(place);
  }
  if (from.inverse_bind != kNone)
    skin.joint_from_mesh = accessors.matrices(from.inverse_bind);
  else
    accessors.take(skin.joints.size() * sizeof(glm::dmat4x3), pointer_to("skins", index));
  skin.joint_from_mesh.resize(skin.joints.size(), glm::dmat4x3(1.0));
  return skin;
}

void check_joints(const Document& document, const RestShape& shape, const Skin& skin, const std::string& pointer) {
  for (size_t i = 0; i < shape.joints.size(); ++i)
    if (shape.joints[i] >= skin.joints.size())
      document.fail(
          pointer,
          "a vertex names joint " + std::to_string(shape.joints[i]) + " of " + std::to_string(skin.joints.size()),
          "joints of the skin");
}

PosedMesh weighed(Accessors& accessors, uint32_t node, size_t targets, const AnimationSource* animation,
                  const Channel* channel, const WeightTrack* read) {
  const Document& document = accessors.document();
  const NodeSource& from = document.nodes[node];
  PosedMesh posed{};
  posed.weights = !from.weights.empty() ? from.weights : document.meshes[from.mesh].weights;
  posed.weights.resize(targets, 0.0);
  if (!channel || targets == 0) return posed;
  if (read) {
    const uint64_t numbers = read->times.size() + read->values.size() + read->arriving.size() + read->leaving.size();
    accessors.take(numbers * sizeof(double), pointer_to("nodes", node));
  }
  posed.motion = read ? *read : weight_track_of(accessors, *animation, *channel);
  return posed;
}

}  // namespace trueshade::gltf
