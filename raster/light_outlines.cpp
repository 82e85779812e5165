#include "raster/light_outlines.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/light_outlines.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>

#include "core/fp_env.h"
#include "raster/coverage-inl.h"
#include "raster/outline-inl.h"

// Once in all, though the file is read once per target.
#ifndef TRUESHADE_RASTER_PLACED_MESH
#define TRUESHADE_RASTER_PLACED_MESH
namespace trueshade {

/// Vertices of one light's mesh.
struct PlacedMesh {
  std::vector<glm::vec3> world;
  std::vector<float> clip[4];
  std::vector<int32_t> x, y;  ///< window, relative to an origin
  std::vector<double> z;
  std::vector<int32_t> needs_care;
  bool any_needs_care = false;
};

}  // namespace trueshade
#endif

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void place_mesh_simd(const LightMesh& mesh, const Light& light, const View& view, const WindowTransform& window,
                     const int origin_fx[2], PlacedMesh& out) {
  const D32 df;
  const SampleOrigin origin{origin_fx[0], origin_fx[1]};
  const size_t count = mesh.unit.size(), padded = (count + kClusterVertices - 1) / kClusterVertices * kClusterVertices;
  out.world.resize(count);
  light_vertices(mesh, light, out.world);
  for (auto& stream : out.clip) stream.resize(padded);
  out.x.resize(padded), out.y.resize(padded), out.z.resize(padded), out.needs_care.resize(padded);
  alignas(64) float p[3][kClusterVertices];
  WindowVertices v;
  out.any_needs_care = false;
  for (size_t from = 0; from < count; from += kClusterVertices) {
    const size_t here = std::min<size_t>(kClusterVertices, count - from);
    const size_t vectors_end = (here + hn::Lanes(df) - 1) / hn::Lanes(df) * hn::Lanes(df);
    for (size_t i = 0; i < vectors_end; ++i)
      for (int c = 0; c < 3; ++c) p[c][i] = out.world[from + std::min(i, here - 1)][c];
    for (size_t i = 0; i < vectors_end; i += hn::Lanes(df)) {
      const V32 x = hn::Load(df, p[0] + i), y = hn::Load(df, p[1] + i), z = hn::Load(df, p[2] + i);
      V32 clip[4];
      for (size_t r = 0; r < 4; ++r) {
        clip[r] = affine_row(view.clip_from_world.data() + 4 * r, x, y, z);
        hn::StoreU(clip[r], df, out.clip[r].data() + from + i);
      }
      const bool care = place_vertices(clip[0], clip[1], clip[2], clip[3], window, origin, i, v);
      out.any_needs_care = out.any_needs_care || care;
    }
    std::copy_n(v.x, here, out.x.data() + from);
    std::copy_n(v.y, here, out.y.data() + from);
    std::copy_n(v.z, here, out.z.data() + from);
    std::copy_n(v.needs_care, here, out.needs_care.data() + from);
  }
}

/// Counts covered samples, whatever their depth.
struct LayerCommit {
  uint16_t* counts;
  template <class T>
  void begin(const TriangleSetup<T>&) {}
  void begin_piece(const ClipVertex*, const CarefulPieces&, int, const WindowTransform&) {}
  bool hidden(int) const { return false; }
  HWY_INLINE bool vector(int at, M64 covered, const V64*) {
    const D64 d;
    alignas(64) double one[HWY_MAX_BYTES / sizeof(double)];
    hn::Store(hn::IfThenElseZero(covered, hn::Set(d, 1.0)), d, one);
    for (size_t i = 0; i < hn::Lanes(d); ++i)
      counts[size_t(at) + i] = uint16_t(counts[size_t(at) + i] + (one[i] != 0.0));
    return false;
  }
  bool scalar(int at, double, double, double) {
    ++counts[at];
    return false;
  }
  void finish_block(int) {}
};

void count_mesh_simd(const LightMesh& mesh, const PlacedMesh& placed, const GeometryState& state,
                     const WindowTransform& window, const TileRect& rect, uint16_t* counts) {
  LayerCommit commit{counts};
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    WindowTriangle triangle;
    ClipVertex clip[3];
    bool careful = false;
    for (size_t k = 0; k < 3; ++k) {
      const size_t corner = mesh.indices[i + k];
      triangle.x[k] = placed.x[corner];
      triangle.y[k] = placed.y[corner];
      triangle.z[k] = placed.z[corner];
      careful = careful || placed.needs_care[corner] != 0;
      for (size_t c = 0; c < 4; ++c) clip[k].c[c] = placed.clip[c][corner];
    }
    TriangleSetup<double> setup;
    if (careful)
      draw_careful(clip, window, sample_origin(rect.x, rect.y), state, rect, commit);
    else if (set_up_triangle(triangle, state, window.upper_left, rect.limit, setup))
      cover_blocks(setup, rect, commit);
  }
}

RegionCover region_cover_simd(const LightOutlines& outlines, size_t light, int x, int y, int width, int height,
                              RegionMasks& masks) {
  return polygon_cover(outlines, light, x, y, width, height, masks);
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trueshade {
HWY_EXPORT(region_cover_simd);
HWY_EXPORT(place_mesh_simd);
HWY_EXPORT(count_mesh_simd);
namespace {

constexpr int kWindowOrigin[2] = {0, 0};
constexpr int kChunk = 256;  // lights a task

/// The outline of one light, found on scratch that its chunk keeps.
struct OutlineMaker {
  PlacedMesh placed;
  std::vector<int8_t> drawn;   // by triangle: on the side that is drawn, or without area
  std::vector<uint32_t> next;  // by vertex: where the outline goes on
  std::vector<uint32_t> loop;  // vertices of the outline
  std::vector<int32_t> x, y;   // corners of all lights of the chunk

  struct Result {
    OutlineKind kind = OutlineKind::nothing;
    uint8_t layers = 1;
    int32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    uint32_t corners = 0;
  };

  static Result everywhere(OutlineKind kind, const WindowTransform& t) { return {kind, 1, t.x0, t.y0, t.x1, t.y1, 0}; }

  // Whether clipping leaves nothing of the mesh in the viewport: all of it is behind the camera, or beyond one side.
  bool out_of_view() const {
    const size_t count = placed.world.size();
    bool behind = true, side[4] = {true, true, true, true};
    for (size_t i = 0; i < count; ++i) {
      const float x = placed.clip[0][i], y = placed.clip[1][i], w = placed.clip[3][i];
      behind = behind && w <= 0.0f;
      side[0] = side[0] && x > w;
      side[1] = side[1] && x < -w;
      side[2] = side[2] && y > w;
      side[3] = side[3] && y < -w;
    }
    return behind || side[0] || side[1] || side[2] || side[3];
  }

  int64_t doubled_area(const LightMesh& mesh, size_t triangle) const {
    const uint32_t* v = &mesh.indices[3 * triangle];
    return int64_t(placed.x[v[1]] - placed.x[v[0]]) * (placed.y[v[2]] - placed.y[v[0]]) -
           int64_t(placed.x[v[2]] - placed.x[v[0]]) * (placed.y[v[1]] - placed.y[v[0]]);
  }

  // Vertices of the one loop around the triangles of a sign, in their direction; false if there is another number.
  bool find_loop(const LightMesh& mesh, int sign) {
    constexpr uint32_t kNone = UINT32_MAX;
    const size_t triangles = mesh.triangles();
    drawn.assign(triangles, 0);
    next.assign(mesh.unit.size(), kNone);
    for (size_t t = 0; t < triangles; ++t) {
      const int64_t area = doubled_area(mesh, t);
      drawn[t] = sign > 0 ? area >= 0 : area <= 0;
    }
    uint32_t start = kNone;
    size_t edges = 0;
    for (size_t i = 0; i < mesh.indices.size(); ++i) {
      if (drawn[i / 3] == 0 || drawn[mesh.neighbour[i]] != 0) continue;
      start = mesh.indices[i];
      if (next[start] != kNone) return false;
      next[start] = mesh.indices[i % 3 == 2 ? i - 2 : i + 1];
      ++edges;
    }
    loop.clear();
    for (uint32_t v = start; v != kNone && loop.size() < edges; v = next[v]) loop.push_back(v);
    return edges > 0 && loop.size() == edges && next[loop.back()] == start;
  }

  // Appends the loop's corners, counter-clockwise and without repeated points; false if it is not convex.
  bool add_polygon(int sign) {
    const size_t first = x.size();
    if (sign < 0) std::reverse(loop.begin(), loop.end());
    for (const uint32_t v : loop) {
      if (x.size() > first && x.back() == placed.x[v] && y.back() == placed.y[v]) continue;
      x.push_back(placed.x[v]);
      y.push_back(placed.y[v]);
    }
    while (x.size() > first + 1 && x.back() == x[first] && y.back() == y[first]) x.pop_back(), y.pop_back();
    const size_t corners = x.size() - first;
    int upward_turns = 0;
    bool convex = corners >= 3 && corners <= kMostOutlineCorners;
    for (size_t i = 0; i < corners && convex; ++i) {
      const size_t a = first + i, b = first + (i + 1) % corners, c = first + (i + 2) % corners;
      const int64_t ux = x[b] - x[a], uy = y[b] - y[a], vx = x[c] - x[b], vy = y[c] - y[b];
      const int64_t cross = ux * vy - uy * vx;
      convex = cross > 0 || (cross == 0 && ux * vx + uy * vy > 0);
      const auto up = [](int64_t dx, int64_t dy) { return dy > 0 || (dy == 0 && dx > 0); };
      upward_turns += !up(ux, uy) && up(vx, vy);
    }
    if (convex && upward_turns == 1) return true;
    x.resize(first);
    y.resize(first);
    return false;
  }

  Result outline(const LightMesh& mesh, const Light& light, const LightOutlines& all, const View& view) {
    const bool left_turn = !culled(all.state, !all.window.upper_left),
               right_turn = !culled(all.state, all.window.upper_left);
    if (!left_turn && !right_turn) return {};
    HWY_DYNAMIC_DISPATCH(place_mesh_simd)(mesh, light, view, all.window, kWindowOrigin, placed);
    if (placed.any_needs_care) return out_of_view() ? Result{} : everywhere(OutlineKind::mesh, all.window);
    Result out;
    const auto [left, right] =
        std::minmax_element(placed.x.begin(), placed.x.begin() + std::ptrdiff_t(placed.world.size()));
    const auto [low, high] =
        std::minmax_element(placed.y.begin(), placed.y.begin() + std::ptrdiff_t(placed.world.size()));
    // Samples in the box of vertices: (v - 128) / 256, rounded up and down.
    out.x0 = std::max((*left + 127) >> 8, all.window.x0);
    out.y0 = std::max((*low + 127) >> 8, all.window.y0);
    out.x1 = std::min(((*right - 128) >> 8) + 1, all.window.x1);
    out.y1 = std::min(((*high - 128) >> 8) + 1, all.window.y1);
    if (out.x0 >= out.x1 || out.y0 >= out.y1) return {};
    // The mesh is closed, so that its other side covers each sample as often.
    const int sign = left_turn ? 1 : -1;
    const size_t first = x.size();
    out.layers = left_turn && right_turn ? 2 : 1;
    out.kind = find_loop(mesh, sign) && add_polygon(sign) ? OutlineKind::polygon : OutlineKind::mesh;
    out.corners = uint32_t(x.size() - first);
    return out;
  }
};

}  // namespace

GeometryState light_geometry_state(const Pipeline& pipeline) {
  GeometryState state = pipeline.geometry;
  state.cull_face = pipeline.light_volumes.cull_face;
  state.front_face = FrontFace::ccw;
  state.depth_clamp = pipeline.light_volumes.depth_clamp;
  return state;
}

LightOutlines make_light_outlines(std::span<const Light> lights, const Pipeline& pipeline, const LightMeshes& meshes,
                                  const View& view, int threads) {
  LightOutlines out;
  out.state = light_geometry_state(pipeline);
  out.window = window_transform(out.state, pipeline.width, pipeline.height, pipeline.profile);
  const size_t padded = (lights.size() + 15) / 16 * 16;
  out.kind.resize(lights.size());
  out.layers.resize(lights.size());
  for (auto* side : {&out.x0, &out.y0, &out.x1, &out.y1}) side->resize(padded);
  out.first.resize(lights.size() + 1);
  const int chunks = int((lights.size() + kChunk - 1) / kChunk);
  std::vector<OutlineMaker> makers(static_cast<size_t>(chunks));
  parallel_for(chunks, threads, [&](int chunk) {
    OutlineMaker& maker = makers[size_t(chunk)];
    for (size_t i = size_t(chunk) * kChunk; i < std::min(lights.size(), size_t(chunk + 1) * kChunk); ++i) {
      const LightExtent extent = drawn_extent(lights[i], pipeline.light_volumes);
      const OutlineMaker::Result r = is_mesh(extent) ? maker.outline(meshes[extent], lights[i], out, view)
                                                     : OutlineMaker::everywhere(OutlineKind::everywhere, out.window);
      out.kind[i] = r.kind;
      out.layers[i] = r.layers;
      out.x0[i] = r.x0, out.y0[i] = r.y0, out.x1[i] = r.x1, out.y1[i] = r.y1;
      out.first[i + 1] = r.corners;
    }
  });
  for (size_t i = 0; i < lights.size(); ++i) out.first[i + 1] += out.first[i];
  for (const OutlineMaker& maker : makers) {
    out.x.insert(out.x.end(), maker.x.begin(), maker.x.end());
    out.y.insert(out.y.end(), maker.y.begin(), maker.y.end());
  }
  return out;
}

RegionCover region_cover(const LightOutlines& outlines, size_t light, int x, int y, int width, int height,
                         RegionMasks& masks) {
  return HWY_DYNAMIC_DISPATCH(region_cover_simd)(outlines, light, x, y, width, height, masks);
}

int count_light_mesh(const LightMesh& mesh, const Light& light, const LightOutlines& outlines, const View& view,
                     const TileRect& rect, uint16_t* counts) {
  const size_t pixels = size_t(rect.size) * size_t(rect.size);
  std::fill_n(counts, pixels, uint16_t(0));
  const int sample[2] = {rect.x * 256 + 128, rect.y * 256 + 128};
  PlacedMesh placed;
  HWY_DYNAMIC_DISPATCH(place_mesh_simd)(mesh, light, view, outlines.window, sample, placed);
  HWY_DYNAMIC_DISPATCH(count_mesh_simd)(mesh, placed, outlines.state, outlines.window, rect, counts);
  return *std::max_element(counts, counts + pixels);
}

}  // namespace trueshade
#endif  // HWY_ONCE
