#pragma once
// The outline of an object. Where an object is moved along one of its faces, the captured values on the face stay as
// they are, and only the outline tells how far it is moved.
#include <functional>
#include <optional>

#include "judge/diagnosis/plane_evidence.h"
#include "judge/diagnosis/sketch.h"
#include "judge/diagnosis/triple.h"

namespace trueshade::oracle {

/// The pixels on both sides of an object's outline in the plane of identifiers; 1500 at most, spread over all of it.
/// Empty where this plane was not captured.
std::vector<SampledPixel> outline_of(const PlaneEvidence& evidence, uint32_t object);

/// An object's outline, and the sample. Borrows the evidence.
class ObjectBorder {
 public:
  /// Empty where identifiers were not captured, and for meshes of more than 20,000 triangles.
  ObjectBorder(const PlaneEvidence& evidence, uint32_t object);

  /// Draws the scene's object alone, and counts the pixels that show it and are not drawn, or are drawn and do not show
  /// it. A pixel that shows a nearer surface does not count.
  int mismatches(const Scene& scene, const Pipeline& pipeline);
  /// Whether there are no pixels to compare.
  bool empty() const { return places_.empty(); }

 private:
  const uint32_t object_;
  std::vector<SampledPixel> places_;
  std::vector<PlaneValues> given_;
  std::optional<Sketch> sketch_;
};

/// The numbers of a fault that cost least, for a cost that changes in steps, as a count of pixels does. Looks from `at`
/// along each number, takes the middle of those that cost as little, and rounds it as people write numbers. Asks for
/// the cost some hundreds of times.
///   numbers: how many of the three are looked for
///   size: of a small change of a number
Triple3 settled(const std::function<double(const Triple3&)>& cost, int numbers, double size, Triple3 at);

}  // namespace trueshade::oracle
