#pragma once
// The outline of an object in the plane of identifiers. Where an object is moved along one of its faces, the values on
// the face stay as they are, and only the outline tells how far it moved.
#include <functional>
#include <optional>

#include "judge/diagnosis/plane_evidence.h"
#include "judge/diagnosis/sketch.h"
#include "judge/diagnosis/triple.h"

namespace trueshade::oracle {

/// The pixels on both sides of an object's outline, as captured in id.object; 1500 at most, spread over all of it.
/// Empty where id.object was not captured.
std::vector<SampledPixel> outline_of(const PlaneEvidence& evidence, uint32_t object);

/// An object's outline as captured, and the sampled pixels, to be compared with sketches of the object.
class ObjectBorder {
 public:
  /// empty() where id.object was not captured, and for meshes of more than 20,000 triangles. Does not keep the
  /// evidence.
  ObjectBorder(const PlaneEvidence& evidence, uint32_t object);

  /// Draws the scene's object alone, and counts the pixels where the drawing and the capture disagree on whether the
  /// object is seen. Pixels where the capture shows a nearer surface do not count.
  int mismatches(const Scene& scene, const Pipeline& pipeline);
  /// Whether there are no pixels to compare with.
  bool empty() const { return places_.empty(); }

 private:
  const uint32_t object_;
  std::vector<SampledPixel> places_;
  std::vector<PlaneValues> given_;
  std::optional<Sketch> sketch_;
};

/// Finds the numbers of a fault that cost least, for a cost that changes in jumps, as a count of pixels does. Looks
/// from `at` along each number, takes the middle of the values that cost as little, and rounds them as people write
/// numbers. Asks for the cost some hundreds of times.
///   numbers: how many of the three are looked for
///   size: of a small change of a number
Triple3 settled(const std::function<double(const Triple3&)>& cost, int numbers, double size, Triple3 at);

}  // namespace trueshade::oracle
