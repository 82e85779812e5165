#pragma once
// Tests of parts of an image: whether choices went the other way more often in one region than elsewhere.
#include <cstdint>
#include <string>
#include <vector>

#include "judge/stages/aggregate.h"

namespace trueshade::oracle {

/// Something at a pixel that may go one of two ways: which neighbour is stored, or which surface is shown.
struct PixelChoice {
  uint32_t pixel;  ///< y * width + x, y from the top
  uint64_t group;  ///< choices of one group count as one within a region
  float chance;    ///< predicted chance of the way that is not nominal; 0 where no rule lets it
  bool other;      ///< it went the way that is not nominal
};

/// Tests each region of an image for more choices that went the other way than elsewhere: tiles of 8, 16, 32 and 64
/// pixels, and the image's halves. Returns the least likely region's test, whose `chance` is that of finding such a
/// region among all. An implementation may use any share of the latitude that is predicted, but the same share
/// everywhere: at most the one that is seen outside of the region, with room for chance.
///   least_share: a share that is allowed in any case: edges of one direction move together
AggregateTest least_likely_region(const char* name, double least_share, std::vector<PixelChoice> choices, int width,
                                  int height);

}  // namespace trueshade::oracle
