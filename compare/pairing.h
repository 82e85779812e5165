#pragma once
#include <string>
#include <vector>

#include "core/image_files/picture_file.h"

namespace trueshade::compare {

/// A channel that both pictures have. Both stay alive with the pictures.
struct ChannelPair {
  std::string name;  ///< NAME, or PART.NAME where there are several parts
  const Channel* reference;
  const Channel* test;
};

/// Channels of one size.
struct PartPair {
  std::string name;  ///< empty where there is one part
  int width, height;
  std::vector<ChannelPair> channels;
};

/// What of two pictures belongs together.
struct Pairing {
  std::vector<PartPair> parts;
  std::vector<std::string> mismatches;  ///< what does not, each in one line
};

/// Parts are paired by name, or where each picture has one, whatever they are called; their channels by name, or where
/// each part has one, whatever they are called. A part of two sizes or windows has no pairs.
Pairing paired(const PictureFile& reference, const PictureFile& test);

}  // namespace trueshade::compare
