#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "raster/clusters/cluster_draw.h"
#include "raster/clusters/clusters.h"
#include "raster/view.h"

namespace trueshade {

/// The clusters that may be seen, and for each tile those that may touch it, in submission order.
struct ClusterBins {
  int tile = 64, tiles_x = 0, tiles_y = 0;
  std::vector<ClusterDraw> draws;  ///< ascending by instance, then cluster
  std::vector<uint64_t> first;     ///< tiles_x * tiles_y + 1 offsets into `list`; tile (x, y) is y * tiles_x + x, y up
  std::vector<uint32_t> list;      ///< into `draws`, ascending in each tile
  // Scratch, kept from frame to frame like the rest.
  std::vector<uint32_t> row;        ///< instances that may be seen
  std::vector<uint64_t> row_first;  ///< clusters of the instances of `row` before each; last, of all of them
  struct Piece {
    std::vector<ClusterDraw> draws;
    std::vector<uint64_t> next;  ///< for each tile: how many clusters it has; later where in `list` its next one goes
    uint64_t first;              ///< of `draws` among all
  };
  std::vector<Piece> piece;

  std::span<const uint32_t> tile_list(int index) const {
    return {list.data() + first[size_t(index)], size_t(first[size_t(index) + 1] - first[size_t(index)])};
  }
};

/// Conservative: a cluster is left out of a tile only if none of its fragments can fall there. Without `culling` every
/// cluster is in every tile of the viewport. `bins` may be those of any frame before: their memory is used again.
void bin_clusters(const Scene& scene, const ClusteredScene& clusters, const View& view, int tile, bool culling,
                  int threads, ClusterBins& bins);

}  // namespace trueshade
