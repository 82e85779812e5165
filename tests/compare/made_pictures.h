#pragma once
#include <bit>
#include <string>
#include <vector>

#include "compare/comparison.h"
#include "core/half.h"

namespace trueshade::compare {

inline Channel float_channel(std::string name, const std::vector<float>& values) {
  Channel channel;
  channel.name = std::move(name);
  for (const float value : values) channel.words.push_back(std::bit_cast<uint32_t>(value));
  return channel;
}

/// Of floats that are halves.
inline Channel half_channel(std::string name, const std::vector<float>& values) {
  Channel channel = float_channel(std::move(name), values);
  channel.bits = 16;
  return channel;
}

inline Channel code_channel(std::string name, int bits, const std::vector<uint32_t>& codes,
                            ChannelKind kind = ChannelKind::unorm) {
  Channel channel;
  channel.name = std::move(name);
  channel.kind = kind;
  channel.bits = bits;
  channel.words = codes;
  return channel;
}

inline Channel of_part(std::string part, Channel channel) {
  channel.part = std::move(part);
  return channel;
}

/// A picture of one part.
inline PictureFile made_picture(int width, int height, std::vector<Channel> channels,
                                ColorSpace space = ColorSpace::linear) {
  PictureFile picture;
  picture.path = "made";
  picture.parts.push_back({"made", width, height, std::move(channels)});
  picture.color_space = space;
  picture.color_source = "as made";
  return picture;
}

}  // namespace trueshade::compare
