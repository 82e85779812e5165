#include "raster/cluster_bins.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/error.h"
#include "core/fp_env.h"
#include "raster/cluster_bounds.h"
#include "raster/fixed_point.h"

namespace trueshade {
namespace {

// Seen instances x clusters as one long row, cut into equal pieces for the threads.
struct Row {
  std::vector<uint32_t> instance;
  std::vector<uint64_t> first{0};  // of each; one more at the end

  Row(const Scene& scene, const ClusteredScene& clusters, const View& view, bool culling) {
    constexpr size_t kFew = 16;  // clusters that are as soon looked at themselves
    for (uint32_t i = 0; i < scene.instances.size(); ++i) {
      const ClusteredMesh& mesh = clusters.meshes[scene.instances[i].mesh];
      const size_t count = mesh.clusters.size();
      if (culling && count > kFew && !may_be_seen(mesh.boxes, view.instances[i], view.window, uint32_t(count)))
        continue;
      instance.push_back(i);
      first.push_back(first.back() + count);
    }
  }
};

constexpr uint64_t kChunk = 2048;

// Appends the clusters [from, end) of the row that may be seen.
void append_piece(const Scene& scene, const ClusteredScene& clusters, const View& view, bool culling, const Row& row,
                  uint64_t from, uint64_t end, std::vector<ClusterDraw>& out) {
  const WindowTransform& t = view.window;
  size_t at = size_t(std::upper_bound(row.first.begin(), row.first.end(), from) - row.first.begin()) - 1;
  for (; from < end; ++at) {
    const uint32_t instance = row.instance[at];
    const ClusteredMesh& mesh = clusters.meshes[scene.instances[instance].mesh];
    const uint64_t until = std::min(end, row.first[at + 1]);
    const auto first = uint32_t(from - row.first[at]), last = uint32_t(until - row.first[at]);
    if (culling) append_seen(mesh.boxes, view.instances[instance], t, instance, first, last, out);
    for (uint32_t i = first; i < last && !culling; ++i)
      out.push_back({instance, i, -std::numeric_limits<float>::infinity(), false, uint16_t(t.x0), uint16_t(t.y0),
                     uint16_t(t.x1 - 1), uint16_t(t.y1 - 1)});
    from = until;
  }
}

void find_seen(const Scene& scene, const ClusteredScene& clusters, const View& view, bool culling, int threads,
               ClusterBins& bins) {
  const Row row(scene, clusters, view, culling);
  const uint64_t all = row.first.back();
  const int chunks = int((all + kChunk - 1) / kChunk);
  bins.chunk.resize(std::max(bins.chunk.size(), size_t(chunks)));
  parallel_for(chunks, threads, [&](int chunk) {
    std::vector<ClusterDraw>& out = bins.chunk[size_t(chunk)];
    const uint64_t from = uint64_t(chunk) * kChunk;
    out.clear();
    append_piece(scene, clusters, view, culling, row, from, std::min(all, from + kChunk), out);
  });
  for (int chunk = 0; chunk < chunks; ++chunk)
    bins.draws.insert(bins.draws.end(), bins.chunk[size_t(chunk)].begin(), bins.chunk[size_t(chunk)].end());
}

constexpr size_t kPieceDraws = 2048, kMostPieces = 16, kMostCounts = size_t(1) << 20;

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

// Lists the draws by tile, piece by piece: each counts its own, then puts them behind those of the pieces before it.
void list_draws(int threads, ClusterBins& bins) {
  const size_t tiles = bins.first.size() - 1, draws = bins.draws.size();
  const size_t pieces =
      std::clamp<size_t>(draws / kPieceDraws, 1, std::clamp<size_t>(kMostCounts / tiles, 1, kMostPieces));
  const SharedDivisor tile(bins.tile);
  const auto tiles_x = uint32_t(bins.tiles_x);
  const auto for_each_draw = [&](int piece, const auto& visit) {
    const size_t from = draws * size_t(piece) / pieces, end = draws * (size_t(piece) + 1) / pieces;
    uint64_t* const next = bins.next.data() + size_t(piece) * tiles;
    const ClusterDraw* const first = bins.draws.data();
    for (size_t i = from; i < end; ++i)
      for_each_tile(first[i], tile, tiles_x, [&](size_t at) { visit(uint32_t(i), next[at]); });
  };
  bins.next.assign(pieces * tiles, 0);
  parallel_for(int(pieces), threads, [&](int piece) { for_each_draw(piece, [](uint32_t, uint64_t& n) { ++n; }); });
  for (size_t tile = 0; tile < tiles; ++tile) {
    uint64_t at = bins.first[tile];
    for (size_t piece = 0; piece < pieces; ++piece) at += std::exchange(bins.next[piece * tiles + tile], at);
    if (at - bins.first[tile] > kMaxTileClusters)
      throw Error(ErrorKind::limit, "scene", "more than 16777214 clusters of 126 triangles touch one tile",
                  "use smaller tiles or fewer triangles");
    bins.first[tile + 1] = at;
  }
  bins.list.resize(bins.first.back());
  uint32_t* const list = bins.list.data();
  parallel_for(int(pieces), threads,
               [&](int piece) { for_each_draw(piece, [list](uint32_t i, uint64_t& at) { list[at++] = i; }); });
}

}  // namespace

void bin_clusters(const Scene& scene, const ClusteredScene& clusters, const View& view, int tile, bool culling,
                  int threads, ClusterBins& bins) {
  bins.tile = tile;
  bins.tiles_x = (view.width + tile - 1) / tile;
  bins.tiles_y = (view.height + tile - 1) / tile;
  bins.first.assign(size_t(bins.tiles_x) * size_t(bins.tiles_y) + 1, 0);
  bins.draws.clear();
  bins.list.clear();
  const WindowTransform& t = view.window;
  if (t.x0 >= t.x1 || t.y0 >= t.y1) return;
  find_seen(scene, clusters, view, culling, threads, bins);
  list_draws(threads, bins);
}

}  // namespace trueshade
