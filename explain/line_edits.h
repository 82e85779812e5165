#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "explain/explain.h"

namespace trueshade {

/// A pixel under the light program with one line, or one parameter, otherwise.
struct LineEdit {
  std::string what;       ///< "line 6 of ggx.glsl has a value where it should have its square"
  uint32_t line = 0;      ///< of the program's text, from 1; 0: of a parameter
  std::string it_reads;   ///< the line's text, but for SPIR-V
  std::string drawn_as;   ///< how the line would have to read; empty where that is not found
  StoredPixel stored{};   ///< in the target's stored form
  double difference = 0;  ///< to `given`, as stored_difference() has it
};

/// What edits of the light program's lines make of a pixel.
struct LineEdits {
  std::vector<LineEdit> nearest;   ///< all as near as the first, the likeliest slips first
  size_t alike = 0;                ///< edits that are as near, these among them
  size_t tried = 0, left_out = 0;  ///< edits that were tried, and those that would have taken too long
};

/// Tries what the diagnosis of validate tries (programs/edits/program_edits.h) on the light program of the pipeline, at
/// one pixel, and returns of those edits that come nearest to `given` at most `most`. An edit that leaves more than a
/// quarter of the difference is none of them, nor is one that stores what the frame stores. Where an edit without a
/// number makes the value, none with a number is tried after it, and no operand is taken for another; that a step has
/// some number times its value is never tried, since that makes any value. Tries nothing where the pipeline has no
/// light program, where nothing is seen, and on an unlit surface. Stops after about a second of two cores.
///   given: what another image holds, in the target's stored form
LineEdits line_edits_for(const ExplainedFrame& frame, const PixelHistory& history, const StoredPixel& given,
                         size_t most = 3);

}  // namespace trueshade
