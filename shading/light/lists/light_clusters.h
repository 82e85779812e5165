#pragma once
#include <cstdint>
#include <vector>

#include "core/huge_pages.h"
#include "shading/light/light_table.h"

namespace trueshade {

/// Least and largest coordinates of the spheres of some lights, a stream per side, padded with boxes that meet nothing.
struct LightClusterBoxes {
  std::vector<float> low[3], high[3];
  size_t count = 0;
};

/// Neighbours along a curve through space, padded with lights that reach nothing: what is read of a cluster lies
/// together.
struct alignas(64) LightCluster {
  static constexpr size_t kLights = 16;
  float position[3][kLights], cut2[kLights];
  uint32_t light[kLights];  ///< of the table
};

/// A light on its way to its cluster.
struct SortedLight {
  float position[3], cut2;
  uint32_t light;
};

/// Many lights so that those near a box are found without looking at them all: along the curve, 16 to a cluster, and 16
/// clusters to a parent. Empty for lights so few that looking at them all is quicker.
struct LightClusters {
  static constexpr size_t kFewest = 4096, kMembers = LightCluster::kLights;
  std::vector<uint32_t> unbounded;    ///< lights that end nowhere, ascending
  HugeVector<LightCluster> cluster;   ///< the others
  LightClusterBoxes boxes, parents;   ///< of the clusters, and of sixteen clusters each
  std::vector<uint32_t> cell, first;  ///< scratch, kept from frame to frame like the rest
  std::vector<SortedLight> sorted;    ///< scratch

  uint64_t made_of = 0;  ///< the table's version; 0: none

  bool empty() const { return cluster.empty(); }
};

/// Lights side by side, in any order. By plain pointers: no bound is checked light by light.
struct LightStreams {
  float *position[3], *cut2;
  uint32_t* light;  ///< of the table
  size_t count = 0;
};

/// Memory of such, with room for a vector more.
class StreamMemory {
 public:
  void make_room(LightStreams& streams, size_t more) {
    constexpr size_t kVector = 16;
    if (streams.count + more + kVector > light_.size()) {
      light_.resize(2 * (streams.count + more + kVector));
      for (auto& of : number_) of.resize(light_.size());
    }
    for (size_t c = 0; c < 3; ++c) streams.position[c] = number_[c].data();
    streams.cut2 = number_[3].data(), streams.light = light_.data();
  }

 private:
  HugeVector<float> number_[4];  // they begin with cache lines
  HugeVector<uint32_t> light_;
};

/// Lights of a table found in another order than theirs; kept between regions to save allocation.
struct FoundLights {
  StreamMemory memory;
  LightStreams near;                ///< those that end somewhere and may reach a region, and a vector that do not
  std::vector<uint32_t> cluster;    ///< clusters that may reach a region
  std::vector<uint32_t> at;         ///< of a block, indices into `near`
  std::vector<uint32_t> hit[2];     ///< of two vectors of pixels, lights of the table that light some
  std::vector<uint32_t> pixels[2];  ///< and which
  std::vector<uint32_t> order;      ///< indices of hits
  std::vector<uint64_t> word, any;  ///< a bit a light, and one for each word that has any; none between regions
  std::vector<uint32_t> before;     ///< lights in the words before, of words that have any
};

LightClusters make_light_clusters(const LightTable& lights, int threads);
/// The same in the memory of any other table's. Those of a table that has not changed stay as they are.
void make_light_clusters(const LightTable& lights, int threads, LightClusters& out);

}  // namespace trueshade
