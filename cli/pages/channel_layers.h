#pragma once
#include <string>
#include <vector>

#include "cli/pages/layer.h"
#include "compare/comparison.h"

namespace trueshade {

/// Channels of two pictures that are looked at together: R, G, B and A; a layer's X, Y and Z; or one alone.
struct ChannelGroup {
  std::string name;  ///< of the layer in the file; empty for colours
  int width = 0, height = 0;
  std::vector<const compare::ChannelPair*> channels;
};

/// The groups of all parts, colours first. They point into the pairing.
std::vector<ChannelGroup> channel_groups(const compare::Pairing& pairing);

/// What the names of a group's layers end in: nothing for colours, else a space and the group's name.
std::string name_suffix(const ChannelGroup& group);

/// Both sides of a group as layers of a page, which point into the pictures. Stored codes and floats where both
/// pictures store them alike; else what they stand for, as floats, decoded as they were compared.
struct GroupLayers {
  PageLayer reference, test;
};
GroupLayers layers_of(const ChannelGroup& group, const compare::Decoding& decoding, const std::string& ids);

/// A side of a group as a picture to look at: its first three channels, or its one channel as grey.
Image picture_of_layer(const PageLayer& layer);

}  // namespace trueshade
