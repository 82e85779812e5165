#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cli/driver_capture.h"
#include "cli/notes.h"
#include "judge/diagnosis/finding.h"
#include "judge/diagnosis/light_quotient.h"
#include "judge/stages/validate.h"
#include "oracle/capture.h"
#include "scenes/pipeline/pipeline.h"
#include "shading/frame.h"

namespace trueshade {

/// A judged capture and all it came from, for the texts and pages that tell of it.
struct Validation {
  Pipeline pipeline;
  oracle::Capture capture;
  oracle::Profile profile;  ///< what the capture was held to
  oracle::Verdict verdict;
  std::string left_out_by;                ///< what made capture.mask: MaskRules::text()
  bool lenient = false;                   ///< what the tests of the whole image find is no failure
  bool is_diagnosed = false;              ///< faults were tried
  std::vector<oracle::Finding> findings;  ///< what explains a capture that does not pass, or what was supposed
  std::optional<oracle::LightQuotient> quotient;  ///< of light that no fault explains
  std::vector<DriverFrame::Pass> passes;  ///< empty for a capture from files
  int timed_frames = 0;                   ///< whose median the passes are
  std::optional<uint64_t> repeat_changes, move_changes;  ///< of DriverFrame; nothing where not drawn
  std::vector<std::string> notes;                        ///< what a reader must know before the figures
  Notes scene_notes;                                     ///< what the picture does not show of the scene
  double draw_ms = 0, judge_ms = 0;                      ///< wall time, upload and reading files included
  std::string command;                                   ///< as it was given
  std::optional<Frame> reference;                        ///< our own frame, for a page; its planes that a page shows
  std::string explain_command;                           ///< that says all of a pixel {x},{y}; or empty
};

/// Whether every pixel is in its legal set, the driver drew the same again and, unless that is lenient, the image is
/// one that a known rounding makes.
bool passes(const Validation& validation);

/// Looks for what explains a capture that does not pass, or tries the faults that are supposed.
void find_explanation(const Scene& scene, Validation& v, std::span<const std::string> supposed = {});

/// Pixels that some stage finds in no legal set.
uint64_t violating_pixels(const oracle::Verdict& verdict);

/// The first stage with a pixel in no legal set, or without one the first that no known rounding makes; null: none.
const oracle::StageVerdict* failed_stage(const oracle::Verdict& verdict);

/// EXACT and STORE-2 pixels among all of a stage.
double exact_share(const oracle::StageVerdict& stage);

/// How often the driver contradicts itself, in one line; empty for a capture from files.
std::string invariance_line(const Validation& validation);

/// What the driver was held to, the tightest profile, and the verdict, each in one line.
std::string profile_line(const oracle::Profile& profile);
std::string tightest_line(const oracle::Inference& inferred);
std::string conclusion(const Validation& validation);

/// What was left out, and how much; and a window of worst_windows(), each in one line.
std::string left_out_line(const Validation& validation);
std::string judged_window_line(const LocalWindow& window);

/// The rounding of stores that each stage follows: `gbuffer as stated, codes to nearest, halves toward zero; ...`.
std::string rounding_line(const oracle::Verdict& verdict);

/// How small an error of light single pixels show, in a line; empty where no light was judged.
std::string power_line(const oracle::Verdict& verdict);

/// What the lights were judged by: `preset many-lights` or `light program ggx.glsl`.
std::string lights_of(const Pipeline& pipeline);

/// What the target hides, and which one would show it; empty for 32-bit floats and where there is no picture.
std::string blind_spot_line(const Validation& validation);

/// A finding in one line, and the pixel that proves it in another.
std::string finding_line(const oracle::Finding& finding);
std::string proof_line(const oracle::Finding& finding);
/// Of a finding about a line of a light program how the line reads, and how it would have to read; else empty.
std::vector<std::string> program_lines(const oracle::Finding& finding);

/// What the command says: lines for people, or one JSON document.
std::string validation_text(const Validation& validation);
std::string validation_json(const Validation& validation);

/// A page of HTML that needs no other file: the pictures to look into, a map of the classes a stage, tables, the worst
/// pixels.
std::string validation_page(const Validation& validation, const Scene& scene);

}  // namespace trueshade
