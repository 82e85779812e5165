#include "oracle/scalar_renderer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "oracle/textured_surface.h"
#include "oracle/vectors.h"

namespace trueshade::oracle {

namespace {

/// Where every rounding is part of the definition: docs/arithmetic.md sections 1 and 2.
float affine(const std::array<float, 4>& row, float x, float y, float z) {
  return ((row[0] * x + row[1] * y) + row[2] * z) + row[3];
}

float component(std::span<const float> stream, uint32_t vertex, float absent) {
  return stream.empty() ? absent : stream[vertex];
}

/// The matrix times v, in float, and made unit length there where `unit` says so.
void world_normal(const std::array<std::array<float, 3>, 3>& rows, bool unit, const float v[3], float n[3]) {
  for (size_t r = 0; r < 3; ++r) n[r] = (rows[r][0] * v[0] + rows[r][1] * v[1]) + rows[r][2] * v[2];
  if (!unit) return;
  const float l2 = (n[0] * n[0] + n[1] * n[1]) + n[2] * n[2];
  const float scale = l2 > 0 ? 1.0f / std::sqrt(l2) : 0.0f;
  for (size_t r = 0; r < 3; ++r) n[r] *= scale;
}

std::array<Real, 3> weights(const DrawnTriangle& t, Interpolation interpolation, int x, int y) {
  const int64_t px = int64_t(x) * kSubpixels + kSubpixels / 2, py = int64_t(y) * kSubpixels + kSubpixels / 2;
  std::array<Real, 3> l{};
  Real sum = 0;
  for (int i = 0; i < 3; ++i) {
    l[size_t(i)] = Real(t.window.edge(i, px, py));
    if (interpolation == Interpolation::smooth) l[size_t(i)] /= Real(t.window.values[size_t(i)][3]);
    sum += l[size_t(i)];
  }
  for (Real& weight : l) weight /= sum;
  return l;
}

double float_spacing(double magnitude) {
  const float m = float(magnitude);
  return double(std::nextafter(m, std::numeric_limits<float>::infinity())) - double(m);
}

Real vertex_depth(const VertexValues& v, const GeometryState& state) {
  const Real z = Real(v[2]) / Real(v[3]), near = state.depth_near, far = state.depth_far;
  if (state.clip_depth == ClipDepth::zero_to_one) return z * (far - near) + near;
  return z * ((far - near) / 2) + (near + far) / 2;
}

/// Fixed-point depth of so many bits, 0 for floats.
int depth_bits(const GeometryState& state) {
  return state.depth_format == Format::d24 ? 24 : state.depth_format == Format::d16 ? 16 : 0;
}

/// GL 4.6 core, 14.6.5: m factor + r units, m the larger slope, r a code (llvmpipe: two) or the unit of the largest
/// |z|.
void set_polygon_offset(const Pipeline& pipeline, DrawnTriangle& t) {
  const GeometryState& state = pipeline.geometry;
  if (state.polygon_offset_factor == 0 && state.polygon_offset_units == 0) return;
  Real slope = 0, largest = 0, terms = 0;
  for (const Real z : t.depth) largest = std::max(largest, std::fabs(z));
  for (int axis = 0; axis < 2; ++axis) {
    Real change = 0;  // of z, over a pixel
    for (int i = 0; i < 3; ++i) {
      const int64_t px = axis == 0 ? kSubpixels : 0, py = axis == 1 ? kSubpixels : 0;
      const Real step = Real(t.window.edge(i, px, py) - t.window.edge(i, 0, 0));
      change += step * t.depth[size_t(i)];
      terms += std::fabs(step / Real(t.window.twice_area)) * largest;
    }
    slope = std::max(slope, std::fabs(change / Real(t.window.twice_area)));
  }
  const int bits = depth_bits(state);
  const Real code = 1 / (std::ldexp(Real(1), bits) - 1);
  const float most = float(std::clamp(largest, 0x1p-126L, 0x1p127L));
  const Real unit = bits == 0                                   ? std::ldexp(Real(1), std::ilogb(most) - 23)
                    : pipeline.profile == NumericProfile::ideal ? code
                                                                : 2 * code;
  t.offset = slope * Real(state.polygon_offset_factor) + unit * Real(state.polygon_offset_units);
  // Six roundings in double of terms that may cancel.
  t.offset_bound = terms * std::fabs(Real(state.polygon_offset_factor)) * 0x1p-49L + std::fabs(t.offset) * 0x1p-50L;
}

Fragment fragment_of(const DrawnTriangle& t, uint32_t index, const GeometryState& state, int x, int y) {
  Fragment f;
  f.instance = t.instance;
  f.triangle = t.triangle;
  f.window = index;
  const bool whole = (state.polygon_offset_factor != 0 || state.polygon_offset_units != 0) && !state.depth_clamp;
  const Real low = whole ? 0 : std::min(state.depth_near, state.depth_far);
  const Real high = whole ? 1 : std::max(state.depth_near, state.depth_far);
  f.depth = std::clamp(depth_at(t, x, y), low, high);
  f.depth_code = held_depth(state, float(f.depth));
  // The renderer's double formula has some ten roundings; where they cannot reach the next float, its code is ours.
  Real largest = 1;
  for (const Real z : t.depth) largest = std::max(largest, std::fabs(z) + std::fabs(t.offset));
  const Real slack = largest * 0x1p-47L + t.offset_bound;
  const auto code = [&](Real z) { return held_depth(state, float(std::clamp(z, low, high))); };
  const float below = code(f.depth - slack), above = code(f.depth + slack);
  if (below != above) f.depth_bound = std::max(float(float_spacing(double(f.depth))), above - below);
  return f;
}

/// The state with the faces of an instance: culling spares the backs of double-sided materials, and an instance that
/// mirrors has its front where others have their back.
GeometryState state_of(const Scene& scene, const Instance& instance, GeometryState state) {
  if (scene.materials[instance.material].double_sided) {
    const bool fronts = state.cull_face == CullFace::front || state.cull_face == CullFace::front_and_back;
    state.cull_face = fronts ? CullFace::front : CullFace::none;
  }
  if (instance.mirrored) state.front_face = state.front_face == FrontFace::cw ? FrontFace::ccw : FrontFace::cw;
  return state;
}

void turn_normals(DrawnTriangle& t) {
  for (size_t k = kNormal; k < kNormal + 3; ++k) {
    for (VertexValues& corner : t.window.values) corner[k] = -corner[k];
    t.provoking[k] = -t.provoking[k];
  }
}

}  // namespace

VertexValues vertex_values(const Scene& scene, const Instance& instance, const Matrix4& clip_from_world,
                           UnitNormals unit_normals, uint32_t vertex) {
  const Mesh& mesh = scene.meshes[instance.mesh];
  float object[3], normal[3], turned[3] = {0, 0, 0};
  for (size_t k = 0; k < 3; ++k) object[k] = mesh.position[k][vertex];
  for (size_t k = 0; k < 3; ++k) normal[k] = component(mesh.normal[k], vertex, 0.0f);
  VertexValues out{};
  const InstanceRows rows = instance_rows(instance, clip_from_world);
  for (size_t r = 0; r < 4; ++r) out[kClip + r] = double(affine(rows.clip[r], object[0], object[1], object[2]));
  for (size_t r = 0; r < 3; ++r) out[kPosition + r] = double(affine(rows.world[r], object[0], object[1], object[2]));
  world_normal(rows.normal, made_unit_at_vertex(unit_normals), normal, turned);
  for (size_t k = 0; k < 3; ++k) out[kNormal + k] = double(turned[k]);
  // The base colour multiplies after interpolation: these are the vertex colours alone.
  for (size_t k = 0; k < 4; ++k) out[kAlbedo + k] = double(component(mesh.color[k], vertex, 1.0f));
  for (size_t set = 0; set <= mesh.more_uv.size(); ++set) {
    const UvStreams& uv = set == 0 ? mesh.uv : mesh.more_uv[set - 1];
    for (size_t k = 0; k < 2; ++k) out[uv_index(set) + k] = double(component(uv[k], vertex, 0.0f));
  }
  for (size_t r = 0; r < 3 && mesh.has_tangents(); ++r) {
    const std::array<float, 4>& row = rows.world[r];
    const float x = mesh.tangent[0][vertex], y = mesh.tangent[1][vertex], z = mesh.tangent[2][vertex];
    out[kTangent + r] = double((row[0] * x + row[1] * y) + row[2] * z);
  }
  return out;
}

ScalarFrame scalar_frame(const Scene& scene, const Pipeline& pipeline) {
  const GeometryState& state = pipeline.geometry;
  const Viewport viewport = resolved_viewport(state, pipeline.width, pipeline.height);
  const Matrix4 clip_from_world = projection_of(scene.camera, state, pipeline.width, pipeline.height);
  ScalarFrame frame;
  frame.width = pipeline.width;
  frame.height = pipeline.height;
  frame.fragments.resize(size_t(frame.width) * size_t(frame.height));
  for (uint32_t instance = 0; instance < scene.instances.size(); ++instance) {
    const Instance& drawn = scene.instances[instance];
    const std::span<const uint32_t> indices = scene.meshes[drawn.mesh].indices;
    const GeometryState faced = state_of(scene, drawn, state);
    const bool both_sides = scene.materials[drawn.material].double_sided;
    const Mesh& mesh = scene.meshes[drawn.mesh];
    const size_t used = mesh.has_tangents() ? kTangent + 3 : uv_index(1 + mesh.more_uv.size());
    for (uint32_t triangle = 0; triangle < indices.size() / 3; ++triangle) {
      std::array<VertexValues, 3> values;
      for (size_t i = 0; i < 3; ++i)
        values[i] =
            vertex_values(scene, drawn, clip_from_world, pipeline.gbuffer.unit_normals, indices[3 * triangle + i]);
      const WindowPolygon polygon = window_polygon(values, used, faced, viewport);
      const auto first = uint32_t(frame.triangles.size());
      for (const WindowTriangle& window : polygon.pieces) {
        DrawnTriangle piece{window, instance, triangle, {}, values[state.provoking == Provoking::last ? 2 : 0]};
        for (size_t i = 0; i < 3; ++i) piece.depth[i] = vertex_depth(window.values[i], state);
        if (both_sides && !polygon.front) turn_normals(piece);
        set_polygon_offset(pipeline, piece);
        frame.triangles.push_back(piece);
      }
      const PixelRect box = pixel_bounds(polygon, viewport, frame.width, frame.height);
      for (int y = box.y0; y < box.y1; ++y)
        for (int x = box.x0; x < box.x1; ++x)
          if (const std::optional<size_t> piece = covering_piece(polygon, state.clip_origin, x, y)) {
            const auto index = first + uint32_t(*piece);
            const std::optional<bool> dropped = discarded(scene, pipeline.gbuffer, frame.triangles[index], x, y);
            if (dropped.value_or(false)) continue;
            Fragment fragment = fragment_of(frame.triangles[index], index, state, x, y);
            fragment.doubtful = !dropped;
            frame.fragments[size_t(y) * size_t(frame.width) + size_t(x)].push_back(fragment);
          }
    }
  }
  return frame;
}

Visible visible_fragment(const std::vector<Fragment>& fragments, const GeometryState& state) {
  Visible result;
  float stored = held_depth(state, state.clear_depth), stored_bound = 0;
  for (size_t i = 0; i < fragments.size(); ++i) {
    const float z = fragments[i].depth_code, bound = fragments[i].depth_bound;
    bool passes = false;
    switch (state.depth_func) {
      case DepthFunc::never:
        passes = false;
        break;
      case DepthFunc::less:
        passes = z < stored;
        break;
      case DepthFunc::equal:
        passes = z == stored;
        break;
      case DepthFunc::lequal:
        passes = z <= stored;
        break;
      case DepthFunc::greater:
        passes = z > stored;
        break;
      case DepthFunc::notequal:
        passes = z != stored;
        break;
      case DepthFunc::gequal:
        passes = z >= stored;
        break;
      case DepthFunc::always:
        passes = true;
        break;
    }
    const bool compares = state.depth_func != DepthFunc::never && state.depth_func != DepthFunc::always;
    if (compares && bound + stored_bound > 0 && std::fabs(z - stored) <= bound + stored_bound) result.certain = false;
    if (fragments[i].doubtful) result.certain = false;
    if (!passes) continue;
    result.fragment = i;
    stored = z;
    stored_bound = bound;
  }
  return result;
}

ValueRange value_at(const DrawnTriangle& t, size_t index, Interpolation interpolation, int x, int y) {
  ValueRange range;
  if (interpolation == Interpolation::flat) {
    range.value = range.lo = range.hi = t.provoking[index];
    return range;
  }
  const std::array<Real, 3> weight = weights(t, interpolation, x, y);
  const auto& v = t.window.values;
  for (size_t i = 0; i < 3; ++i) range.value += weight[i] * Real(v[i][index]);
  range.lo = std::min({v[0][index], v[1][index], v[2][index]});
  range.hi = std::max({v[0][index], v[1][index], v[2][index]});
  range.ulp = float_spacing(std::max(std::fabs(range.lo), std::fabs(range.hi)));
  return range;
}

/// Of a vector off by e in each component, the direction is off by at most 2 sqrt(3) e over the vector's length; the
/// square, the sum, the root, the division and the product of floats add three roundings. Nothing is known of a vector
/// whose square is no float.
std::array<ValueRange, 3> normal_at(const DrawnTriangle& t, const GBufferState& state, int x, int y) {
  std::array<ValueRange, 3> n;
  Real length = 0;
  double ulp = 0;
  for (size_t k = 0; k < 3; ++k) {
    n[k] = value_at(t, kNormal + k, state.normal.interpolation, x, y);
    length += n[k].value * n[k].value, ulp = std::max(ulp, n[k].ulp);
  }
  length = std::sqrt(length);
  if (!made_unit_at_fragment(state.unit_normals)) return n;
  if (length < 1e-18L) return {ValueRange{0, 2, -1, 1}, ValueRange{0, 2, -1, 1}, ValueRange{0, 2, -1, 1}};
  for (ValueRange& r : n)
    r = {r.value / length, 2 * std::sqrt(3.0) * ulp / double(length) + 4 * 0x1p-24, -1 - 0x1p-22, 1 + 0x1p-22};
  return n;
}

float held_depth(const GeometryState& state, float z) {
  if (depth_bits(state) == 0) return z;
  const float largest = float(std::ldexp(1.0, depth_bits(state)) - 1);
  const auto product = double(z * largest);  // a float, as docs/arithmetic.md section 6 has it
  double code = std::floor(product);
  const double rest = product - code;
  if (rest > 0.5 || (rest == 0.5 && std::fmod(code, 2.0) != 0.0)) code += 1.0;
  return float(code / double(largest));
}

long double depth_at(const DrawnTriangle& t, int x, int y) {
  const std::array<Real, 3> weight = weights(t, Interpolation::noperspective, x, y);
  // The same sum from differences: exactly constant where the vertices agree.
  return t.depth[0] + (weight[1] * (t.depth[1] - t.depth[0]) + weight[2] * (t.depth[2] - t.depth[0])) + t.offset;
}

long double fragment_w(const DrawnTriangle& t, int x, int y) {
  const std::array<Real, 3> weight = weights(t, Interpolation::noperspective, x, y);
  Real sum = 0;
  for (size_t i = 0; i < 3; ++i) sum += weight[i] / Real(t.window.values[i][3]);
  return sum;
}

}  // namespace trueshade::oracle
