#pragma once
// The tightest profile that explains an image: what the implementation does where OpenGL lets it choose.
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "judge/stages/judge.h"

namespace trueshade::oracle {

/// A guess at one field of the profile, and how many pixels contradict it in every stage that the field bears on.
struct Hypothesis {
  std::string knob, value;
  uint64_t surfaces = 0;           ///< pixels of the G-buffer's stage
  std::optional<uint64_t> lights;  ///< pixels of the target's stage; nothing where that stage is not judged

  /// How many pixels of both stages contradict the guess.
  uint64_t violations() const { return surfaces + lights.value_or(0); }
};

/// The profile that an image shows its implementation to have, field by field.
struct Inference {
  std::optional<int> subpixel_bits;  ///< nothing where no grid explains the image
  std::optional<SnapRule> snap;
  std::optional<PlaneOrigin> plane_origin;  ///< either: both explain the image
  std::optional<HalfStore> half;            ///< nothing where no half was stored; either: both explain it
  std::optional<double> unorm_reach;        ///< 0.5, 0.6 or 1; nothing where no unorm was stored, or none explains it
  std::string known_as;           ///< the named profile, tightest first, that explains the image; empty if none
  std::string nearest;            ///< where known_as is empty: the named profile that the fewest pixels speak against
  Profile tightest;               ///< the fields found, as a profile; or the named profile known_as
  std::vector<Hypothesis> tried;  ///< knob by knob; guesses of one knob by their violations, the fewest first
  int sampled_rows = 0;           ///< in which the pixels of `tried` were counted; 0: in all
};

/// A sample of the rows: bands evenly apart. All rows, where the image is not much larger than such a sample.
JudgedRows sampled_rows(int width, int height);

/// Finds the tightest profile that explains a capture. Each field's values are tried one after the other, while the
/// fields that are not found yet are as open as OpenGL leaves them. Some fifteen judgements. The image must have edges
/// enough to tell grids apart; where several explain it, 8 bits are reported.
///
/// Guesses are first tried on a sample of rows. One that fails there fails on the image. One that holds is judged on
/// all rows, unless a profile that allows less was found to hold there; where that fails, the rows that it fails in
/// join the sample, and all begins again. So the answer is that of the whole image; only the counts of `tried` are of a
/// sample.
///   judged: the stages of the image under the profile that it is held to; some bands in which they fail join the
///           sample
///   before: what that judgement found, for speed alone; may be null
Inference infer_profile(const Scene& scene, const Pipeline& pipeline, const Capture& capture,
                        std::span<const StageVerdict> judged = {}, const JudgedBefore* before = nullptr);
/// Finds the tightest profile that explains a capture, beginning with this sample of rows.
Inference infer_profile(const Scene& scene, const Pipeline& pipeline, const Capture& capture, const JudgedRows& sample,
                        const JudgedBefore* before = nullptr);

/// The result as one line: `8 bits, nearest; planes snapped; half toward zero; unorm within 0.5`.
std::string text(const Inference& inference);

}  // namespace trueshade::oracle
