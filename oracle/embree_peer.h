#pragma once
#include <cstdint>
#include <memory>

#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// Primary visibility by Embree as one would use it for speed: fast tests, coherent packets of 16 rays. For benchmarks;
/// the judge of visibility is embree_rays.h. Both faces are hit; the first hit alone is found, nothing is shaded.
class EmbreePeer {
 public:
  /// Builds the trees. Borrows nothing.
  EmbreePeer(const Scene& scene, const Pipeline& pipeline);
  ~EmbreePeer();

  /// Rows of 4 pixels that a frame has; trace_row() may run on any thread, many at a time.
  int rows() const;
  /// Rays through the pixel centres of row `row`; how many hit something.
  uint64_t trace_row(int row) const;

 private:
  struct Rays;
  std::unique_ptr<Rays> rays_;
};

}  // namespace trueshade::oracle
