#include "judge/diagnosis/plane_faults.h"

#include <algorithm>
#include <cmath>

#include "judge/diagnosis/reread_depth.h"
#include "judge/diagnosis/srgb_numbers.h"
#include "judge/diagnosis/view_axes.h"
#include "oracle/camera_view.h"

namespace trueshade::oracle {

namespace {

using V3 = std::array<double, 3>;
using Context = PlaneContext;

double inner3(const V3& a, const V3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
V3 rotated(const Context& c, const V3& v) { return {inner3(c.view[0], v), inner3(c.view[1], v), inner3(c.view[2], v)}; }
V3 from_eye(const Context& c, const V3& p) { return {p[0] - c.eye[0], p[1] - c.eye[1], p[2] - c.eye[2]}; }

// --- depth
// ------------------------------------------------------------------------------------------------------------

void depth_reversed(const Context&, PlaneValues& v, double) { v.depth = 1 - v.depth; }
void depth_to_ndc(const Context&, PlaneValues& v, double) { v.depth = 2 * v.depth - 1; }
void depth_from_ndc(const Context&, PlaneValues& v, double) { v.depth = v.depth * 0.5 + 0.5; }
void depth_offset(const Context&, PlaneValues& v, double offset) {
  if (v.covered) v.depth += offset;
}
void depth_rounded(const Context&, PlaneValues& v, double bits) {
  const double largest = std::ldexp(1.0, int(bits)) - 1;
  v.depth = std::nearbyint(v.depth * largest) / largest;
}
double view_distance(const Context& c, const PlaneValues& v) { return -rotated(c, from_eye(c, v.position))[2]; }
void depth_of_view(const Context& c, PlaneValues& v, double) {
  if (v.covered) v.depth = view_distance(c, v);
}
void depth_over_far(const Context& c, PlaneValues& v, double) {
  if (v.covered) v.depth = view_distance(c, v) / double(c.scene.camera.far);
}
void depth_linear(const Context& c, PlaneValues& v, double) {
  const auto near = double(c.scene.camera.near), far = double(c.scene.camera.far);
  if (v.covered) v.depth = (view_distance(c, v) - near) / (far - near);
}
void depth_cleared_to_zero(const Context&, PlaneValues& v, double) {
  if (!v.covered) v.depth = 0;
}
void depth_of_ray(const Context& c, PlaneValues& v, double) {
  const V3 d = from_eye(c, v.position);
  if (v.covered) v.depth = std::sqrt(inner3(d, d));
}

// --- normals
// ----------------------------------------------------------------------------------------------------------

template <class Change>
void each_normal(PlaneValues& v, const Change& change) {
  if (!v.covered) return;
  v.normal = change(v.normal);
}
V3 unit3(const V3& n) {
  const double l = std::sqrt(inner3(n, n));
  return l > 0 ? V3{n[0] / l, n[1] / l, n[2] / l} : n;
}
void normal_halved(const Context&, PlaneValues& v, double) {
  each_normal(v, [](const V3& n) { return V3{n[0] * 0.5 + 0.5, n[1] * 0.5 + 0.5, n[2] * 0.5 + 0.5}; });
}
V3 octahedral(const V3& n) {
  const double sum = std::fabs(n[0]) + std::fabs(n[1]) + std::fabs(n[2]);
  if (!(sum > 0)) return {0, 0, 0};
  const double x = n[0] / sum, y = n[1] / sum;
  if (n[2] >= 0) return {x, y, 0};
  return {(1 - std::fabs(y)) * (x >= 0 ? 1 : -1), (1 - std::fabs(x)) * (y >= 0 ? 1 : -1), 0};
}
void normal_octahedral(const Context&, PlaneValues& v, double) { each_normal(v, octahedral); }
void normal_octahedral_halved(const Context&, PlaneValues& v, double third) {
  each_normal(v, [third](const V3& n) {
    const V3 o = octahedral(n);
    return V3{o[0] * 0.5 + 0.5, o[1] * 0.5 + 0.5, third};
  });
}
void normal_sphere_map(const Context& c, PlaneValues& v, double) {
  each_normal(v, [&](const V3& n) {
    const V3 e = rotated(c, unit3(n));
    const double p = std::sqrt(std::max(1e-12, e[2] * 8 + 8));
    return V3{e[0] / p + 0.5, e[1] / p + 0.5, 0};
  });
}
void normal_in_view(const Context& c, PlaneValues& v, double) {
  each_normal(v, [&](const V3& n) { return rotated(c, n); });
}
void normal_turned(const Context&, PlaneValues& v, double) {
  each_normal(v, [](const V3& n) { return V3{-n[0], -n[1], -n[2]}; });
}
void normal_unit(const Context&, PlaneValues& v, double) { each_normal(v, unit3); }
void normal_rounded(const Context&, PlaneValues& v, double bits) {
  const double largest = std::ldexp(1.0, int(bits)) - 1;
  each_normal(v, [largest](V3 n) {
    for (double& k : n) k = std::nearbyint((k * 0.5 + 0.5) * largest) / largest * 2 - 1;
    return n;
  });
}
template <size_t X, size_t Y, size_t Z>
void normal_axes(const Context&, PlaneValues& v, double) {
  each_normal(v, [](const V3& n) { return V3{n[X], n[Y], n[Z]}; });
}
template <size_t K>
void normal_axis_turned(const Context&, PlaneValues& v, double) {
  each_normal(v, [](V3 n) {
    n[K] = -n[K];
    return n;
  });
}

/// The object's matrix of the pixel; the unit matrix where nothing is drawn.
glm::mat4x3 matrix_at(const Context& c, const PlaneValues& v) {
  return v.covered ? c.scene.instances[size_t(v.object) - 1].world_from_object : glm::mat4x3(1.0f);
}
/// Makes the normal as long as if nobody had made it unit length after the matrix: the inverse transpose takes a unit
/// normal of the object here.
void normal_unscaled(const Context& c, PlaneValues& v, double) {
  const glm::mat4x3 m = matrix_at(c, v);
  each_normal(v, [&](const V3& n) {
    V3 object{};  // M^T n is the object's normal, up to its length
    for (int k = 0; k < 3; ++k)
      for (int r = 0; r < 3; ++r) object[size_t(k)] += double(m[k][r]) * n[size_t(r)];
    const double length = std::sqrt(inner3(object, object));
    return length > 0 ? V3{n[0] / length, n[1] / length, n[2] / length} : n;
  });
}
void normal_in_object(const Context& c, PlaneValues& v, double) {
  const glm::mat4x3 m = matrix_at(c, v);
  each_normal(v, [&](const V3& n) {
    V3 object{};
    for (int k = 0; k < 3; ++k)
      for (int r = 0; r < 3; ++r) object[size_t(k)] += double(m[k][r]) * n[size_t(r)];
    // As long as it is in the world: normals that are interpolated from unit ones are shorter than these.
    const double length = std::sqrt(inner3(object, object)), due = std::sqrt(inner3(n, n));
    return length > 0 ? V3{object[0] * due / length, object[1] * due / length, object[2] * due / length} : n;
  });
}
void normal_doubled(const Context&, PlaneValues& v, double) {
  each_normal(v, [](const V3& n) { return V3{2 * n[0] - 1, 2 * n[1] - 1, 2 * n[2] - 1}; });
}
void normal_scaled(const Context&, PlaneValues& v, double f) {
  each_normal(v, [f](const V3& n) { return V3{n[0] * f, n[1] * f, n[2] * f}; });
}
/// Codes of n / 2 + 1/2, taken for signed ones.
void normal_as_signed(const Context&, PlaneValues& v, double bits) {
  const double half = std::ldexp(1.0, int(bits) - 1), largest = 2 * half - 1;
  each_normal(v, [&](V3 n) {
    for (double& k : n) {
      const double code = std::nearbyint(std::clamp(k * 0.5 + 0.5, 0.0, 1.0) * largest);
      k = std::max(-1.0, (code < half ? code : code - 2 * half) / (half - 1));
    }
    return n;
  });
}
/// Signed codes, taken for those of n / 2 + 1/2.
void normal_as_unsigned(const Context&, PlaneValues& v, double bits) {
  const double half = std::ldexp(1.0, int(bits) - 1), largest = 2 * half - 1;
  each_normal(v, [&](V3 n) {
    for (double& k : n) {
      const double code = std::nearbyint(std::clamp(k, -1.0, 1.0) * (half - 1));
      k = (code < 0 ? code + 2 * half : code) / largest * 2 - 1;
    }
    return n;
  });
}

// --- positions
// --------------------------------------------------------------------------------------------------------

void position_in_view(const Context& c, PlaneValues& v, double) {
  if (v.covered) v.position = rotated(c, from_eye(c, v.position));
}
void position_from_eye(const Context& c, PlaneValues& v, double) {
  if (v.covered) v.position = from_eye(c, v.position);
}
void position_mirrored(const Context&, PlaneValues& v, double) { v.position[2] = -v.position[2]; }
void position_swapped(const Context&, PlaneValues& v, double) { std::swap(v.position[1], v.position[2]); }
DepthPlanes planes_of(const Context& c) { return {double(c.scene.camera.near), double(c.scene.camera.far)}; }
void position_by_planes(const Context& c, PlaneValues& v, double near, double far) {
  const DepthPlanes made = planes_of(c);
  if (v.covered) v.position = reread(c.eye, c.view[2], v.position, made, {made.near * near, made.far * far});
}
void position_by_near(const Context& c, PlaneValues& v, double f) { position_by_planes(c, v, f, 1); }
void position_by_far(const Context& c, PlaneValues& v, double f) { position_by_planes(c, v, 1, f); }
void position_scaled(const Context&, PlaneValues& v, double f) {
  for (double& p : v.position) p *= f;
}
double as_half(double v) {
  const double unit = v != 0 ? std::ldexp(1.0, std::max(std::ilogb(v), -14) - 10) : 1;
  return std::nearbyint(v / unit) * unit;
}
void position_as_half(const Context&, PlaneValues& v, double) {
  for (double& p : v.position) p = as_half(p);
}
void normal_as_half(const Context&, PlaneValues& v, double) {
  for (double& n : v.normal) n = as_half(n);
}
void depth_as_half(const Context&, PlaneValues& v, double) { v.depth = as_half(v.depth); }

// --- albedo, texture coordinates, identifiers
// ---------------------------------------------------------------------------

void albedo_encoded(const Context&, PlaneValues& v, double) {
  for (size_t k = 0; k < 3; ++k) v.albedo[k] = encoded_srgb(v.albedo[k]);
}
void albedo_decoded(const Context&, PlaneValues& v, double) {
  for (size_t k = 0; k < 3; ++k) v.albedo[k] = decoded_srgb(v.albedo[k]);
}
void albedo_premultiplied(const Context&, PlaneValues& v, double) {
  for (size_t k = 0; k < 3; ++k) v.albedo[k] *= v.albedo[3];
}
void albedo_scaled(const Context&, PlaneValues& v, double f) {
  for (size_t k = 0; k < 3; ++k) v.albedo[k] *= f;
}
void albedo_powered(const Context&, PlaneValues& v, double p) {
  for (size_t k = 0; k < 3; ++k) v.albedo[k] = v.albedo[k] > 0 ? std::pow(v.albedo[k], p) : 0;
}
void alpha_encoded(const Context&, PlaneValues& v, double) { v.albedo[3] = encoded_srgb(v.albedo[3]); }
void alpha_decoded(const Context&, PlaneValues& v, double) { v.albedo[3] = decoded_srgb(v.albedo[3]); }
void albedo_bgr(const Context&, PlaneValues& v, double) { std::swap(v.albedo[0], v.albedo[2]); }
void albedo_alpha(const Context&, PlaneValues& v, double alpha) {
  if (v.covered) v.albedo[3] = alpha;
}
void uv_flipped(const Context&, PlaneValues& v, double) {
  if (v.covered) v.uv[1] = 1 - v.uv[1];
}
void uv_swapped(const Context&, PlaneValues& v, double) { std::swap(v.uv[0], v.uv[1]); }
void object_offset(const Context&, PlaneValues& v, double offset) {
  if (v.covered) v.object += offset;
}
void material_offset(const Context&, PlaneValues& v, double offset) {
  if (v.covered) v.material += offset;
}

void flip_rows(PlaneMove& m, double) { m.flip_y = !m.flip_y; }
void flip_columns(PlaneMove& m, double) { m.flip_x = !m.flip_x; }
void shift_right(PlaneMove& m, double pixels) { m.x += int(pixels); }
void shift_down(PlaneMove& m, double pixels) { m.y += int(pixels); }

constexpr double kPlaneShifts[] = {-1, 1, -2, 2}, kOffsets[] = {-1, 1}, kDepthBits[] = {8, 10, 12, 16, 24},
                 kPlaneAlphas[] = {0, 1}, kThirds[] = {0, 0.5, 1}, kNormalBits[] = {8, 10}, kCodeBits[] = {8, 10, 16},
                 kScaleFactors[] = {0.25, 0.5, 0.8, 0.9, 0.97, 1.03, 1.1, 1.25, 2, 4},
                 kPowers[] = {0.45, 0.7, 1.4, 2.2},
                 kPositionPlaneFactors[] = {0.1, 0.2, 0.5, 0.8, 0.95, 1.05, 1.25, 2, 5, 10};

// name, text, plane, change, redraw, move, search, starts, doubt, reach
constexpr PlaneFault kPlaneFaults[] = {
    {"gbuffer-flip-y", "every plane of the G-buffer is upside down", Plane::all, nullptr, nullptr, flip_rows},
    {"gbuffer-flip-x", "every plane of the G-buffer is mirrored, left for right", Plane::all, nullptr, nullptr,
     flip_columns},
    {"gbuffer-shift-x", "every plane of the G-buffer is moved by %s pixels to the right", Plane::all, nullptr, nullptr,
     shift_right, kOneOf, kPlaneShifts},
    {"gbuffer-shift-y", "every plane of the G-buffer is moved by %s pixels downward", Plane::all, nullptr, nullptr,
     shift_down, kOneOf, kPlaneShifts},
    {"depth-flip-y", "the depths are upside down", Plane::depth, nullptr, nullptr, flip_rows},
    {"position-flip-y", "the positions are upside down", Plane::position, nullptr, nullptr, flip_rows},
    {"normal-flip-y", "the normals are upside down", Plane::normal, nullptr, nullptr, flip_rows},
    {"albedo-flip-y", "the albedo is upside down", Plane::albedo, nullptr, nullptr, flip_rows},
    {"object-flip-y", "the objects' numbers are upside down", Plane::object, nullptr, nullptr, flip_rows},
    {"depth-flip-x", "the depths are mirrored", Plane::depth, nullptr, nullptr, flip_columns},
    {"position-flip-x", "the positions are mirrored", Plane::position, nullptr, nullptr, flip_columns},
    {"normal-flip-x", "the normals are mirrored", Plane::normal, nullptr, nullptr, flip_columns},
    {"albedo-flip-x", "the albedo is mirrored", Plane::albedo, nullptr, nullptr, flip_columns},
    {"depth-shift-x", "the depths are moved by %s pixels to the right", Plane::depth, nullptr, nullptr, shift_right,
     kOneOf, kPlaneShifts},
    {"position-shift-x", "the positions are moved by %s pixels to the right", Plane::position, nullptr, nullptr,
     shift_right, kOneOf, kPlaneShifts},
    {"normal-shift-x", "the normals are moved by %s pixels to the right", Plane::normal, nullptr, nullptr, shift_right,
     kOneOf, kPlaneShifts},
    {"albedo-shift-x", "the albedo is moved by %s pixels to the right", Plane::albedo, nullptr, nullptr, shift_right,
     kOneOf, kPlaneShifts},
    {"depth-shift-y", "the depths are moved by %s pixels downward", Plane::depth, nullptr, nullptr, shift_down, kOneOf,
     kPlaneShifts},
    {"position-shift-y", "the positions are moved by %s pixels downward", Plane::position, nullptr, nullptr, shift_down,
     kOneOf, kPlaneShifts},
    {"normal-shift-y", "the normals are moved by %s pixels downward", Plane::normal, nullptr, nullptr, shift_down,
     kOneOf, kPlaneShifts},
    {"albedo-shift-y", "the albedo is moved by %s pixels downward", Plane::albedo, nullptr, nullptr, shift_down, kOneOf,
     kPlaneShifts},
    {"depth-reversed", "the depths are reversed: 1 - z", Plane::depth, depth_reversed},
    {"depth-ndc", "the depths are in [-1, 1] where [0, 1] is due", Plane::depth, depth_to_ndc},
    {"depth-halved", "the depths are z / 2 + 1/2: taken from [-1, 1] once too often", Plane::depth, depth_from_ndc},
    {"depth-view", "the depths are distances along the view's axis", Plane::depth, depth_of_view},
    {"depth-over-far", "the depths are distances along the view's axis over far", Plane::depth, depth_over_far},
    {"depth-linear", "the depths are linear from near to far", Plane::depth, depth_linear},
    {"depth-ray", "the depths are distances from the eye", Plane::depth, depth_of_ray},
    {"depth-cleared-to-zero", "the depth is 0 where nothing is drawn", Plane::depth, depth_cleared_to_zero},
    {"depth-bias", "%s is added to the depths", Plane::depth, depth_offset, nullptr, nullptr,
     PlaneFault::Search::depth_offset},
    {"depth-bits", "the depths have %s bits", Plane::depth, depth_rounded, nullptr, nullptr, kOneOf, kDepthBits},
    {"normal-halved", "the normals are stored as n / 2 + 1/2, and not decoded", Plane::normal, normal_halved},
    {"normal-octahedral", "the normals are octahedral, and not decoded", Plane::normal, normal_octahedral},
    {"normal-octahedral-halved",
     "the normals are octahedral, halved into [0, 1], with a third number %s, and not decoded", Plane::normal,
     normal_octahedral_halved, nullptr, nullptr, kOneOf, kThirds},
    {"normal-sphere-map", "the normals are a sphere map's coordinates, and not decoded", Plane::normal,
     normal_sphere_map},
    {"normal-view", "the normals are in view space", Plane::normal, normal_in_view},
    {"normal-object", "the normals are in object space", Plane::normal, normal_in_object},
    {"normal-turned", "the normals point inward", Plane::normal, normal_turned},
    {"normal-unit",
     "the normals are unit length where interpolated ones are due",
     Plane::normal,
     normal_unit,
     nullptr,
     nullptr,
     PlaneFault::Search::none,
     {},
     0.002},
    {"normal-unnormalised",
     "the normals are not unit length: nobody normalised them after the object's matrix",
     Plane::normal,
     normal_unscaled,
     nullptr,
     nullptr,
     PlaneFault::Search::none,
     {},
     0,
     0},
    {"normal-doubled", "the normals are 2 n - 1: decoded once too often", Plane::normal, normal_doubled},
    {"normal-scaled", "the normals are %s times as long as they should be", Plane::normal, normal_scaled, nullptr,
     nullptr, kSmooth, kScaleFactors},
    {"normal-unorm-as-snorm", "the normals' codes of %s bits are unsigned, and taken for signed ones", Plane::normal,
     normal_as_signed, nullptr, nullptr, kOneOf, kCodeBits},
    {"normal-snorm-as-unorm", "the normals' codes of %s bits are signed, and taken for unsigned ones", Plane::normal,
     normal_as_unsigned, nullptr, nullptr, kOneOf, kCodeBits},
    {"normal-bits", "the normals have %s bits", Plane::normal, normal_rounded, nullptr, nullptr, kOneOf, kNormalBits},
    {"normal-zyx", "the normals' components are in the order ZYX", Plane::normal, normal_axes<2, 1, 0>},
    {"normal-xzy", "the normals' components are in the order XZY", Plane::normal, normal_axes<0, 2, 1>},
    {"normal-x-turned", "the normals' X has the wrong sign", Plane::normal, normal_axis_turned<0>},
    {"normal-y-turned", "the normals' Y has the wrong sign", Plane::normal, normal_axis_turned<1>},
    {"normal-z-turned", "the normals' Z has the wrong sign", Plane::normal, normal_axis_turned<2>},
    {"position-view", "the positions are in view space", Plane::position, position_in_view},
    {"position-from-eye", "the positions are relative to the eye", Plane::position, position_from_eye},
    {"position-z-turned", "the positions' Z has the wrong sign", Plane::position, position_mirrored},
    {"position-xzy", "the positions' components are in the order XZY", Plane::position, position_swapped},
    {"position-near", "the positions are rebuilt from depths with a near plane %s times as far as it is",
     Plane::position, position_by_near, nullptr, nullptr, kSmooth, kPositionPlaneFactors},
    {"position-far", "the positions are rebuilt from depths with a far plane %s times as far as it is", Plane::position,
     position_by_far, nullptr, nullptr, kSmooth, kPositionPlaneFactors},
    {"position-scaled", "the positions are %s times what they should be", Plane::position, position_scaled, nullptr,
     nullptr, kSmooth, kScaleFactors},
    {"normal-half", "the normals went through half floats", Plane::normal, normal_as_half},
    {"depth-half", "the depths went through half floats", Plane::depth, depth_as_half},
    {"position-half",
     "the positions went through half floats",
     Plane::position,
     position_as_half,
     nullptr,
     nullptr,
     PlaneFault::Search::none,
     {},
     0.01},
    {"albedo-srgb-encoded", "the albedo is sRGB-encoded", Plane::albedo, albedo_encoded},
    {"albedo-srgb-decoded", "the albedo is decoded as if it were sRGB", Plane::albedo, albedo_decoded},
    {"albedo-premultiplied", "the albedo is multiplied by its alpha", Plane::albedo, albedo_premultiplied},
    {"albedo-bgr", "the albedo's channels are in the order BGR", Plane::albedo, albedo_bgr},
    {"albedo-scaled", "the albedo is %s times what it should be", Plane::albedo, albedo_scaled, nullptr, nullptr,
     kSmooth, kScaleFactors},
    {"albedo-gamma", "the albedo is raised to the power of %s", Plane::albedo, albedo_powered, nullptr, nullptr,
     kSmooth, kPowers, 0.002},
    {"albedo-alpha-srgb-encoded", "the albedo's alpha is sRGB-encoded", Plane::albedo, alpha_encoded},
    {"albedo-alpha-srgb-decoded", "the albedo's alpha is decoded as if it were sRGB", Plane::albedo, alpha_decoded},
    {"albedo-alpha", "the albedo's alpha is %s everywhere", Plane::albedo, albedo_alpha, nullptr, nullptr, kOneOf,
     kPlaneAlphas},
    {"uv-flipped", "v is 1 - v", Plane::uv, uv_flipped},
    {"uv-swapped", "u and v are exchanged", Plane::uv, uv_swapped},
    {"object-offset", "the objects' numbers are off by %s", Plane::object, object_offset, nullptr, nullptr, kOneOf,
     kOffsets},
    {"material-offset", "the materials' numbers are off by %s", Plane::material, material_offset, nullptr, nullptr,
     kOneOf, kOffsets},
};

}  // namespace

std::span<const PlaneFault> plane_faults() { return kPlaneFaults; }

PlaneContext plane_context(const Scene& scene, const Pipeline& pipeline) {
  return {scene, pipeline, view_axes(scene.camera, pipeline), view_of(scene, pipeline).eye};
}

}  // namespace trueshade::oracle
