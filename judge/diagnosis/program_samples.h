#pragma once
// The pixels by which changes of a light program are judged, and what programs in doubles make of them.
#include <array>
#include <span>
#include <vector>

#include "judge/diagnosis/plain_program.h"
#include "judge/stages/captured_surface.h"
#include "judge/stages/verdict.h"

namespace trueshade::oracle {

/// A captured pixel with its surface and what is stored there.
struct ProgramSample {
  int x = 0, y = 0;  ///< from the top left
  bool wrong = false;
  ShadedSurface surface;
  std::array<double, 3> stored{};  ///< R, G, B: codes or floats
};

/// Pixels that are judged together.
struct SampleSquare {
  std::vector<ProgramSample> samples;
};

/// Squares of a captured picture: some from all over it with the most wrong pixels, the first of which has most, and
/// some where a light is and nothing is wrong. Borrows the arguments.
class ProgramSamples {
 public:
  /// profile: resolved
  ProgramSamples(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
                 const StageVerdict& lighting);

  /// None where nothing is wrong.
  std::span<const SampleSquare> squares() const { return squares_; }
  /// Some of the first square's that are wrong.
  std::span<const ProgramSample* const> few() const { return few_; }
  /// The format that the samples are stored in.
  Format format() const { return color_.image->format; }

  /// Whether a try with bounds could find that a program explains enough of the squares, by what it makes in doubles.
  bool may_explain(const programs::Program& changed, std::span<const SampleSquare> squares) const;
  /// How far a program's picture is off, of the first of few(): a part of the values, at most 1 each.
  double distance(const programs::Program& changed, size_t samples) const;
  /// Of each of some lights: how many of the wrong samples, four of each square, a program stores without that light
  /// about as they are stored. Stops with no counts where of the first six none is.
  ///   samples: wrong_everywhere()
  std::vector<size_t> near_without(const programs::Program& changed, std::span<const ProgramSample* const> samples,
                                   std::span<const uint32_t> lights) const;
  /// Four wrong samples of each square.
  std::vector<const ProgramSample*> wrong_everywhere() const;
  /// The twelve lights that add most to some samples, the strongest first.
  std::vector<uint32_t> strongest_at(std::span<const ProgramSample* const> samples) const;

 private:
  void choose_squares();
  void add_square(int left, int top);
  void choose_few();
  bool is_wrong(int x, int y) const;
  bool ends_before(const Light& light, const ShadedSurface& surface) const;
  std::array<double, 3> plainly_made(const PlainProgram& program, const ProgramSample& sample) const;
  double step_of_target(size_t channel) const;
  bool is_near(const PlainProgram& program, const ProgramSample& sample) const;
  bool is_near(const std::array<double, 3>& made, const ProgramSample& sample) const;

  const Scene& scene_;
  const Pipeline& pipeline_;
  const StageVerdict& lighting_;
  const CapturedSurface surfaces_;
  const PlaneView color_;
  std::vector<SampleSquare> squares_;
  std::vector<const ProgramSample*> few_;
};

}  // namespace trueshade::oracle
