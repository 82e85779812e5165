#pragma once
// Surfaces that may share the visible one's depth: under forward-multipass, whose draws after the first test for EQUAL,
// they add to the pixel too.
#include <span>
#include <vector>

#include "judge/bounds/profile.h"
#include "judge/bounds/shaded_surface.h"
#include "judge/legal/judged_rows.h"
#include "oracle/capture.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// A surface that may have the same depth as the visible one.
struct TiedSurface {
  ShadedSurface surface;  ///< what its fragment's attributes may be
  bool certain = false;   ///< it covers the sample, and its depth is exactly the one in the buffer
  bool before = false;    ///< submitted before the visible one
  float chance = 0.5f;    ///< probability that an uncertain one ties; 1: all such may, as where an offset ends at a
                          ///< limit
};

/// Finds the surfaces that may have the visible one's depth at each pixel, in order of submission; y from the top.
/// Where nothing is visible, those that may have the clear depth. The visible surface is the one that the capture's
/// id.object (and id.primitive, where captured) names; of several, the one whose normal and depth are nearest to those
/// stored. Triangles that share an edge are counted apart, although only one can have the sample.
class TiedSurfaces {
 public:
  /// Finds the surfaces of all pixels, with every core. Pixels of other rows than `rows` have none.
  TiedSurfaces(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
               const JudgedRows& rows = {});

  /// The surfaces that may have the visible one's depth at the pixel.
  std::span<const TiedSurface> at(int x, int y) const {
    const size_t pixel = size_t(y) * size_t(width_) + size_t(x);
    return {list_.data() + first_[pixel], first_[pixel + 1] - first_[pixel]};
  }

 private:
  int width_;
  std::vector<size_t> first_;
  std::vector<TiedSurface> list_;
};

}  // namespace trueshade::oracle
