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

/// Sixteen lights that are neighbours along a curve through space, padded with lights that reach nothing. The numbers
/// that are read of a cluster lie together in memory.
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

/// A frame's lights in a tree, in which the lights near a box are found without testing each light. The lights are
/// sorted along a curve through space; 16 neighbours form a cluster, 16 clusters a parent. Below kFewest lights the
/// tree is empty, because testing each light is quicker.
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

/// Lights in any order, an array for each number. These are plain pointers, because a checked access for each light
/// would be slow.
struct LightStreams {
  float *position[3], *cut2;
  uint32_t* light;  ///< of the table
  size_t count = 0;
};

/// The memory of LightStreams; there is room for one vector more than asked for.
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
/// Makes the clusters in the memory of `out`. If `out` was made of the same version of the table, it stays as it is.
void make_light_clusters(const LightTable& lights, int threads, LightClusters& out);

}  // namespace trueshade
