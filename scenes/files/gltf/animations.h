#pragma once
#include "scenes/files/gltf/accessors.h"
#include "scenes/files/gltf/hierarchy.h"

namespace trueshade::gltf {

/// The track of a channel that moves a node: rotations turn along the arc, all else as the sampler says.
/// Error(bad_input) for times that are negative or do not ascend, and for rotations that are not of unit length.
Track track_of(Accessors& accessors, const AnimationSource& animation, const Channel& channel);

/// The track of a channel that weighs morph targets.
WeightTrack weight_track_of(Accessors& accessors, const AnimationSource& animation, const Channel& channel);

/// The motions of nodes of a hierarchy, in its order.
std::vector<NodeMotion> node_motions(Accessors& accessors, const AnimationSource& animation,
                                     const Hierarchy& hierarchy);

}  // namespace trueshade::gltf
