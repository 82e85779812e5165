#pragma once
// The planes of a capture beside those that are expected.
#include <memory>
#include <optional>
#include <vector>

#include "judge/diagnosis/disagreement.h"
#include "judge/diagnosis/plane_evidence.h"
#include "judge/diagnosis/plane_search.h"

namespace trueshade::oracle {

/// Faults that a G-buffer is supposed to have, all at once; those that change what is drawn act first.
struct PlaneSupposition {
  std::vector<NamedPlaneFault> faults;
  std::shared_ptr<const Scene> scene;  ///< that is drawn; null: the right one
  std::shared_ptr<const ExpectedPlanes> drawn;
};

/// A captured G-buffer beside what is expected of it. Borrows the scene and the capture.
class PlaneCase {
 public:
  /// Chooses the samples of pixels, and finds the surfaces that all pixels may show.
  PlaneCase(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
            const StageVerdict& stage);

  /// The supposition that nothing is wrong.
  PlaneSupposition right() const { return {{}, nullptr, right_}; }
  /// The supposition `base` with one more fault; nothing where a fault that changes what is drawn would change nothing
  /// here. For such a fault it copies the scene and finds all surfaces again, which takes long.
  std::optional<PlaneSupposition> with(const PlaneSupposition& base, const NamedPlaneFault& fault) const;
  /// The sampled pixels that findings are judged by, some 1000 at most.
  const std::vector<SampledPixel>& sample() const { return sample_; }
  /// A smaller sample of pixels, for a first, cheap look at each fault.
  const std::vector<SampledPixel>& few() const { return few_; }

  /// For each plane, by how many steps a pixel is off, beyond what is legal; 0 for planes that were not captured. At
  /// least 1000 where one of the captured and the expected number is NaN or infinite and they differ.
  std::array<double, kPlanes> steps_off(const PlaneSupposition& supposed, int x, int y) const;
  /// A captured plane; an empty view where the plane was not captured or is not compared.
  const PlaneView& view(Plane plane) const { return views_[size_t(plane)]; }
  /// How many planes were captured and are compared.
  int planes() const;
  /// What a captured plane's channel should hold at the pixel under the supposed faults: of fixed point the nearest
  /// code, of other planes the number, which is not rounded to the plane's format.
  double predicted(const PlaneSupposition& supposed, Plane plane, int x, int y, int channel) const;
  /// What a right renderer's planes hold at the pixel.
  ExpectedPixel expected(int x, int y) const { return right_->at(x, y); }
  /// The scene, which is borrowed.
  const Scene& scene() const { return scene_; }
  /// What a right renderer's planes hold at all pixels.
  std::shared_ptr<const ExpectedPlanes> expected() const { return right_; }
  /// What is captured and expected at the sampled pixels, for estimates of parameters. No pixel is marked as wrong. The
  /// result borrows this object.
  PlaneEvidence evidence() const;

 private:
  /// The numbers that a plane should show at a pixel under the supposed faults, which may move the pixel there.
  /// `after`: the faults act on numbers that the albedo's format has rounded.
  ExpectedPixel changed(const PlaneSupposition& supposed, Plane plane, int x, int y, bool after) const;
  void encode(const PlaneFault& fault, double parameter, ExpectedPixel& p) const;
  PlaneValues given(int x, int y) const;
  std::array<double, kPlanes> steps_off(const ExpectedPixel& p, int x, int y) const;
  std::optional<ExpectedPixel> average_at(const ExpectedPlanes& planes, int x, int y) const;
  double channel_off(Plane plane, const ExpectedPixel& p, double reach, int x, int y, int channel) const;
  double stored(Plane plane, double value, int channel) const;

  const Scene& scene_;
  const Pipeline pipeline_;
  const Profile profile_;
  const std::array<int, 2> drawn_at_;
  const PlaneContext context_;
  std::array<PlaneView, kPlanes> views_;
  double extent_ = 1;  ///< of positions: what floats of them are exact to
  std::shared_ptr<const ExpectedPlanes> right_;
  std::vector<SampledPixel> sample_, few_;
};

}  // namespace trueshade::oracle
