#include "raster/clusters/cluster_bins.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/error.h"
#include "core/threads/parallel_for.h"
#include "raster/clusters/cluster_bounds.h"
#include "raster/fixed_point.h"

namespace trueshade {
namespace {

// Seen instances x clusters as one long row, to be cut into equal pieces for the threads. Frustum culling begins here:
// of instances as wholes, and in append_seen() of their clusters.
void make_row(const Scene& scene, const ClusteredScene& clusters, const View& view, bool culling, ClusterBins& bins) {
  constexpr size_t kFew = 16;  // clusters that are as soon looked at themselves
  bins.row.clear();
  bins.row_first.assign(1, 0);
  for (uint32_t i = 0; i < scene.instances.size(); ++i) {
    const ClusteredMesh& mesh = clusters.meshes[scene.instances[i].mesh];
    const size_t count = mesh.clusters.size();
    if (count == 0) continue;
    if (culling && count > kFew && !may_be_seen(mesh.boxes, view.instances[i], view.window, uint32_t(count))) continue;
    bins.row.push_back(i);
    bins.row_first.push_back(bins.row_first.back() + count);
  }
}

// Appends the clusters [from, end) of the row that may be seen.
void append_piece(const Scene& scene, const ClusteredScene& clusters, const View& view, bool culling,
                  const ClusterBins& bins, uint64_t from, uint64_t end, std::vector<ClusterDraw>& out) {
  constexpr size_t kRuns = 64;
  ClusterRun run[kRuns];
  size_t runs = 0;
  const WindowTransform& t = view.window;
  const std::vector<uint64_t>& row = bins.row_first;
  for (size_t at = size_t(std::upper_bound(row.begin(), row.end(), from) - row.begin()) - 1; from < end; ++at) {
    const uint32_t instance = bins.row[at];
    const uint64_t until = std::min(end, row[at + 1]);
    const auto first = uint32_t(from - row[at]), last = uint32_t(until - row[at]);
    const InstanceTransform& transform = view.instances[instance];
    run[runs++] = {&clusters.meshes[scene.instances[instance].mesh], &transform, instance, first, last};
    from = until;
    if (culling && (runs == kRuns || from == end)) append_seen({run, std::exchange(runs, 0)}, t, out);
    if (culling) continue;
    runs = 0;
    for (uint32_t i = first; i < last; ++i)
      out.push_back({instance, i, -std::numeric_limits<float>::infinity(), false, uint16_t(t.x0), uint16_t(t.y0),
                     uint16_t(t.x1 - 1), uint16_t(t.y1 - 1)});
  }
}

// Division of places of an image, which are below 2^16, by a number that many are divided by: with
// m = ceil(2^32 / n) the product v m is above v 2^32 / n by less than v < 2^32 / n.
class SharedDivisor {
 public:
  explicit SharedDivisor(int n) : inverse_(((uint64_t(1) << 32) + uint64_t(n) - 1) / uint64_t(n)) {}
  uint32_t quotient(uint16_t v) const { return uint32_t((v * inverse_) >> 32); }

 private:
  uint64_t inverse_;
};
static_assert(kMaxSizeBits == 16);

template <class Visit>
void for_each_tile(const ClusterDraw& draw, const SharedDivisor& tile, uint32_t tiles_x, const Visit& visit) {
  const uint32_t x0 = tile.quotient(draw.x0), x1 = tile.quotient(draw.x1);
  const uint32_t first = tile.quotient(draw.y0) * tiles_x, last = tile.quotient(draw.y1) * tiles_x;
  for (uint32_t row = first; row <= last; row += tiles_x)
    for (uint32_t x = x0; x <= x1; ++x) visit(size_t(row + x));
}

// Clusters of the row in a piece, one task: few enough for all threads to have some, and not more pieces than there is
// memory for counts of each tile.
uint64_t piece_size(uint64_t clusters, size_t tiles) {
  constexpr uint64_t kFewest = 256, kMostPieces = 48, kMostCounts = uint64_t(1) << 20;
  const uint64_t pieces = std::clamp<uint64_t>(kMostCounts / tiles, 1, kMostPieces);
  return std::max(kFewest, (clusters + pieces - 1) / pieces);
}

// Finds what each piece has for each tile; then, where that begins, in order of submission; then puts it there.
class Binning {
 public:
  Binning(const Scene& scene, const ClusteredScene& clusters, const View& view, bool culling, ClusterBins& bins)
      : scene_(scene), clusters_(clusters), view_(view), culling_(culling), bins_(bins), tile_(bins.tile) {}

  void run(int threads) {
    make_row(scene_, clusters_, view_, culling_, bins_);
    size_ = piece_size(bins_.row_first.back(), tiles());
    pieces_ = int((bins_.row_first.back() + size_ - 1) / size_);
    if (int(bins_.piece.size()) < pieces_) bins_.piece.resize(size_t(pieces_));
    parallel_for(pieces_, threads, [&](int i) { find(i); });
    number();
    parallel_for(pieces_, threads, [&](int i) { place(i); });
  }

 private:
  size_t tiles() const { return bins_.first.size() - 1; }

  void find(int i) {
    ClusterBins::Piece& piece = bins_.piece[size_t(i)];
    const uint64_t all = bins_.row_first.back(), from = uint64_t(i) * size_;
    piece.draws.clear();
    append_piece(scene_, clusters_, view_, culling_, bins_, from, std::min(all, from + size_), piece.draws);
    piece.next.assign(tiles(), 0);
    uint64_t* const count = piece.next.data();
    for (const ClusterDraw& draw : piece.draws)
      for_each_tile(draw, tile_, uint32_t(bins_.tiles_x), [&](size_t tile) { ++count[tile]; });
  }

  void number() {
    uint64_t draws = 0;
    for (int i = 0; i < pieces_; ++i) {
      ClusterBins::Piece& piece = bins_.piece[size_t(i)];
      piece.first = draws, draws += piece.draws.size();
    }
    bins_.draws.resize(draws);
    uint64_t at = 0;
    for (size_t tile = 0; tile < tiles(); ++tile) {
      bins_.first[tile] = at;
      for (int i = 0; i < pieces_; ++i) at += std::exchange(bins_.piece[size_t(i)].next[tile], at);
      if (at - bins_.first[tile] > kMaxTileClusters)
        throw Error(ErrorKind::limit, "scene", "more than 16777214 clusters of 126 triangles touch one tile",
                    "use smaller tiles or fewer triangles");
    }
    bins_.first[tiles()] = at;
    bins_.list.resize(at);
  }

  void place(int i) {
    ClusterBins::Piece& piece = bins_.piece[size_t(i)];
    std::copy(piece.draws.begin(), piece.draws.end(), bins_.draws.begin() + std::ptrdiff_t(piece.first));
    uint32_t* const list = bins_.list.data();
    uint64_t* const next = piece.next.data();
    auto draw = uint32_t(piece.first);
    for (const ClusterDraw& d : piece.draws) {
      for_each_tile(d, tile_, uint32_t(bins_.tiles_x), [&](size_t tile) { list[next[tile]++] = draw; });
      ++draw;
    }
  }

  const Scene& scene_;
  const ClusteredScene& clusters_;
  const View& view_;
  bool culling_;
  ClusterBins& bins_;
  SharedDivisor tile_;
  uint64_t size_ = 0;
  int pieces_ = 0;
};

}  // namespace

void bin_clusters(const Scene& scene, const ClusteredScene& clusters, const View& view, int tile, bool culling,
                  int threads, ClusterBins& bins) {
  bins.tile = tile;
  bins.tiles_x = (view.width + tile - 1) / tile;
  bins.tiles_y = (view.height + tile - 1) / tile;
  bins.first.assign(size_t(bins.tiles_x) * size_t(bins.tiles_y) + 1, 0);
  const WindowTransform& t = view.window;
  if (t.x0 < t.x1 && t.y0 < t.y1)
    Binning(scene, clusters, view, culling, bins).run(threads);
  else
    bins.draws.clear(), bins.list.clear();
}

}  // namespace trueshade
