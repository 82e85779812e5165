#include "shading/light/lists/light_clusters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/threads/parallel_for.h"

namespace trueshade {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kCellBits = 5;  // cells along an axis: 2^5

struct Bounds {
  float low[3] = {kInfinity, kInfinity, kInfinity}, high[3] = {-kInfinity, -kInfinity, -kInfinity};
  void add(const float* least, const float* most) {
    for (int c = 0; c < 3; ++c) low[c] = std::min(low[c], least[c]), high[c] = std::max(high[c], most[c]);
  }
};

// Bits of a cell's coordinates by turns: neighbours along the curve are neighbours in space (Morton 1966).
uint32_t cell_of(const float* position, const Bounds& all) {
  static constexpr auto kSpread = [] {  // bits of a coordinate, two of others between each
    std::array<uint32_t, 1 << kCellBits> spread{};
    for (uint32_t i = 0; i < spread.size(); ++i)
      for (int bit = 0; bit < kCellBits; ++bit) spread[i] |= (i >> bit & 1) << (3 * bit);
    return spread;
  }();
  uint32_t code = 0;
  for (int c = 0; c < 3; ++c) {
    const float extent = all.high[c] - all.low[c], at = (position[c] - all.low[c]) / extent * float(1 << kCellBits);
    const uint32_t cell = at > 0.0f ? uint32_t(std::min(at, float((1 << kCellBits) - 1))) : 0;  // 0 where extent is
    code |= kSpread[cell] << c;
  }
  return code;
}

// The least box of floats about a light's sphere, widened by more than its roundings: a gap between it and another box
// is at least the root of the light's cut.
Bounds sphere_box(const float* position, float cut2) {
  const float radius = std::sqrt(cut2) * (1.0f + 0x1p-20f);
  Bounds out;
  for (int c = 0; c < 3; ++c) {
    const float slack = (std::abs(position[c]) + radius) * 0x1p-20f;
    out.low[c] = position[c] - radius - slack;
    out.high[c] = position[c] + radius + slack;
  }
  return out;
}

constexpr size_t kCells = size_t(1) << (3 * kCellBits), kClusterChunk = 4096;

// Whether a light ends somewhere about a position.
bool is_bounded(const LightTable& lights, size_t i) {
  return std::isfinite(lights.cut2[i]) && !std::isnan(lights.position[0][i]);
}

// Calls visit(chunk, i, position) for each light, chunks on all threads.
template <class Visit>
void for_each_light(const LightTable& lights, int threads, const Visit& visit) {
  parallel_for(int((lights.size() + kClusterChunk - 1) / kClusterChunk), threads, [&](int chunk) {
    for (size_t i = size_t(chunk) * kClusterChunk; i < std::min(lights.size(), (size_t(chunk) + 1) * kClusterChunk);
         ++i) {
      const float at[3] = {lights.position[0][i], lights.position[1][i], lights.position[2][i]};
      visit(chunk, i, at);
    }
  });
}

Bounds positions_of(const LightTable& lights, int threads) {
  std::vector<Bounds> parts(lights.size() / kClusterChunk + 1);
  for_each_light(lights, threads, [&](int chunk, size_t i, const float* at) {
    if (is_bounded(lights, i)) parts[size_t(chunk)].add(at, at);
  });
  Bounds all;
  for (const Bounds& part : parts) all.add(part.low, part.high);
  return all;
}

// Bounded lights by cell: where each cell's begin, then each light at its index. The others to `unbounded`.
void sort_along_curve(const LightTable& lights, int threads, LightClusters& out) {
  const Bounds all = positions_of(lights, threads);
  out.cell.resize(lights.size());
  for_each_light(lights, threads, [&](int, size_t i, const float* at) {
    out.cell[i] = is_bounded(lights, i) ? cell_of(at, all) : uint32_t(kCells);
  });
  out.first.assign(kCells + 2, 0);
  for (const uint32_t c : out.cell) ++out.first[c + 1];
  const size_t bounded = lights.size() - out.first[kCells + 1];
  for (size_t c = 0; c < kCells; ++c) out.first[c + 1] += out.first[c];
  out.sorted.resize(bounded);
  uint32_t* const next = out.first.data();
  SortedLight* const sorted = out.sorted.data();
  for (uint32_t i = 0; i < lights.size(); ++i) {
    const uint32_t c = out.cell[i];
    if (c == kCells)
      out.unbounded.push_back(i);
    else
      sorted[next[c]++] = {{lights.position[0][i], lights.position[1][i], lights.position[2][i]}, lights.cut2[i], i};
  }
}

void resize(LightClusterBoxes& boxes, size_t count) {
  boxes.count = count;
  for (auto& side : boxes.low) side.assign((count + 15) / 16 * 16, kInfinity);
  for (auto& side : boxes.high) side.assign((count + 15) / 16 * 16, -kInfinity);
}

void put(LightClusterBoxes& boxes, size_t i, const Bounds& b) {
  for (int c = 0; c < 3; ++c) boxes.low[c][i] = b.low[c], boxes.high[c][i] = b.high[c];
}

// One parent of clusters: its lights side by side, and the boxes.
void fill_parent(size_t parent, LightClusters& out) {
  constexpr size_t kMembers = LightClusters::kMembers;
  Bounds of_parent;
  for (size_t g = parent * kMembers; g < std::min(out.boxes.count, (parent + 1) * kMembers); ++g) {
    LightCluster cluster{};
    Bounds of_cluster;
    for (size_t i = 0; i < std::min(kMembers, out.sorted.size() - g * kMembers); ++i) {
      const SortedLight& light = out.sorted[g * kMembers + i];
      const Bounds sphere = sphere_box(light.position, light.cut2);
      of_cluster.add(sphere.low, sphere.high);
      for (int c = 0; c < 3; ++c) cluster.position[c][i] = light.position[c];
      cluster.cut2[i] = light.cut2, cluster.light[i] = light.light;
    }
    out.cluster[g] = cluster;
    put(out.boxes, g, of_cluster);
    of_parent.add(of_cluster.low, of_cluster.high);
  }
  put(out.parents, parent, of_parent);
}

}  // namespace

void make_light_clusters(const LightTable& lights, int threads, LightClusters& out) {
  constexpr size_t kMembers = LightClusters::kMembers;
  if (out.made_of != 0 && out.made_of == lights.version) return;
  out.made_of = lights.version;
  out.cluster.clear(), out.unbounded.clear();
  if (lights.size() < LightClusters::kFewest) return;
  sort_along_curve(lights, threads, out);
  if (out.sorted.size() < LightClusters::kFewest) return;
  const size_t clusters = (out.sorted.size() + kMembers - 1) / kMembers, parents = (clusters + kMembers - 1) / kMembers;
  out.cluster.resize(clusters);
  resize(out.boxes, clusters);
  resize(out.parents, parents);
  parallel_for(int(parents), threads, [&](int parent) { fill_parent(size_t(parent), out); });
}

LightClusters make_light_clusters(const LightTable& lights, int threads) {
  LightClusters out;
  make_light_clusters(lights, threads, out);
  return out;
}

}  // namespace trueshade
