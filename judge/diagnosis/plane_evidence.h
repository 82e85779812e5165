#pragma once
// What a capture shows at the sampled pixels, from which the parameters of faults are estimated.
#include <functional>
#include <vector>

#include "judge/diagnosis/disagreement.h"
#include "judge/diagnosis/plane_faults.h"

namespace trueshade::oracle {

/// A sampled pixel: the numbers that the planes hold there, and those that they should hold.
struct EvidentPixel {
  SampledPixel at;
  bool wrong = false;  ///< any plane is not as expected
  PlaneValues given;   ///< of planes that were captured; `object` as id.object has it, or -1
  PlaneValues expected;
  uint32_t triangle = 0;  ///< the expected one, in the object's mesh
};

/// What is captured, at the sampled pixels and, by functions, at any other.
struct PlaneEvidence {
  const Scene& scene;
  const Pipeline& pipeline;
  std::array<bool, kPlanes> has{};  ///< planes that were captured
  std::vector<EvidentPixel> pixels;
  std::function<PlaneValues(int x, int y)> given_at;  ///< as EvidentPixel::given, of any pixel
  std::function<double(int x, int y)> object_at;      ///< its identifier alone

  /// Whether a plane was captured.
  bool has_plane(Plane plane) const { return has[size_t(plane)]; }
};

/// The objects, two at most, that at least three tenths of the wrong pixels show or should show; the likeliest first.
/// Empty where there is none.
std::vector<uint32_t> suspected_objects(const PlaneEvidence& evidence);

/// The parameters of a fault of Search::suspected: those that fault.suspects() finds, then fitted to the pixels as
/// fault.fit says. Empty where nothing is suspected, and for a fault of the camera where most pixels are right. A fit
/// draws meshes at the sampled pixels some hundreds of times.
std::vector<FaultParameter> suspected_parameters(const PlaneEvidence& evidence, const PlaneFault& fault);

}  // namespace trueshade::oracle
