#include "raster/cluster_bins.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/fp_env.h"
#include "raster/fixed_point.h"

namespace trueshade {
namespace {

// Interval arithmetic on clip coordinates: what a cluster's box can reach, wider than any rounding of the vertex stage.
// A float row of four products and three sums is off by less than 2^-21 of the sum of its terms' magnitudes.
struct Interval {
  double low, high;
};

Interval row_interval(const float row[4], const Cluster& cluster) {
  double middle = double(row[3]), reach = 0.0, magnitude = std::abs(double(row[3]));
  for (int i = 0; i < 3; ++i) {
    const double m = double(row[i]), center = double(cluster.center[i]), half = double(cluster.half_size[i]);
    middle += m * center;
    reach += std::abs(m) * half;
    magnitude += std::abs(m) * (std::abs(center) + half);
  }
  const double slack = magnitude * 0x1p-20 + 0x1p-120;
  return {middle - reach - slack, middle + reach + slack};
}

Interval quotient(const Interval& a, const Interval& w) {  // w.low > 0
  return {a.low / (a.low < 0.0 ? w.low : w.high), a.high / (a.high < 0.0 ? w.high : w.low)};
}

// Pixels [first, last] that an interval of normalized device coordinates can cover, one more on either side.
bool pixel_span(const Interval& ndc, const WindowTransform& t, int axis, int low, int high, int& first, int& last) {
  double a = (ndc.low * double(t.scale[axis]) + double(t.offset[axis])) / 256.0;
  double b = (ndc.high * double(t.scale[axis]) + double(t.offset[axis])) / 256.0;
  if (a > b) std::swap(a, b);
  if (!(b >= double(low) - 1.0) || !(a <= double(high) + 1.0)) return false;
  first = int(std::max(a - 1.0, double(low)));
  last = int(std::min(b + 1.0, double(high - 1)));
  return first <= last;
}

// Whether a box in front of the near plane lies wholly where place_vertices() finds nothing that needs care.
bool needs_no_care(const WindowTransform& t, const Interval& x, const Interval& y, const Interval& z,
                   const Interval& w) {
  constexpr double kInside = double(kVectorLimit) / 2.0;
  const auto fits = [&](const Interval& ndc, int axis) {
    const double scale = std::abs(double(t.scale[axis])), offset = std::abs(double(t.offset[axis]));
    return std::max(std::abs(ndc.low), std::abs(ndc.high)) * scale + offset < kInside;
  };
  return !t.float_snap && w.low >= 0x1p-100 && (t.depth_clamp || z.high <= w.low) && fits(quotient(x, w), 0) &&
         fits(quotient(y, w), 1);
}

struct Binner {
  const View& view;
  bool culling;

  static void cover(int x0, int y0, int x1, int y1, ClusterDraw& draw) {  // pixels, inclusive
    draw.x0 = uint16_t(x0);
    draw.y0 = uint16_t(y0);
    draw.x1 = uint16_t(x1);
    draw.y1 = uint16_t(y1);
  }

  // False if the cluster cannot be seen.
  bool bound(const InstanceTransform& instance, const Cluster& cluster, ClusterDraw& draw) const {
    const WindowTransform& t = view.window;
    draw.near_depth = -std::numeric_limits<float>::infinity();
    draw.plain = false;
    cover(t.x0, t.y0, t.x1 - 1, t.y1 - 1, draw);
    if (!culling) return true;
    const Interval x = row_interval(instance.clip[0], cluster), y = row_interval(instance.clip[1], cluster),
                   z = row_interval(instance.clip[2], cluster), w = row_interval(instance.clip[3], cluster);
    if (!std::isfinite(x.low + x.high + y.low + y.high + z.low + z.high + w.low + w.high)) return true;
    if (w.high <= 0.0) return false;
    const double near = t.zero_to_one ? 0.0 : -w.high;
    if (!t.depth_clamp && (z.high < near || z.low > w.high)) return false;
    if (w.low <= 0.0 || (!t.depth_clamp && z.low < (t.zero_to_one ? 0.0 : -w.low))) return true;  // clipping to come
    int x0, y0, x1, y1;
    if (!pixel_span(quotient(x, w), t, 0, t.x0, t.x1, x0, x1) || !pixel_span(quotient(y, w), t, 1, t.y0, t.y1, y0, y1))
      return false;
    cover(x0, y0, x1, y1, draw);
    draw.plain = needs_no_care(t, x, y, z, w);
    const Interval depth = quotient(z, w);
    const double nearest = std::min(depth.low * t.z_scale, depth.high * t.z_scale) + t.z_offset;
    draw.near_depth = float(nearest - std::abs(nearest) * 0x1p-20 - 0x1p-24);
    return true;
  }
};

// Instances x clusters as one long row, cut into equal pieces for the threads.
struct Row {
  std::vector<uint64_t> first;  // of each instance; one more at the end

  Row(const Scene& scene, const ClusteredScene& clusters) : first(1, 0) {
    for (const Instance& instance : scene.instances)
      first.push_back(first.back() + clusters.meshes[instance.mesh].clusters.size());
  }
};

constexpr uint64_t kChunk = 1024;

std::vector<ClusterDraw> seen_clusters(const Scene& scene, const ClusteredScene& clusters, const View& view,
                                       bool culling, int threads) {
  const Row row(scene, clusters);
  const uint64_t all = row.first.back();
  const int chunks = int((all + kChunk - 1) / kChunk);
  std::vector<std::vector<ClusterDraw>> seen(static_cast<size_t>(chunks));
  const Binner binner{view, culling};
  parallel_for(chunks, threads, [&](int chunk) {
    uint64_t at = uint64_t(chunk) * kChunk;
    const uint64_t end = std::min(all, at + kChunk);
    size_t instance = size_t(std::upper_bound(row.first.begin(), row.first.end(), at) - row.first.begin()) - 1;
    for (; at < end; ++at) {
      while (at >= row.first[instance + 1]) ++instance;
      ClusterDraw draw{uint32_t(instance), uint32_t(at - row.first[instance]), 0.0f, false, 0, 0, 0, 0};
      const Cluster& cluster = clusters.meshes[scene.instances[instance].mesh].clusters[draw.cluster];
      if (binner.bound(view.instances[instance], cluster, draw)) seen[size_t(chunk)].push_back(draw);
    }
  });
  std::vector<ClusterDraw> draws;
  size_t total = 0;
  for (const auto& part : seen) total += part.size();
  draws.reserve(total);
  for (const auto& part : seen) draws.insert(draws.end(), part.begin(), part.end());
  return draws;
}

}  // namespace

ClusterBins bin_clusters(const Scene& scene, const ClusteredScene& clusters, const View& view, int tile, bool culling,
                         int threads) {
  ClusterBins bins;
  bins.tile = tile;
  bins.tiles_x = (view.width + tile - 1) / tile;
  bins.tiles_y = (view.height + tile - 1) / tile;
  bins.first.assign(size_t(bins.tiles_x) * size_t(bins.tiles_y) + 1, 0);
  const WindowTransform& t = view.window;
  if (t.x0 >= t.x1 || t.y0 >= t.y1) return bins;
  bins.draws = seen_clusters(scene, clusters, view, culling, threads);

  const auto for_each_tile = [&](const ClusterDraw& draw, auto&& visit) {
    for (int y = draw.y0 / tile; y <= draw.y1 / tile; ++y)
      for (int x = draw.x0 / tile; x <= draw.x1 / tile; ++x) visit(size_t(y) * size_t(bins.tiles_x) + size_t(x));
  };
  for (const ClusterDraw& draw : bins.draws) for_each_tile(draw, [&](size_t i) { ++bins.first[i + 1]; });
  for (size_t i = 1; i < bins.first.size(); ++i) {
    if (bins.first[i] > kMaxTileClusters)
      throw Error(ErrorKind::limit, "scene", "more than 16777214 clusters of 126 triangles touch one tile",
                  "use smaller tiles or fewer triangles");
    bins.first[i] += bins.first[i - 1];
  }
  bins.list.resize(bins.first.back());
  std::vector<uint64_t> next(bins.first.begin(), bins.first.end() - 1);
  for (uint32_t i = 0; i < bins.draws.size(); ++i)
    for_each_tile(bins.draws[i], [&](size_t k) { bins.list[next[k]++] = i; });
  return bins;
}

}  // namespace trueshade
