#pragma once
#include "scenes/files/gltf/accessors.h"
#include "scenes/files/gltf/hierarchy.h"

namespace trueshade::gltf {

/// What is played of a document: the animation that is named, the first where none is, or all of them as one. Where
/// several move the same, the first of them does, and `passed_over` counts the channels of the others. Nothing where
/// there are none. Error(usage) for one that is not there.
std::optional<AnimationSource> played_animation(const Document& document, const std::optional<std::string>& named,
                                                uint64_t& passed_over);

/// Names of animations, and the largest time of their samplers.
std::vector<SceneAnimation> animations_of(const Document& document);

/// The track of a channel that moves a node: rotations turn along the arc, all else as the sampler says.
/// Error(bad_input) for times that are negative or do not ascend, and for rotations that are not of unit length.
Track track_of(Accessors& accessors, const AnimationSource& animation, const Channel& channel);

/// The track of a channel that weighs morph targets.
WeightTrack weight_track_of(Accessors& accessors, const AnimationSource& animation, const Channel& channel);

/// The motions of nodes of a hierarchy, in its order.
std::vector<NodeMotion> node_motions(Accessors& accessors, const AnimationSource& animation,
                                     const Hierarchy& hierarchy);

}  // namespace trueshade::gltf
