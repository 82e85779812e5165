#include "raster/visibility/placed_scene.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/visibility/placed_scene.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/threads/parallel_for.h"
#include "raster/clusters/cluster_bounds.h"
#include "raster/visibility/coverage-inl.h"
#include "raster/visibility/hierarchical_depth-inl.h"
#include "raster/visibility/fast/thin_triangles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// What placing a chunk reads and writes.
struct Placing {
  const View& view;
  const GeometryState& state;
  PlacedChunk& out;

  bool keeps(int facing) const { return facing != 0 && !culled(state, (facing > 0) != view.window.upper_left); }
};

int facing_of(const WindowTriangle& t) {
  const int64_t area = (t.x[1] - t.x[0]) * (t.y[2] - t.y[0]) - (t.x[2] - t.x[0]) * (t.y[1] - t.y[0]);
  return (area > 0) - (area < 0);
}

bool fits_vectors(const WindowTriangle& window) {
  bool fits = true;
  for (int k = 0; k < 3; ++k)
    fits = fits && std::abs(window.x[k]) < kVectorLimit && std::abs(window.y[k]) < kVectorLimit;
  return fits;
}

void place_careful(const Placing& in, const ClipVertex v[3], uint32_t instance) {
  const CarefulPieces fan = careful_pieces(v, in.view.window, 0, 0);
  if (fan.count == 0 || !in.keeps(fan.facing)) return;
  if (fan.turned) {
    in.out.triangles.push_back({{}, instance, int32_t(in.out.turned.size())});
    in.out.turned.push_back({v[0], v[1], v[2]});
    return;
  }
  for (int i = 0; i < fan.count; ++i) {
    const WindowTriangle& piece = fan.piece[i].triangle;
    in.out.triangles.push_back({piece, instance, fits_vectors(piece) ? PlacedTriangle::kUsual : PlacedTriangle::kWide});
  }
}

void place_cluster(const Placing& in, const ClusteredMesh& mesh, const Cluster& cluster, uint32_t instance,
                   WindowVertices& v) {
  const D32 df;
  const InstanceTransform& transform = in.view.instances[instance];
  window_vertices(mesh, cluster, transform, in.view.window, {0, 0}, false, v);
  for (uint32_t i = 0; i < cluster.triangles; ++i) {
    const size_t at = cluster.first_triangle + i;
    const size_t corner[3] = {mesh.corner[0][at], mesh.corner[1][at], mesh.corner[2][at]};
    if (v.any_needs_care && (v.needs_care[corner[0]] | v.needs_care[corner[1]] | v.needs_care[corner[2]]) != 0) {
      ClipVertex clip[3];
      for (size_t k = 0; k < 3; ++k) {
        V32 p[3];
        for (size_t c = 0; c < 3; ++c) p[c] = hn::Set(df, mesh.position[c][cluster.first_vertex + corner[k]]);
        for (int r = 0; r < 4; ++r) clip[k].c[r] = hn::GetLane(affine_row(transform.clip[r], p[0], p[1], p[2]));
      }
      place_careful(in, clip, instance);
      continue;
    }
    PlacedTriangle placed{{}, instance, PlacedTriangle::kUsual};
    for (size_t k = 0; k < 3; ++k) {
      placed.window.x[k] = v.x[corner[k]];
      placed.window.y[k] = v.y[corner[k]];
      placed.window.z[k] = v.z[corner[k]];
    }
    if (in.keeps(facing_of(placed.window))) in.out.triangles.push_back(placed);
  }
}

void place_instances_simd(const Scene& scene, const ClusteredScene& clusters, const View& view,
                          const GeometryState& state, uint32_t first, uint32_t end, PlacedChunk& out) {
  const Placing in{view, state, out};
  WindowVertices vertices;
  for (uint32_t i = first; i < end; ++i) {
    const ClusteredMesh& mesh = clusters.meshes[scene.instances[i].mesh];
    if (!may_be_seen(mesh.boxes, view.instances[i], view.window, uint32_t(mesh.clusters.size()))) continue;
    for (const Cluster& cluster : mesh.clusters) place_cluster(in, mesh, cluster, i, vertices);
  }
}

/// One whose coordinates fit vectors.
void draw_triangle(const WindowTriangle& window, const WindowTransform& t, const GeometryState& state,
                   const TileRect& rect, DepthCommit& commit) {
  TriangleSetup<double> setup;
  if (!set_up_triangle(window, state, t.upper_left, rect.limit, setup)) return;
  if (setup.samples() <= 4)
    cover_samples(setup, rect, commit);
  else
    cover(setup, rect, commit);
}

/// Usual triangles of a tile that wait for others to be set up with, a lane each.
class TriangleBatch {
 public:
  TriangleBatch(const GeometryState& state, bool upper_left, const TileRect& rect, DepthCommit& commit)
      : in_{vertices_, state, upper_left, rect}, commit_(commit) {
    const int* limit = rect.limit;
    limited_ = ((limit[0] | limit[1] | limit[2] | limit[3]) & (kBlockSize - 1)) != 0;
  }

  HWY_INLINE void add(const WindowTriangle& window) {
    for (int k = 0; k < 3; ++k) {
      vertices_.x[3 * count_ + k] = int32_t(window.x[k]);
      vertices_.y[3 * count_ + k] = int32_t(window.y[k]);
      vertices_.z[3 * count_ + k] = window.z[k];
    }
    corners_[count_] = 3 * count_ * 0x10101 + 0x20100;
    id_[count_] = commit_.id;
    if (++count_ == int(hn::Lanes(DT()))) draw();
  }

  HWY_INLINE void draw() {
    if (count_ == 0) return;
    LargeSetups setups;
    SlenderSetups slender;
    SlenderSamples samples;
    set_up_large(in_, corners_, count_, commit_, setups);
    set_up_slender(setups, in_.rect, slender);
    for (int i = 0; i < count_; ++i) {
      commit_.id = id_[i];
      if ((setups.too_long >> i & 1) != 0) {
        WindowTriangle window;
        for (int k = 0; k < 3; ++k) {
          window.x[k] = vertices_.x[3 * i + k], window.y[k] = vertices_.y[3 * i + k];
          window.z[k] = vertices_.z[3 * i + k];
        }
        draw_window_triangle(window, in_.state, in_.upper_left, in_.rect, commit_);
      } else if ((setups.drawn >> i & 1) == 0) {
        continue;
      } else if ((slender.slender >> i & 1) == 0) {
        LargeTriangle(setups, i).draw(in_.rect, limited_, commit_);
      } else {
        samples.count = 0;
        cover_slender(setups, slender, i, in_.rect, samples);
        commit_slender(setups, i, in_.rect.size, samples, commit_);
      }
    }
    count_ = 0;
  }

 private:
  WindowVertices vertices_;
  LargeDraw in_;
  DepthCommit& commit_;
  bool limited_;
  int count_ = 0;
  alignas(64) int32_t corners_[LargeSetups::kMost] = {};
  uint32_t id_[LargeSetups::kMost];
};

constexpr uint32_t kAhead = 8;  // triangles fetched ahead: they lie scattered

void draw_placed_simd(const PlacedScene& placed, const View& view, const GeometryState& state, int tile, bool culling,
                      bool fast_paths, VisibilityTile& out) {
  const WindowTransform& t = view.window;
  const TileRect rect = tile_rect(t, placed.tile, placed.tiles_x, tile);
  const SampleOrigin origin = sample_origin(rect.x, rect.y);
  const bool nearest_wins = state.depth_func == DepthFunc::less || state.depth_func == DepthFunc::lequal;
  DepthCommit commit{out, state.depth_func, t.depth_low, t.depth_high, culling && nearest_wins, t.depth};
  commit.fast = fast_paths && commit.skip_hidden;
  const bool cull = commit.skip_hidden && !t.depth.may_come_nearer();
  const bool batched = commit.fast && !t.depth.offsets();
  TriangleBatch batch(state, t.upper_left, rect, commit);
  for (int block = 0; block < rect.size * rect.size / kBlockPixels; ++block) commit.finish_block(block);
  for (const PlacedChunk& chunk : placed.chunks)
    for (uint32_t i = chunk.first[size_t(tile)]; i < chunk.first[size_t(tile) + 1]; ++i) {
      const TilePlace& place = chunk.list[i];
      if (i + kAhead < chunk.list.size()) hwy::Prefetch(&chunk.triangles[chunk.list[i + kAhead].triangle]);
      if (cull && hidden_blocks(out, rect.size / kBlockSize, {place.x0, place.y0, place.x1, place.y1}, place.near))
        continue;
      const PlacedTriangle& triangle = chunk.triangles[place.triangle];
      commit.id = triangle.instance + 1;
      if (triangle.turned >= 0) {
        draw_careful(chunk.turned[size_t(triangle.turned)].data(), t, origin, state, rect, commit);
        continue;
      }
      WindowTriangle window = triangle.window;
      for (int k = 0; k < 3; ++k) window.x[k] -= origin.x, window.y[k] -= origin.y;
      if (triangle.turned == PlacedTriangle::kWide)
        draw_window_triangle(window, state, t.upper_left, rect, commit);
      else if (batched)
        batch.add(window);
      else
        draw_triangle(window, t, state, rect, commit);
    }
  if (batched) batch.draw();
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trueshade {
HWY_EXPORT(place_instances_simd);
HWY_EXPORT(draw_placed_simd);

namespace {

constexpr uint32_t kInstances = 64;  // of a chunk

/// Pixels whose samples coordinates in [least, most] reach, of [low, high).
struct PixelSpan {
  int first, last;  ///< inclusive
};
PixelSpan pixel_span(int64_t least, int64_t most, int low, int high) {
  const int64_t half = kSubpixels / 2;
  return {int(std::clamp<int64_t>((least - half + kSubpixels - 1) >> kSubpixelBits, low, high)),
          int(std::clamp<int64_t>((most - half) >> kSubpixelBits, low - 1, high - 1))};
}

/// Edge functions of a triangle in f64, turned so that they are positive inside: of samples of the window, in 1/256.
class WindowEdges {
 public:
  explicit WindowEdges(const WindowTriangle& t) {
    const double area =
        double(t.x[1] - t.x[0]) * double(t.y[2] - t.y[0]) - double(t.x[2] - t.x[0]) * double(t.y[1] - t.y[0]);
    for (int i = 0; i < 3; ++i) {
      const int a = (i + 1) % 3, b = (i + 2) % 3;
      const double sign = area < 0.0 ? -1.0 : 1.0;
      x_[i] = double(t.x[a]), y_[i] = double(t.y[a]);
      up_[i] = sign * double(t.x[b] - t.x[a]), across_[i] = -sign * double(t.y[b] - t.y[a]);
    }
  }

  /// Whether all samples of a box lie outside of one edge, by more than all roundings.
  bool beside(double x0, double y0, double x1, double y1) const {
    for (int i = 0; i < 3; ++i) {
      const double a = across_[i] * ((across_[i] > 0.0 ? x1 : x0) - x_[i]),
                   b = up_[i] * ((up_[i] > 0.0 ? y1 : y0) - y_[i]);
      if (a + b < -(std::abs(a) + std::abs(b)) * 0x1p-40) return true;
    }
    return false;
  }

 private:
  double x_[3], y_[3], across_[3], up_[3];
};

/// Calls use(tile, blocks) for the tiles that a triangle may touch.
template <class Use>
void for_each_tile(const PlacedTriangle& triangle, const WindowTransform& t, const PlacedScene& grid, const Use& use) {
  PixelSpan across{t.x0, t.x1 - 1}, up{t.y0, t.y1 - 1};
  const WindowTriangle& w = triangle.window;
  if (triangle.turned < 0) {
    const auto [left, right] = std::minmax({w.x[0], w.x[1], w.x[2]});
    const auto [bottom, top] = std::minmax({w.y[0], w.y[1], w.y[2]});
    across = pixel_span(left, right, t.x0, t.x1), up = pixel_span(bottom, top, t.y0, t.y1);
  }
  if (across.first > across.last || up.first > up.last) return;
  const int x0 = across.first / grid.tile, x1 = across.last / grid.tile;
  const int y0 = up.first / grid.tile, y1 = up.last / grid.tile;
  const bool several = triangle.turned < 0 && (x0 != x1 || y0 != y1);
  std::optional<WindowEdges> edges;
  if (several) edges.emplace(w);
  const auto block = [&](int pixel, int column) {
    return uint8_t(std::clamp(pixel - column * grid.tile, 0, grid.tile - 1) / kBlockSize);
  };
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      const double left = double(x * grid.tile) * 256.0, bottom = double(y * grid.tile) * 256.0;
      const double side = double(grid.tile) * 256.0;
      if (several && edges->beside(left, bottom, left + side, bottom + side)) continue;
      use(uint32_t(y * grid.tiles_x + x),
          TilePlace{0, 0.0f, block(across.first, x), block(up.first, y), block(across.last, x), block(up.last, y)});
    }
}

/// The least depth of a triangle that is compared; of what clipping leaves of any other nothing is known.
float near_depth(const PlacedTriangle& triangle, const WindowTransform& t) {
  if (triangle.turned != PlacedTriangle::kUsual) return -std::numeric_limits<float>::infinity();
  const auto least = float(std::min({triangle.window.z[0], triangle.window.z[1], triangle.window.z[2]}));
  return t.depth.stored(std::min(std::max(least, t.depth_low), t.depth_high));
}

/// Lists a chunk's triangles by tile.
void list_by_tile(const WindowTransform& t, const PlacedScene& grid, PlacedChunk& chunk) {
  struct Touch {
    uint32_t tile;
    TilePlace place;
  };
  std::vector<Touch> touches;
  touches.reserve(2 * chunk.triangles.size());
  chunk.first.assign(size_t(grid.tiles()) + 1, 0);
  for (uint32_t i = 0; i < chunk.triangles.size(); ++i) {
    const float near = near_depth(chunk.triangles[i], t);
    for_each_tile(chunk.triangles[i], t, grid, [&](uint32_t tile, TilePlace place) {
      place.triangle = i, place.near = near;
      touches.push_back({tile, place});
      ++chunk.first[tile + 1];
    });
  }
  for (size_t tile = 1; tile < chunk.first.size(); ++tile) chunk.first[tile] += chunk.first[tile - 1];
  chunk.list.resize(touches.size());
  std::vector<uint32_t> next(chunk.first.begin(), chunk.first.end() - 1);
  for (const Touch& touch : touches) chunk.list[next[touch.tile]++] = touch.place;
}

}  // namespace

bool PlacedScene::empty(int tile) const {
  return std::all_of(chunks.begin(), chunks.end(), [tile](const PlacedChunk& chunk) {
    return chunk.first[size_t(tile)] == chunk.first[size_t(tile) + 1];
  });
}

PlacedScene place_scene(const Scene& scene, const ClusteredScene& clusters, const View& view,
                        const GeometryState& state, uint32_t first, uint32_t end, int tile, int threads) {
  PlacedScene out{tile, (view.width + tile - 1) / tile, (view.height + tile - 1) / tile, {}};
  out.chunks.resize((end - first + kInstances - 1) / kInstances);
  parallel_for(int(out.chunks.size()), threads, [&](int i) {
    const uint32_t from = first + uint32_t(i) * kInstances;
    PlacedChunk& chunk = out.chunks[size_t(i)];
    HWY_DYNAMIC_DISPATCH(place_instances_simd)
    (scene, clusters, view, state, from, std::min(end, from + kInstances), chunk);
    list_by_tile(view.window, out, chunk);
  });
  return out;
}

void draw_placed(const PlacedScene& placed, const View& view, const GeometryState& state, int tile, bool culling,
                 bool fast_paths, VisibilityTile& out) {
  HWY_DYNAMIC_DISPATCH(draw_placed_simd)(placed, view, state, tile, culling, fast_paths, out);
}

TileRect tile_rect(const WindowTransform& window, int size, int tiles_x, int tile) {
  const int x = tile % tiles_x * size, y = tile / tiles_x * size;
  const auto in_tile = [size](int v) { return std::clamp(v, 0, size); };
  return {x, y, size, {in_tile(window.x0 - x), in_tile(window.y0 - y), in_tile(window.x1 - x), in_tile(window.y1 - y)}};
}

}  // namespace trueshade
#endif  // HWY_ONCE
