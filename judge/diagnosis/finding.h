#pragma once
// What a diagnosis says of a capture.
#include <span>
#include <string>
#include <vector>

#include "judge/bounds/profile.h"
#include "judge/stages/verdict.h"
#include "oracle/capture.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// One channel of one pixel as evidence of a fault: what is right there, what was captured, what the fault predicts.
struct Proof {
  int x = 0, y = 0;   ///< from the top left
  std::string plane;  ///< `color.R`; unorm values are codes
  double given = 0, right = 0, predicted = 0;
  bool by_both = false;   ///< predicted of this fault and the one that is named beside it
  bool anything = false;  ///< the fault predicts no number there: `predicted` is what was given
};

/// A fault that explains pixels of a capture which are not as they should be.
struct Finding {
  std::string name;          ///< of the fault, with its parameter: `light-range=1.01`; what `--suppose` takes
  std::string plane;         ///< that is wrong: `picture`, `normal`, ..., or `G-buffer`
  std::string text;          ///< a sentence without its full stop
  uint64_t changed = 0;      ///< pixels of the plane that differ from what is predicted of a right renderer, estimated
  double explained = 0;      ///< the share of these that the fault predicts; of `together`, that both predict
  double contradicted = 0;   ///< of the pixels that were as predicted, the share that the fault predicts otherwise
  bool together = false;     ///< the second of two faults: `changed`, `explained` and `contradicted` are of both
  double alone = 0;          ///< the share that it explains without the other; `explained`, unless `together`
  bool drawn_again = false;  ///< what it predicts is drawn with the fault, and exact
  bool fitted = false;       ///< its numbers are estimates, so that it can explain much by chance
  double located = 0;        ///< the share that it says is wrong, and predicts no number of: not in `explained`
  double left = 0;    ///< the share that stays far off, as no rounding leaves it; 0 of what is drawn with other edges
  double astray = 0;  ///< of `left`, the share whose normals are another direction
  bool tied = false;  ///< no pixel tells it from the finding before it
  bool partial = false;  ///< it leaves so much unexplained that it is no explanation: it may be part of it
  Proof proof;
  uint32_t line = 0;     ///< of a light program, from 1, as the next two; 0: the finding is about no line
  std::string it_reads;  ///< the line's text; empty of SPIR-V
  std::string drawn_as;  ///< how the line would have to read to draw the picture; empty where that is not found
  std::string command;   ///< that shows it: of who asked; diagnose() leaves it empty
};

/// The faults that explain a capture which does not pass, at most `most`, the likeliest first; those that are only
/// `partial` come last. None where no known fault explains a third of what is wrong, and where nothing is wrong. Works
/// on samples of some thousands of pixels, the same ones every time. For each fault that draws other surfaces it finds
/// the surfaces of the whole picture again, which takes long.
///   stages: the verdicts of validate_capture(), by the same pipeline and profile
///   supposed: names of faults; if there are any, these are tried and no others
/// Error(usage) for a name that no fault has, or a parameter that the fault does not take.
std::vector<Finding> diagnose(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                              const Capture& capture, std::span<const StageVerdict> stages,
                              std::span<const std::string> supposed = {}, size_t most = 3);

/// A known fault: its name with the form of its parameter, the plane that it changes, and its sentence.
struct KnownFault {
  std::string name, plane, text;
};

/// All known faults, for help and documents.
std::vector<KnownFault> known_faults();

/// Findings as JSON: an array of {name, plane, text, changed, explained, contradicted, together, alone, located, left,
/// tied, proof {x, y, plane, given, right, predicted, by_both, anything}, partial, line, it_reads, drawn_as, command};
/// the last but one three of findings about a line of a light program alone.
std::string findings_json(std::span<const Finding> findings);

}  // namespace trueshade::oracle
