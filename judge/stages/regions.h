#pragma once
// Tests of parts of an image: whether choices went the other way more often in one region than elsewhere.
#include <cstdint>
#include <string>
#include <vector>

#include "judge/stages/aggregate.h"

namespace trueshade::oracle {

/// A choice at a pixel, of a store or between surfaces.
struct PixelChoice {
  uint32_t pixel;  ///< y * width + x, y from the top
  uint64_t group;  ///< choices of one group and region are one
  float chance;    ///< predicted that it goes the other way; 0 where no rule lets it
  bool other;      ///< it did
};

/// The test of the region whose choices are the least likely, of tiles of 8, 16, 32 and 64 pixels and of the image's
/// halves. An implementation may use any share of the latitude that is predicted, but the same share everywhere: at
/// most the one that it is seen to use outside of the region, with room for chance. The test's `chance` is that of
/// finding such a region among all that were looked at.
///   least_share: of what is expected at most, taken for granted everywhere: edges of one direction move together
AggregateTest least_likely_region(const char* name, double least_share, std::vector<PixelChoice> choices, int width,
                                  int height);

}  // namespace trueshade::oracle
