#pragma once
// A frame by other means: every triangle at every pixel, one at a time, from the formulas of docs/arithmetic.md read as
// mathematics (long double where the renderer works in float and double). It shares no arithmetic with the renderer.
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "oracle/exact_coverage.h"
#include "oracle/matrices.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// Where each attribute lies in VertexValues, after clip x, y, z, w.
enum ValueIndex : size_t { kClip = 0, kPosition = 4, kNormal = 7, kAlbedo = 10, kUv = 14, kTangent = 26 };

/// Of u of a set of texture coordinates; v follows.
constexpr size_t uv_index(size_t set) { return kUv + 2 * set; }

/// One covered sample of one triangle.
struct Fragment {
  uint32_t instance = 0;
  uint32_t triangle = 0;  ///< index in the mesh, of the triangle as submitted
  uint32_t window = 0;    ///< index into ScalarFrame::triangles
  long double depth = 0;  ///< window z, exact plane of the snapped triangle, clamped as the state says
  float depth_code = 0;   ///< depth rounded to float, and to what the depth format holds
  float depth_bound = 0;  ///< |renderer's depth - depth| stays within this; 0 where depth_code is exact for certain
  bool doubtful = false;  ///< its alpha is too close to the material's cutoff to tell whether it is drawn
};

/// A triangle left after clipping, with the values no two vertices share.
struct DrawnTriangle {
  WindowTriangle window;
  uint32_t instance = 0, triangle = 0;
  std::array<long double, 3> depth{};  ///< window z at the vertices
  VertexValues provoking{};            ///< of the original triangle
  long double offset = 0;              ///< what glPolygonOffset adds
  long double offset_bound = 0;        ///< |renderer's offset - offset| stays within this
};

/// An interpolated value and what the renderer's may be: within `ulp` of `value`, and inside [lo, hi].
struct ValueRange {
  long double value = 0;
  double ulp = 0;         ///< spacing of floats at the largest |vertex value|
  double lo = 0, hi = 0;  ///< hull of the three vertices
};

struct ScalarFrame {
  int width = 0, height = 0;
  std::vector<DrawnTriangle> triangles;          ///< in submission order
  std::vector<std::vector<Fragment>> fragments;  ///< a pixel, row 0 at the bottom; in submission order
  const std::vector<Fragment>& at(int x, int y) const { return fragments[size_t(y) * size_t(width) + size_t(x)]; }
};

/// Rasterises every triangle; fragments the alpha test drops are left out. Memory is a fragment a covered sample: for
/// scenes of some 10^5 triangle-pixels.
ScalarFrame scalar_frame(const Scene& scene, const Pipeline& pipeline);

/// Which fragment is seen.
struct Visible {
  std::optional<size_t> fragment;  ///< index into the pixel's list; none: the clear value
  bool certain = true;             ///< false where a depth comparison on the way was closer than the bounds
};
Visible visible_fragment(const std::vector<Fragment>& fragments, const GeometryState& state);

/// Value `index` (a ValueIndex plus a component) at pixel (x, y), y up.
ValueRange value_at(const DrawnTriangle& triangle, size_t index, Interpolation interpolation, int x, int y);

/// The number a depth format of `state` holds for a float z in [0, 1]: the nearest code k as k / largest.
float held_depth(const GeometryState& state, float z);

/// Depth at pixel (x, y), with its offset, unclamped by the depth range.
long double depth_at(const DrawnTriangle& triangle, int x, int y);

/// gl_FragCoord.w: 1 / w interpolated in the window.
long double fragment_w(const DrawnTriangle& triangle, int x, int y);

/// The normal at pixel (x, y), y up, made unit length there where the state says so.
std::array<ValueRange, 3> normal_at(const DrawnTriangle& triangle, const GBufferState& state, int x, int y);

/// The values of one vertex as floats: clip position, world position and normal, colour times base colour, uv, the
/// world's tangent where the mesh has any.
VertexValues vertex_values(const Scene& scene, const Instance& instance, const Matrix4& clip_from_world,
                           UnitNormals unit_normals, uint32_t vertex);

}  // namespace trueshade::oracle
