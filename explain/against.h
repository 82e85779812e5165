#pragma once
#include <string>
#include <vector>

#include "core/image.h"
#include "explain/explain.h"

namespace trueshade {

/// One change of the frame that may explain another image's value of a pixel, and what the target would hold under it.
struct Candidate {
  std::string what;       ///< as an answer: "light 12 left out", "the value of the pixel 411,300"
  StoredPixel stored{};   ///< in the target's stored form
  double difference = 0;  ///< to `given`, as stored_difference() has it
};

/// Tries single changes of a pixel's surface, lights, light model, pipeline, store and place, and returns those that
/// come nearest to `given`, the nearest first, at most `most`. A change that leaves more than a quarter of the
/// difference is no candidate, nor is one that stores what the frame stores. Draws the pixel again for many of them.
///   reference: what the frame stores in all pixels, for values of other places
///   given:     what another image holds, in the target's stored form
std::vector<Candidate> candidates_for(const ExplainedFrame& frame, const PixelHistory& history, const Image& reference,
                                      const StoredPixel& given, size_t most = 8);

/// What an image holds at a pixel counted from the top left: unorm channels as codes, others as floats; 0 for channels
/// that the format lacks. The pixel is in the image.
StoredPixel stored_in(const Image& image, int x, int y);

/// The largest difference of a channel of two stored pixels: in codes; of floats, relative to the larger of the two
/// sizes and 2^-14. Infinite where a channel differs and one of the two is not finite (NaN or infinite).
double stored_difference(const BlendTarget& target, const StoredPixel& a, const StoredPixel& b);

}  // namespace trueshade
