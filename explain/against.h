#pragma once
#include <string>
#include <vector>

#include "core/image.h"
#include "explain/explain.h"

namespace trueshade {

/// Something that may have been otherwise where another pixel value comes from, and what the target would hold then.
struct Candidate {
  std::string what;       ///< as an answer: "light 12 left out", "the value of the pixel 411,300"
  StoredPixel stored{};   ///< in the target's stored form
  double difference = 0;  ///< largest over the channels: codes, or of floats relative to the larger of both
};

/// What one change each of surface, lights, light model, place or store would have made of a pixel, those nearest to
/// `given` first, at most `most`. What is not four times nearer than the pixel without any change is no candidate.
///   reference: the frame's target, for values of other pixels
///   given:     what another image holds, in the target's stored form
std::vector<Candidate> candidates_for(const ExplainedFrame& frame, const PixelHistory& history, const Image& reference,
                                      const StoredPixel& given, size_t most = 8);

/// What an image of the frame's target format holds at a pixel counted from the top left.
StoredPixel stored_in(const Image& image, int x, int y);

/// The difference of two stored pixels as Candidate has it.
double stored_difference(const BlendTarget& target, const StoredPixel& a, const StoredPixel& b);

}  // namespace trueshade
