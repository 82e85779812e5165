// What people get wrong of the camera and the window.
#include <algorithm>
#include <cmath>

#include "judge/diagnosis/plane_evidence.h"
#include "judge/diagnosis/triple.h"
#include "judge/diagnosis/view_axes.h"
#include "oracle/camera_view.h"
#include "oracle/exact_coverage.h"

namespace trueshade::oracle {

namespace {

using P = FaultParameter;
using Suspects = std::vector<FaultParameter>;

void set_matrix(Scene& s, const Matrix4& m) {
  s.camera.clip_from_world.emplace();
  for (size_t i = 0; i < 16; ++i) (*s.camera.clip_from_world)[i] = float(m[i]);
  s.camera.matrix_has_gl_range = false;
}
/// The product a * b.
Matrix4 times_matrix(const Matrix4& a, const Matrix4& b) {
  Matrix4 m;
  for (size_t c = 0; c < 4; ++c) {
    const Vector4 column = transformed(a, {b[4 * c], b[4 * c + 1], b[4 * c + 2], b[4 * c + 3]});
    std::copy(column.begin(), column.end(), m.begin() + ptrdiff_t(4 * c));
  }
  return m;
}
Matrix4 matrix_of(const Scene& s, const Pipeline& p) { return projection_of(s.camera, p.geometry, p.width, p.height); }

bool move_camera(Scene& s, Pipeline& p, const P& by) {
  if (by.vector == Triple3{}) return false;
  if (s.camera.clip_from_world) {  // first the scene is moved the other way
    const Matrix4 back = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -by.vector[0], -by.vector[1], -by.vector[2], 1};
    set_matrix(s, times_matrix(matrix_of(s, p), back));
  }
  s.camera.eye += vec3_of(by.vector), s.camera.target += vec3_of(by.vector);
  return true;
}
bool move_eye(Scene& s, Pipeline&, const P& by) {
  if (s.camera.clip_from_world || by.vector == Triple3{}) return false;
  s.camera.eye += vec3_of(by.vector);
  return s.camera.eye != s.camera.target;
}
bool move_target(Scene& s, Pipeline&, const P& by) {
  if (s.camera.clip_from_world || by.vector == Triple3{}) return false;
  s.camera.target += vec3_of(by.vector);
  return s.camera.eye != s.camera.target;
}
/// Turns the camera about its own axes right, up and back, by degrees.
bool turn_camera(Scene& s, Pipeline& p, const P& by) {
  if (by.vector == Triple3{}) return false;
  const std::array<Triple3, 3> axes = view_axes(s.camera, p);
  const Triple3 eye = triple(s.camera.eye),
                degrees = plus(plus(times(axes[0], by.vector[0]), times(axes[1], by.vector[1])),
                               times(axes[2], by.vector[2]));
  const double angle = -std::sqrt(inner(degrees, degrees)) * std::acos(-1.0) / 180;  // the scene turns the other way
  const Triple3 axis = unit(degrees);
  const auto turned = [&](const Triple3& v) {
    return plus(plus(times(v, std::cos(angle)), times(cross(axis, v), std::sin(angle))),
                times(axis, inner(axis, v) * (1 - std::cos(angle))));
  };
  Matrix4 m{};
  for (size_t c = 0; c < 3; ++c) {
    Triple3 e{};
    e[c] = 1;
    const Triple3 column = turned(e);
    for (size_t r = 0; r < 3; ++r) m[4 * c + r] = column[r];
  }
  const Triple3 rest = minus(eye, turned(eye));
  for (size_t r = 0; r < 3; ++r) m[12 + r] = rest[r];
  m[15] = 1;
  set_matrix(s, times_matrix(matrix_of(s, p), m));
  return true;
}
/// Multiplies the rows x and y of the camera's matrix.
void scale_rows(Scene& s, const Pipeline& p, double x, double y) {
  Matrix4 m = matrix_of(s, p);
  for (size_t c = 0; c < 4; ++c) m[4 * c] *= x, m[4 * c + 1] *= y;
  set_matrix(s, m);
}
bool other_angle(Scene& s, Pipeline& p, const P& by) {
  const double factor = by.vector[0];
  if (!(factor > 0) || factor == 1) return false;
  Camera& c = s.camera;
  float& angle = c.fov_x_rad ? *c.fov_x_rad : c.fov_y_rad;
  if (!c.clip_from_world) {
    angle = float(double(angle) * factor);
    return angle > 0.001f && angle < 3.14f;
  }
  const auto row = [&](size_t r) {
    const auto& m = *c.clip_from_world;
    return std::sqrt(double(m[r]) * double(m[r]) + double(m[4 + r]) * double(m[4 + r]) +
                     double(m[8 + r]) * double(m[8 + r]));
  };
  const double half = std::atan2(row(3), row(1)), wider = half * factor;
  if (!(row(3) > 0) || !(wider < 1.57)) return false;
  scale_rows(s, p, std::tan(half) / std::tan(wider), std::tan(half) / std::tan(wider));
  return true;
}
bool other_aspect(Scene& s, Pipeline& p, const P& by) {
  if (!(by.vector[0] > 0) || by.vector[0] == 1) return false;
  scale_rows(s, p, 1 / by.vector[0], 1);
  return true;
}
bool other_near(Scene& s, Pipeline&, const P& by) {
  if (s.camera.clip_from_world || !(by.vector[0] > 0) || by.vector[0] == 1) return false;
  s.camera.near = float(double(s.camera.near) * by.vector[0]);
  return s.camera.near < s.camera.far;
}
bool other_far(Scene& s, Pipeline&, const P& by) {
  if (s.camera.clip_from_world || !(by.vector[0] > 0) || by.vector[0] == 1) return false;
  s.camera.far = float(double(s.camera.far) * by.vector[0]);
  return s.camera.near < s.camera.far;
}
/// Moves all by pixels to the right and up, as a jitter of the projection does.
bool jitter(Scene& s, Pipeline& p, const P& by) {
  if (by.vector == Triple3{}) return false;
  Matrix4 m = matrix_of(s, p);
  const double up = p.geometry.clip_origin == ClipOrigin::upper_left ? -1 : 1;
  for (size_t c = 0; c < 4; ++c) {
    m[4 * c] += m[4 * c + 3] * 2 * by.vector[0] / p.width;
    m[4 * c + 1] += m[4 * c + 3] * 2 * up * by.vector[1] / p.height;
  }
  set_matrix(s, m);
  return true;
}
/// Gives the viewport another size. The projection stays, though its aspect would follow the viewport.
bool resize_viewport(Scene& s, Pipeline& p, const P& to) {
  const Viewport now = resolved_viewport(p.geometry, p.width, p.height);
  const int width = int(to.vector[0]), height = int(to.vector[1]);
  if (width < 1 || height < 1 || width > 65536 || height > 65536 || (width == now.width && height == now.height))
    return false;
  set_matrix(s, matrix_of(s, p));
  p.geometry.viewport = {now.x, now.y, width, height};
  return true;
}
bool move_viewport(Scene&, Pipeline& p, const P& to) {
  const Viewport now = resolved_viewport(p.geometry, p.width, p.height);
  const int x = int(to.vector[0]), y = int(to.vector[1]);
  if (std::abs(x) > 65536 || std::abs(y) > 65536 || (x == now.x && y == now.y)) return false;
  p.geometry.viewport = {x, y, now.width, now.height};
  return true;
}

// --- from where to start

Suspects from_nothing(const PlaneEvidence&) { return {P(0, {0, 0, 0})}; }
Suspects from_one(const PlaneEvidence&) {
  Suspects all;
  for (const double f : {1.0, 0.8, 1.25, 0.5, 2.0}) all.push_back(P(0, {f, 0, 0}));
  return all;
}
Suspects from_some_size(const PlaneEvidence&) {
  Suspects all;
  for (const double f : {1.0, 0.1, 0.25, 0.5, 2.0, 4.0, 10.0}) all.push_back(P(0, {f, 0, 0}));
  return all;
}

/// A viewport's edge and side along x and y, by the line through pixels over normalized device coordinates.
struct Window {
  Triple3 origin{}, size{};
  bool known = false;
};
/// The viewport that the captured positions tell; not known where they were not captured.
Window window_of(const PlaneEvidence& e) {
  Window w;
  if (!e.has_plane(Plane::position)) return w;
  const Matrix4 m = projection_of(e.scene.camera, e.pipeline.geometry, e.pipeline.width, e.pipeline.height);
  const bool flip = e.pipeline.geometry.clip_origin == ClipOrigin::upper_left;
  for (size_t axis = 0; axis < 2; ++axis) {
    double n = 0, sum_x = 0, sum_p = 0, sum_xx = 0, sum_xp = 0;
    for (const EvidentPixel& p : e.pixels) {
      if (!p.given.covered) continue;
      const auto& at = p.given.position;
      const Vector4 c = transformed(m, {at[0], at[1], at[2], 1});
      const double x = (axis == 1 && flip ? -1 : 1) * c[axis] / c[3],
                   pixel = axis == 0 ? p.at.x + 0.5 : e.pipeline.height - 1 - p.at.y + 0.5;
      if (!(std::fabs(x) < 100)) continue;
      n += 1, sum_x += x, sum_p += pixel, sum_xx += x * x, sum_xp += x * pixel;
    }
    const double spread = n * sum_xx - sum_x * sum_x;
    if (!(spread > 0)) return {};
    const double slope = (n * sum_xp - sum_x * sum_p) / spread, middle = (sum_p - slope * sum_x) / n;
    w.size[axis] = std::nearbyint(2 * slope), w.origin[axis] = std::nearbyint(middle - slope) + 0.0;
  }
  w.known = true;
  return w;
}
Suspects by_its_size(const PlaneEvidence& e) {
  const Window w = window_of(e);
  return w.known ? Suspects{P(0, w.size)} : Suspects{};
}
Suspects by_its_origin(const PlaneEvidence& e) {
  const Window w = window_of(e);
  return w.known ? Suspects{P(0, w.origin)} : Suspects{};
}

using Fault = PlaneFault;
constexpr double kCameraChange = -1e-4;  ///< of the extent: PlaneFault::change_of

constexpr PlaneFault of_camera(std::string_view name, std::string_view text, bool (*edit)(Scene&, Pipeline&, const P&),
                               Suspects (*suspects)(const PlaneEvidence&), int numbers, double change_of,
                               double start = 0) {
  return {.name = name,
          .text = text,
          .search = Fault::Search::suspected,
          .edit = edit,
          .suspects = suspects,
          .numbers = {false, false, numbers},
          .fit = change_of != 0 ? Fit::camera : Fit::none,
          .start = start,
          .change_of = change_of};
}

constexpr PlaneFault kCameraFaults[] = {
    of_camera("camera-moved", "the camera is moved by %v", move_camera, from_nothing, 3, kCameraChange),
    of_camera("camera-eye", "the camera's eye is moved by %v, its target is not", move_eye, from_nothing, 3,
              kCameraChange),
    of_camera("camera-target", "the camera's target is moved by %v", move_target, from_nothing, 3, kCameraChange),
    of_camera("camera-turned", "the camera is turned by %v degrees about its axes right, up and back", turn_camera,
              from_nothing, 3, 0.05),
    of_camera("camera-angle", "the camera's angle of view is %v times what it should be", other_angle, from_one, 1,
              1e-3, 1),
    of_camera("camera-aspect", "the picture is %v times as wide in its angle as it should be", other_aspect, from_one,
              1, 1e-3, 1),
    of_camera("camera-near", "the near plane is %v times as far as it should be", other_near, from_some_size, 1, 1e-3,
              1),
    of_camera("camera-far", "the far plane is %v times as far as it should be", other_far, from_some_size, 1, 1e-3, 1),
    of_camera("picture-jitter", "all that is drawn is moved by %v pixels, to the right and up", jitter, from_nothing, 2,
              0.05),
    of_camera("viewport-size", "the viewport has %v pixels", resize_viewport, by_its_size, 2, 0),
    of_camera("viewport-origin", "the viewport's lower left corner is at %v", move_viewport, by_its_origin, 2, 0),
};

}  // namespace

std::span<const PlaneFault> camera_faults() { return kCameraFaults; }

}  // namespace trueshade::oracle
