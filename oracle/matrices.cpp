#include "oracle/matrices.h"

#include <cmath>
#include <utility>

#include "oracle/exact_coverage.h"
#include "oracle/vectors.h"

namespace trueshade::oracle {

namespace {

template <typename Number>
std::array<Number, 3> cross(const std::array<Number, 3>& a, const std::array<Number, 3>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Real& at(std::array<Real, 16>& m, size_t row, size_t column) { return m[4 * column + row]; }

/// RN32 of the inverse transpose of the linear part: every rounding is part of the definition.
std::array<std::array<float, 3>, 3> normal_rows(const glm::mat4x3& world_from_object) {
  std::array<std::array<double, 3>, 3> a{};  // columns
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) a[size_t(c)][size_t(r)] = double(world_from_object[c][r]);
  const std::array<double, 3> cofactor[3] = {cross(a[1], a[2]), cross(a[2], a[0]), cross(a[0], a[1])};
  const double det = (a[0][0] * cofactor[0][0] + a[0][1] * cofactor[0][1]) + a[0][2] * cofactor[0][2];
  std::array<std::array<float, 3>, 3> rows{};
  // Column c of the inverse transpose is a_{c+1} x a_{c+2} over the determinant.
  for (size_t r = 0; r < 3; ++r)
    for (size_t c = 0; c < 3; ++c) rows[r][c] = float(det == 0 ? cofactor[c][r] : cofactor[c][r] / det);
  return rows;
}

}  // namespace

static std::array<Real, 16> view_of(const Camera& camera) {
  const Vector eye = vector_of(camera.eye);
  const Vector f = unit(difference(vector_of(camera.target), eye)), s = unit(cross(f, vector_of(camera.up)));
  const Vector u = cross(s, f);
  std::array<Real, 16> view{};
  const Vector rows[3] = {s, u, {-f[0], -f[1], -f[2]}};
  for (size_t r = 0; r < 3; ++r) {
    for (size_t c = 0; c < 3; ++c) at(view, r, c) = rows[r][c];
    at(view, r, 3) = -dot(rows[r], eye);
  }
  at(view, 3, 3) = 1;
  return view;
}

static std::array<Real, 16> lens_of(const Camera& camera, const GeometryState& state, int width, int height) {
  std::array<Real, 16> projection{};
  const Viewport viewport = resolved_viewport(state, width, height);
  const Real aspect = Real(viewport.width) / viewport.height, near = camera.near, far = camera.far;
  const Real g =
      camera.fov_x_rad ? aspect / std::tan(Real(*camera.fov_x_rad) / 2) : 1 / std::tan(Real(camera.fov_y_rad) / 2);
  const bool zero_to_one = state.clip_depth == ClipDepth::zero_to_one;
  at(projection, 0, 0) = g / aspect;
  at(projection, 1, 1) = g;
  at(projection, 2, 2) = (zero_to_one ? far : far + near) / (near - far);
  at(projection, 2, 3) = (zero_to_one ? 1 : 2) * far * near / (near - far);
  at(projection, 3, 2) = -1;
  return projection;
}

static Matrix4 rounded_to_double(const std::array<Real, 16>& matrix) {
  Matrix4 result{};
  for (size_t i = 0; i < 16; ++i) result[i] = double(matrix[i]);
  return result;
}

Matrix4 view_matrix(const Camera& camera) { return rounded_to_double(view_of(camera)); }

Matrix4 lens_matrix(const Camera& camera, const GeometryState& state, int width, int height) {
  return rounded_to_double(lens_of(camera, state, width, height));
}

Matrix4 projection_of(const Camera& camera, const GeometryState& state, int width, int height) {
  Matrix4 result{};
  if (camera.clip_from_world) {
    for (size_t i = 0; i < 16; ++i) result[i] = double((*camera.clip_from_world)[i]);
    if (camera.matrix_has_gl_range && state.clip_depth == ClipDepth::zero_to_one)
      for (size_t c = 0; c < 4; ++c) result[4 * c + 2] = (result[4 * c + 2] + result[4 * c + 3]) / 2;
    return result;
  }
  std::array<Real, 16> view = view_of(camera), projection = lens_of(camera, state, width, height);
  for (size_t r = 0; r < 4; ++r)
    for (size_t c = 0; c < 4; ++c) {
      Real sum = 0;
      for (size_t k = 0; k < 4; ++k) sum += at(projection, r, k) * at(view, k, c);
      result[4 * c + r] = double(sum);
    }
  return result;
}

std::array<double, 3> view_axis(const Matrix4& m) {
  Vector row = {m[3], m[7], m[11]};
  if (dot(row, row) == 0) row = {m[2], m[6], m[10]};
  const Vector v = unit(row);
  return {double(-v[0]), double(-v[1]), double(-v[2])};
}

Matrix4 inverse_of(const Matrix4& matrix) {
  std::array<std::array<Real, 8>, 4> rows{};  // the matrix beside the identity
  for (size_t r = 0; r < 4; ++r) {
    for (size_t c = 0; c < 4; ++c) rows[r][c] = Real(matrix[4 * c + r]);
    rows[r][4 + r] = 1;
  }
  for (size_t pivot = 0; pivot < 4; ++pivot) {
    size_t largest = pivot;
    for (size_t r = pivot + 1; r < 4; ++r)
      if (std::fabs(rows[r][pivot]) > std::fabs(rows[largest][pivot])) largest = r;
    std::swap(rows[pivot], rows[largest]);
    const Real scale = 1 / rows[pivot][pivot];
    for (Real& value : rows[pivot]) value *= scale;
    for (size_t r = 0; r < 4; ++r) {
      const Real factor = rows[r][pivot];
      if (r == pivot) continue;
      for (size_t c = 0; c < 8; ++c) rows[r][c] -= factor * rows[pivot][c];
    }
  }
  Matrix4 result{};
  for (size_t r = 0; r < 4; ++r)
    for (size_t c = 0; c < 4; ++c) result[4 * c + r] = double(rows[r][4 + c]);
  return result;
}

InstanceRows instance_rows(const Instance& instance, const Matrix4& clip_from_world) {
  InstanceRows out{};
  for (size_t r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) {
      double sum = 0;
      for (int k = 0; k < 4; ++k) {
        const double b = k < 3 ? double(instance.world_from_object[c][k]) : (c == 3 ? 1.0 : 0.0);
        const double product = clip_from_world[size_t(4 * k) + r] * b;
        sum = k == 0 ? product : sum + product;
      }
      out.clip[r][size_t(c)] = float(sum);
    }
  for (size_t r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c) out.world[r][size_t(c)] = instance.world_from_object[c][int(r)];
  out.normal = normal_rows(instance.world_from_object);
  return out;
}

}  // namespace trueshade::oracle
