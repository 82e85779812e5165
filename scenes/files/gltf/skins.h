#pragma once
#include <string>

#include "scenes/files/gltf/accessors.h"
#include "scenes/files/gltf/hierarchy.h"

namespace trueshade::gltf {

/// Skin of a document for a hierarchy, which must hold all its joints. Without inverse bind matrices they are the
/// identity.
Skin skin_of(Accessors& accessors, uint32_t index, const Hierarchy& hierarchy);

/// Error(bad_input) behind `pointer` where a vertex names a joint beyond the skin's.
void check_joints(const Document& document, const RestShape& shape, const Skin& skin, const std::string& pointer);

/// How a node's mesh is posed: its weights, moved by a channel of the animation if there is one. `read` is the track of
/// that channel's sampler, if it was read before.
PosedMesh weighed(Accessors& accessors, uint32_t node, size_t targets, const AnimationSource* animation,
                  const Channel* channel, const WeightTrack* read);

}  // namespace trueshade::gltf
