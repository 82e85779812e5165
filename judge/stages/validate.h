#pragma once
// The entry point of `trueshade validate`: a capture in, everything there is to say about it out.
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "judge/stages/evidence.h"
#include "judge/stages/infer.h"
#include "judge/stages/judge.h"
#include "judge/stages/material_evidence.h"

namespace trueshade::oracle {

/// How validate_capture() judges a capture.
struct ValidateOptions {
  Profile profile;             ///< what is promised; by default what OpenGL promises with 4 subpixel bits
  bool infer = false;          ///< also find the tightest profile: judgements of some rows, and one or two more of all
  LightSteps steps{};          ///< of strategies that draw light by light: to judge each light by itself
  LightSteps objects{};        ///< of surfaces transparent after the lights: to judge each by itself
  double significance = 1e-6;  ///< how often the tests of the whole image may fail a legal image
  std::function<void(const char* part)> begins{};  ///< called before each part, such as `the surfaces`
  bool surfaces = true;  ///< false: the G-buffer is taken as it is, and only what lights make of it is judged
};

/// The result of validate_capture().
struct Verdict {
  std::string scene, driver;
  std::string profile;
  std::vector<StageVerdict> stages;  ///< those the capture has planes for: gbuffer; lighting or blending; transparency
  std::vector<Evidence> evidence;    ///< of each stage
  std::vector<MaterialEvidence> materials;  ///< of maps and of glass
  double significance = 1e-6;
  std::optional<Inference> inferred;

  uint64_t violations() const;                      ///< over all stages; the command's exit code is 1 where it is not 0
  double least_chance(size_t stages_judged) const;  ///< the chance below which one test fails, so that all together
                                                    ///< fail as rarely as `significance` says
  bool rounds_unlike_any() const;  ///< some stage's stores or surfaces are not what any known rounding makes
  bool convicted() const;          ///< legal pixel by pixel, yet no implementation that is known makes such an image
  bool suspicious() const;         ///< convicted, or stores follow another known rule than the one that is stated
  /// The strongest evidence against the capture in one line: what was counted, what is expected at most, and how likely
  /// that is. Empty where there is none.
  std::string evidence_line() const;

 private:
  std::string material_line() const;
};

/// Judges every stage that the capture has planes for. The target is judged by its final state (`lighting`) or, where
/// `steps` are given, light by light (`blending`); then by its final state too only if drawing it light by light gave
/// another image. Error(bad_input) where the capture has no plane to judge, or one of another size than the pipeline's.
Verdict validate_capture(const Scene& scene, const Pipeline& pipeline, const Capture& capture,
                         const ValidateOptions& options = {});

/// The verdict as JSON, fixed key order: scene, driver, profile, pass, convicted, suspicious, significance, evidence
/// (one line, where convicted), stages [{stage, width, height, counts by class name, left_out, covered,
/// ambiguous, predicted_other, stored_values, worst_error, rounding, aggregates [{name, observed, low, high, chance,
/// where, pass}], windows [{side, x, y, width, height, pixels, violations, other, mean_excess, largest_excess}], worst
/// [{x, y, class, plane, low, high, nominal, given, note}]}], materials [{stage, material,
/// plane, map, cause, value, error, least, pass}], inferred. x, y from the top left; infinite ends are null.
std::string verdict_json(const Verdict& verdict);

}  // namespace trueshade::oracle
