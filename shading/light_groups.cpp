#include "shading/light_groups.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/fp_env.h"

namespace trueshade {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kCellBits = 5;  // cells along an axis: 2^5

struct Place {
  float at[3];
  Place(const LightTable& lights, uint32_t light) {
    for (int c = 0; c < 3; ++c) at[c] = lights.position[c][light];
  }
};

struct Bounds {
  float low[3] = {kInfinity, kInfinity, kInfinity}, high[3] = {-kInfinity, -kInfinity, -kInfinity};
  void add(const float* least, const float* most) {
    for (int c = 0; c < 3; ++c) low[c] = std::min(low[c], least[c]), high[c] = std::max(high[c], most[c]);
  }
};

// Bits of a cell's coordinates by turns: neighbours along the curve are neighbours in space (Morton 1966).
uint32_t cell_of(const float* place, const Bounds& all) {
  uint32_t code = 0;
  for (int c = 0; c < 3; ++c) {
    const float extent = all.high[c] - all.low[c], at = (place[c] - all.low[c]) / extent * float(1 << kCellBits);
    const uint32_t cell = at > 0.0f ? uint32_t(std::min(at, float((1 << kCellBits) - 1))) : 0;  // 0 where extent is
    for (int bit = 0; bit < kCellBits; ++bit) code |= (cell >> bit & 1) << (3 * bit + c);
  }
  return code;
}

// The least box of floats about a light's sphere, widened by more than its roundings: a gap between it and another box
// is at least the root of the light's cut.
Bounds sphere_box(const float* place, float cut2) {
  const float radius = std::sqrt(cut2) * (1.0f + 0x1p-20f);
  Bounds out;
  for (int c = 0; c < 3; ++c) {
    const float slack = (std::abs(place[c]) + radius) * 0x1p-20f;
    out.low[c] = place[c] - radius - slack;
    out.high[c] = place[c] + radius + slack;
  }
  return out;
}

// Lights by cell: where each cell's begin, then each light into its place.
std::vector<uint32_t> along_curve(const LightTable& lights, const std::vector<uint32_t>& bounded, const Bounds& all,
                                  int threads) {
  constexpr size_t kCells = size_t(1) << (3 * kCellBits), kChunk = 4096;
  std::vector<uint32_t> cell(bounded.size()), first(kCells + 1), order(bounded.size());
  parallel_for(int((bounded.size() + kChunk - 1) / kChunk), threads, [&](int chunk) {
    const size_t end = std::min(bounded.size(), (size_t(chunk) + 1) * kChunk);
    for (size_t i = size_t(chunk) * kChunk; i < end; ++i) {
      const Place at(lights, bounded[i]);
      cell[i] = cell_of(at.at, all);
    }
  });
  for (const uint32_t c : cell) ++first[c + 1];
  for (size_t c = 0; c < kCells; ++c) first[c + 1] += first[c];
  for (size_t i = 0; i < bounded.size(); ++i) order[first[cell[i]]++] = bounded[i];
  return order;
}

void resize(GroupBoxes& boxes, size_t count) {
  boxes.count = count;
  for (auto& side : boxes.low) side.assign((count + 15) / 16 * 16, kInfinity);
  for (auto& side : boxes.high) side.assign((count + 15) / 16 * 16, -kInfinity);
}

void put(GroupBoxes& boxes, size_t i, const Bounds& b) {
  for (int c = 0; c < 3; ++c) boxes.low[c][i] = b.low[c], boxes.high[c][i] = b.high[c];
}

}  // namespace

LightGroups make_light_groups(const LightTable& lights, int threads) {
  LightGroups out;
  if (lights.size() < LightGroups::kFewest) return out;
  std::vector<uint32_t> bounded;
  bounded.reserve(lights.size());
  Bounds all;
  for (uint32_t i = 0; i < lights.size(); ++i) {
    if (!std::isfinite(lights.cut2[i])) {
      out.always.push_back(i);
      continue;
    }
    const Place place(lights, i);
    bounded.push_back(i);
    all.add(place.at, place.at);
  }
  if (bounded.size() < LightGroups::kFewest) return {};
  out.light = along_curve(lights, bounded, all, threads);
  constexpr size_t kGroup = LightGroups::kGroup;
  const size_t groups = (out.light.size() + kGroup - 1) / kGroup, clusters = (groups + kGroup - 1) / kGroup;
  for (auto& stream : out.position) stream.resize(groups * kGroup, 0.0f);
  out.cut2.resize(groups * kGroup, 0.0f);
  resize(out.groups, groups);
  resize(out.clusters, clusters);
  parallel_for(int(clusters), threads, [&](int cluster) {
    Bounds of_cluster;
    for (size_t g = size_t(cluster) * kGroup; g < std::min(groups, size_t(cluster + 1) * kGroup); ++g) {
      Bounds of_group;
      for (size_t i = g * kGroup; i < std::min(out.light.size(), (g + 1) * kGroup); ++i) {
        const Place place(lights, out.light[i]);
        out.cut2[i] = lights.cut2[out.light[i]];
        for (int c = 0; c < 3; ++c) out.position[c][i] = place.at[c];
        const Bounds sphere = sphere_box(place.at, out.cut2[i]);
        of_group.add(sphere.low, sphere.high);
      }
      put(out.groups, g, of_group);
      of_cluster.add(of_group.low, of_group.high);
    }
    put(out.clusters, size_t(cluster), of_cluster);
  });
  return out;
}

}  // namespace trueshade
