#pragma once
#include <string>
#include <vector>

#include "core/image.h"
#include "explain/explain.h"

namespace trueshade {

/// A change of the frame that may explain why another image has another value at a pixel, and what would be stored
/// then.
struct Candidate {
  std::string what;       ///< the change, as an answer: "light 12 left out", "the value of the pixel 411,300"
  StoredPixel stored{};   ///< in the target's stored form
  double difference = 0;  ///< from the other image's value: stored_difference()
};

/// Explains another image's value at a pixel: tries single changes of the pixel's surface, lights, light model,
/// pipeline, store and place, and returns those whose stored value comes nearest to `given`; the nearest first, at most
/// `most`. Leaves out changes that keep more than a quarter of the difference, and those that change nothing. Draws the
/// pixel again for many of them.
///   reference: what the frame stores in all pixels, for values of other places
///   given:     what the other image holds at the pixel, in the target's stored form
std::vector<Candidate> candidates_for(const ExplainedFrame& frame, const PixelHistory& history, const Image& reference,
                                      const StoredPixel& given, size_t most = 8);

/// What an image holds at a pixel, counted from the top left: unorm channels as codes, others as floats; 0 in channels
/// that the format lacks. Does not check that the pixel is in the image.
StoredPixel stored_in(const Image& image, int x, int y);

/// The largest difference between two stored pixels in any channel of the target. In codes for unorm targets; for
/// floats relative to the larger of the two sizes and 2^-14. Infinite where a channel differs and one is NaN or
/// infinite.
double stored_difference(const BlendTarget& target, const StoredPixel& a, const StoredPixel& b);

}  // namespace trueshade
