#pragma once
// The planes of a capture beside those that are expected.
#include <memory>
#include <optional>
#include <vector>

#include "judge/diagnosis/disagreement.h"
#include "judge/diagnosis/plane_evidence.h"
#include "judge/diagnosis/plane_search.h"

namespace trueshade::oracle {

/// Faults that a G-buffer is supposed to have, all at once. Those that draw otherwise come first.
struct PlaneSupposition {
  std::vector<NamedPlaneFault> faults;
  std::shared_ptr<const Scene> scene;  ///< that is drawn; null: the right one
  std::shared_ptr<const ExpectedPlanes> drawn;
};

/// A captured G-buffer beside what is expected of it. Borrows all.
class PlaneCase {
 public:
  /// Chooses the samples, and finds the possible surfaces of all pixels.
  PlaneCase(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
            const StageVerdict& stage);

  /// A G-buffer without a fault.
  PlaneSupposition right() const { return {{}, nullptr, right_}; }
  /// `base` with one more fault; nothing where a fault that draws otherwise changes nothing here. Copies the scene and
  /// finds the possible surfaces again for such a fault.
  std::optional<PlaneSupposition> with(const PlaneSupposition& base, const NamedPlaneFault& fault) const;
  /// The sample that findings are judged by.
  const std::vector<SampledPixel>& sample() const { return sample_; }
  /// A smaller sample, for a first look.
  const std::vector<SampledPixel>& few() const { return few_; }

  /// Steps that each plane is off at a pixel, beyond what is legal; 0 of planes that were not captured. 1000 and more
  /// where one of the captured and the expected number is NaN or infinite and they differ.
  std::array<double, kPlanes> steps_off(const PlaneSupposition& supposed, int x, int y) const;
  /// A captured plane; false where it was not captured or is not compared.
  const PlaneView& view(Plane plane) const { return views_[size_t(plane)]; }
  /// How many planes are compared.
  int planes() const;
  /// The code or float that the plane should hold at the pixel under the supposed faults; codes are rounded.
  double predicted(const PlaneSupposition& supposed, Plane plane, int x, int y, int channel) const;
  /// What a right renderer's planes hold at a pixel.
  ExpectedPixel expected(int x, int y) const { return right_->at(x, y); }
  /// The scene that was borrowed.
  const Scene& scene() const { return scene_; }
  /// What a right renderer's planes hold.
  std::shared_ptr<const ExpectedPlanes> expected() const { return right_; }
  /// What is captured at the sample's pixels, beside what is expected; no pixel is marked as wrong. Borrows this
  /// object.
  PlaneEvidence evidence() const;

 private:
  /// `after`: the fault comes after the plane's format has rounded its numbers.
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
