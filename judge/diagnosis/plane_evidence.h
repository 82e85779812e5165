#pragma once
// What a capture shows at the pixels that are looked at, for estimates of what was drawn there.
#include <functional>
#include <vector>

#include "judge/diagnosis/disagreement.h"
#include "judge/diagnosis/plane_faults.h"

namespace trueshade::oracle {

struct EvidentPixel {
  SampledPixel at;
  bool wrong = false;  ///< any plane is not as expected
  PlaneValues given;   ///< of planes that were captured; `object` as id.object has it, or -1
  PlaneValues expected;
  uint32_t triangle = 0;  ///< that is expected, of the object's mesh
};

struct PlaneEvidence {
  const Scene& scene;
  const Pipeline& pipeline;
  std::array<bool, kPlanes> has{};  ///< planes that were captured
  std::vector<EvidentPixel> pixels;
  std::function<PlaneValues(int x, int y)> given_at;  ///< as EvidentPixel::given, of any pixel
  std::function<double(int x, int y)> object_at;      ///< its identifier alone

  bool has_plane(Plane plane) const { return has[size_t(plane)]; }
};

/// Objects that have wrong pixels, by what is expected there or what was given, at most two, the likeliest first.
std::vector<uint32_t> suspected_objects(const PlaneEvidence& evidence);

/// Numbers of a fault that its suspects() names, fitted to the pixels.
std::vector<FaultParameter> suspected_parameters(const PlaneEvidence& evidence, const PlaneFault& fault);

}  // namespace trueshade::oracle
