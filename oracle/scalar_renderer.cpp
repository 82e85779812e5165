#include "oracle/scalar_renderer.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trueshade::oracle {

namespace {

using Real = long double;
using Vector = std::array<Real, 3>;

Vector difference(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Real dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vector unit(const Vector& v) {
  const Real length = std::sqrt(dot(v, v));
  if (length == 0) return v;
  return {v[0] / length, v[1] / length, v[2] / length};
}
Vector vector_of(const glm::vec3& v) { return {v.x, v.y, v.z}; }

Real& at(std::array<Real, 16>& m, size_t row, size_t column) { return m[4 * column + row]; }

/// Where every rounding is part of the definition: docs/arithmetic.md sections 1 and 2.
float affine(const float row[4], float x, float y, float z) {
  return ((row[0] * x + row[1] * y) + row[2] * z) + row[3];
}

float component(const std::vector<float>& stream, uint32_t vertex, float absent) {
  return stream.empty() ? absent : stream[vertex];
}

/// RN32 of the inverse transpose of the linear part, times v, made unit length in float.
void world_normal(const Instance& instance, const float v[3], float out[3]) {
  std::array<std::array<double, 3>, 3> a{};  // columns
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) a[size_t(c)][size_t(r)] = double(instance.world_from_object[c][r]);
  const auto cross_f64 = [](const std::array<double, 3>& p, const std::array<double, 3>& q) {
    return std::array<double, 3>{p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
  };
  const std::array<double, 3> cofactor[3] = {cross_f64(a[1], a[2]), cross_f64(a[2], a[0]), cross_f64(a[0], a[1])};
  const double det = (a[0][0] * cofactor[0][0] + a[0][1] * cofactor[0][1]) + a[0][2] * cofactor[0][2];
  float n[3];
  for (size_t r = 0; r < 3; ++r) {
    // Column c of the inverse transpose is a_{c+1} x a_{c+2} over the determinant.
    float m[3];
    for (size_t c = 0; c < 3; ++c) m[c] = float(det == 0 ? cofactor[c][r] : cofactor[c][r] / det);
    n[r] = (m[0] * v[0] + m[1] * v[1]) + m[2] * v[2];
  }
  const float l2 = (n[0] * n[0] + n[1] * n[1]) + n[2] * n[2];
  const float scale = l2 > 0 ? 1.0f / std::sqrt(l2) : 0.0f;
  for (size_t r = 0; r < 3; ++r) out[r] = n[r] * scale;
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

Fragment fragment_of(const DrawnTriangle& t, uint32_t index, const GeometryState& state, int x, int y) {
  Fragment f;
  f.instance = t.instance;
  f.triangle = t.triangle;
  f.window = index;
  const Real low = std::min(state.depth_near, state.depth_far), high = std::max(state.depth_near, state.depth_far);
  f.depth = std::clamp(depth_at(t, x, y), low, high);
  f.depth_code = float(f.depth);
  // The renderer's double formula has some ten roundings; where they cannot reach the next float, its code is ours.
  Real largest = 1;
  for (const Real z : t.depth) largest = std::max(largest, std::fabs(z));
  const Real slack = largest * 0x1p-47L;
  const auto code = [&](Real z) { return float(std::clamp(z, low, high)); };
  if (code(f.depth - slack) != code(f.depth + slack)) f.depth_bound = float(float_spacing(double(f.depth)));
  return f;
}

}  // namespace

Matrix4 projection_of(const Camera& camera, const GeometryState& state, int width, int height) {
  Matrix4 result{};
  if (camera.clip_from_world) {
    for (size_t i = 0; i < 16; ++i) result[i] = double((*camera.clip_from_world)[i]);
    return result;
  }
  const Vector eye = vector_of(camera.eye);
  const Vector f = unit(difference(vector_of(camera.target), eye)), s = unit(cross(f, vector_of(camera.up)));
  const Vector u = cross(s, f);
  std::array<Real, 16> view{}, projection{};
  const Vector rows[3] = {s, u, {-f[0], -f[1], -f[2]}};
  for (size_t r = 0; r < 3; ++r) {
    for (size_t c = 0; c < 3; ++c) at(view, r, c) = rows[r][c];
    at(view, r, 3) = -dot(rows[r], eye);
  }
  at(view, 3, 3) = 1;
  const Viewport viewport = resolved_viewport(state, width, height);
  const Real aspect = Real(viewport.width) / viewport.height, near = camera.near, far = camera.far;
  const Real g = 1 / std::tan(Real(camera.fov_y_rad) / 2);
  const bool zero_to_one = state.clip_depth == ClipDepth::zero_to_one;
  at(projection, 0, 0) = g / aspect;
  at(projection, 1, 1) = g;
  at(projection, 2, 2) = (zero_to_one ? far : far + near) / (near - far);
  at(projection, 2, 3) = (zero_to_one ? 1 : 2) * far * near / (near - far);
  at(projection, 3, 2) = -1;
  for (size_t r = 0; r < 4; ++r)
    for (size_t c = 0; c < 4; ++c) {
      Real sum = 0;
      for (size_t k = 0; k < 4; ++k) sum += at(projection, r, k) * at(view, k, c);
      result[4 * c + r] = double(sum);
    }
  return result;
}

VertexValues vertex_values(const Scene& scene, const Instance& instance, const Matrix4& clip_from_world,
                           uint32_t vertex) {
  const Mesh& mesh = scene.meshes[instance.mesh];
  float object[3], normal[3], unit_normal[3] = {0, 0, 0};
  for (size_t k = 0; k < 3; ++k) object[k] = mesh.position[k][vertex];
  for (size_t k = 0; k < 3; ++k) normal[k] = component(mesh.normal[k], vertex, 0.0f);
  VertexValues out{};
  for (size_t r = 0; r < 4; ++r) {
    float row[4];
    for (int c = 0; c < 4; ++c) {
      double sum = 0;
      for (int k = 0; k < 4; ++k) {
        const double b = k < 3 ? double(instance.world_from_object[c][k]) : (c == 3 ? 1.0 : 0.0);
        const double product = clip_from_world[size_t(4 * k) + r] * b;
        sum = k == 0 ? product : sum + product;
      }
      row[c] = float(sum);
    }
    out[kClip + r] = double(affine(row, object[0], object[1], object[2]));
  }
  for (int r = 0; r < 3; ++r) {
    const float row[4] = {instance.world_from_object[0][r], instance.world_from_object[1][r],
                          instance.world_from_object[2][r], instance.world_from_object[3][r]};
    out[kPosition + size_t(r)] = double(affine(row, object[0], object[1], object[2]));
  }
  world_normal(instance, normal, unit_normal);
  for (size_t k = 0; k < 3; ++k) out[kNormal + k] = double(unit_normal[k]);
  // The base colour multiplies after interpolation: these are the vertex colours alone.
  for (size_t k = 0; k < 4; ++k) out[kAlbedo + k] = double(component(mesh.color[k], vertex, 1.0f));
  for (size_t k = 0; k < 2; ++k) out[kUv + k] = double(component(mesh.uv[k], vertex, 0.0f));
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
    const std::vector<uint32_t>& indices = scene.meshes[drawn.mesh].indices;
    for (uint32_t triangle = 0; triangle < indices.size() / 3; ++triangle) {
      std::array<VertexValues, 3> values;
      for (size_t i = 0; i < 3; ++i)
        values[i] = vertex_values(scene, drawn, clip_from_world, indices[3 * triangle + i]);
      const WindowPolygon polygon = window_polygon(values, kMaxValues, state, viewport);
      const auto first = uint32_t(frame.triangles.size());
      for (const WindowTriangle& window : polygon.pieces) {
        DrawnTriangle piece{window, instance, triangle, {}, values[state.provoking == Provoking::last ? 2 : 0]};
        for (size_t i = 0; i < 3; ++i) piece.depth[i] = vertex_depth(window.values[i], state);
        frame.triangles.push_back(piece);
      }
      const PixelRect box = pixel_bounds(polygon, viewport, frame.width, frame.height);
      for (int y = box.y0; y < box.y1; ++y)
        for (int x = box.x0; x < box.x1; ++x)
          if (const std::optional<size_t> piece = covering_piece(polygon, state.clip_origin, x, y)) {
            const auto index = first + uint32_t(*piece);
            frame.fragments[size_t(y) * size_t(frame.width) + size_t(x)].push_back(
                fragment_of(frame.triangles[index], index, state, x, y));
          }
    }
  }
  return frame;
}

Visible visible_fragment(const std::vector<Fragment>& fragments, const GeometryState& state) {
  Visible result;
  float stored = state.clear_depth, stored_bound = 0;
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

long double depth_at(const DrawnTriangle& t, int x, int y) {
  const std::array<Real, 3> weight = weights(t, Interpolation::noperspective, x, y);
  // The same sum from differences: exactly constant where the vertices agree.
  return t.depth[0] + (weight[1] * (t.depth[1] - t.depth[0]) + weight[2] * (t.depth[2] - t.depth[0]));
}

long double fragment_w(const DrawnTriangle& t, int x, int y) {
  const std::array<Real, 3> weight = weights(t, Interpolation::noperspective, x, y);
  Real sum = 0;
  for (size_t i = 0; i < 3; ++i) sum += weight[i] / Real(t.window.values[i][3]);
  return sum;
}

std::array<double, 3> lit_color(const Surface& surface, const Scene& scene, const LightModel& model) {
  const Vector position = {surface.position[0], surface.position[1], surface.position[2]};
  Vector n = {surface.normal[0], surface.normal[1], surface.normal[2]};
  if (model.renormalize) n = unit(n);
  const Vector view = unit(difference(vector_of(scene.camera.eye), position));
  Vector sum{};
  for (const Light& light : scene.lights) {
    const Vector color = vector_of(light.color);
    if (light.type == LightType::ambient) {
      for (size_t k = 0; k < 3; ++k) sum[k] += Real(surface.albedo[k]) * color[k];
      continue;
    }
    Vector to_light{};
    Real falloff = 1;
    if (light.type == LightType::directional) {
      to_light = difference({}, vector_of(light.direction));
    } else {
      const Vector offset = difference(vector_of(light.position), position);
      const Real d = std::sqrt(dot(offset, offset));
      to_light = unit(offset);
      falloff = model.falloff == Falloff::linear_range
                    ? std::max(Real(0), 1 - d / Real(light.range))
                    : 1 / (1 + Real(light.attenuation.y) * d + Real(light.attenuation.z) * d * d);
    }
    const Real n_l = dot(n, to_light);
    const Vector half = {to_light[0] + view[0], to_light[1] + view[1], to_light[2] + view[2]};
    const Real n_h = std::max(Real(0), dot(n, unit(half)));
    const Real specular = model.specular_masked && n_l <= 0 ? 0 : std::pow(n_h, Real(model.shininess));
    const Vector ks = vector_of(model.specular_color);
    for (size_t k = 0; k < 3; ++k)
      sum[k] += (Real(surface.albedo[k]) * std::max(Real(0), n_l) + ks[k] * specular) * color[k] * falloff;
  }
  return {double(sum[0]), double(sum[1]), double(sum[2])};
}

}  // namespace trueshade::oracle
