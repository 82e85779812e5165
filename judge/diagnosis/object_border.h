#pragma once
// Where an object is seen to end: what tells how far it is moved along a face, on which all that is captured stays as
// it was.
#include <functional>
#include <optional>

#include "judge/diagnosis/plane_evidence.h"
#include "judge/diagnosis/sketch.h"
#include "judge/diagnosis/triple.h"

namespace trueshade::oracle {

/// The pixels on both sides of an object's outline in the plane of identifiers; of many some.
std::vector<SampledPixel> outline_of(const PlaneEvidence& evidence, uint32_t object);

/// An object's outline, and the sample. Borrows the evidence.
class ObjectBorder {
 public:
  ObjectBorder(const PlaneEvidence& evidence, uint32_t object);

  /// Of how many pixels the scene, drawn with this object alone, has the object where it is not, or not where it is.
  int mismatches(const Scene& scene, const Pipeline& pipeline);
  bool empty() const { return places_.empty(); }

 private:
  const uint32_t object_;
  std::vector<SampledPixel> places_;
  std::vector<PlaneValues> given_;
  std::optional<Sketch> sketch_;
};

/// Three numbers of a fault by a cost that has steps: from `at` along each number, and then the middle of those that
/// cost as little, rounded to what people write.
///   size: of a small change
Triple3 settled(const std::function<double(const Triple3&)>& cost, int numbers, double size, Triple3 at);

}  // namespace trueshade::oracle
