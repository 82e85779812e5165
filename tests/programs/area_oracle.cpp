#include "area_oracle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

// How it works.
//
// Seen from the receiving point, each light is described in spherical coordinates about a pole: at each azimuth it
// covers one interval of polar angles. Directions are w = cos(polar) * pole + sin(polar) * side(azimuth), and the
// element of solid angle is sin(polar) d(polar) d(azimuth).
//   sphere:             the pole points to the centre.
//   rectangle and disk: the pole is the direction from the point to its foot on the plane of the light.
//   tube:               the pole is the axis of the tube.
// Along one azimuth dot(normal, w) changes sign at most once, at a polar angle known exactly, so the inner integral
// over polar angles is of a smooth function. The outer integral is split wherever the inner limits have a kink, which
// is at corners, at tangents and where the horizon crosses the outline, and each part is subdivided adaptively.

namespace trueshade {
namespace {

using glm::dvec3;
using std::numbers::pi;

// ---------------------------------------------------------------------------------------------------------------------
// Adaptive integration of a function with three values.

// The non-negative nodes on [-1, 1] of the Kronrod rule of 15 points, with its weights, and the weights of the Gauss
// rule of 7 points that shares the nodes of odd index (0 where a node is not shared). They are those of QUADPACK.
constexpr std::array<double, 8> kronrod_nodes = {
    0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
    0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
    0.586087235467691130294144691693013, 0.405845151377397166906606412076961,
    0.207784955007898467600689403773245, 0.0};
constexpr std::array<double, 8> kronrod_weights = {
    0.022935322010529224963732008058970, 0.063092092629978553290700663189204, 0.104790010322250183839876322541518,
    0.140653259715525918745189590510238, 0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
    0.204432940075298892414161999234649, 0.209482141084727828012999174891714};
constexpr std::array<double, 8> gauss_weights = {
    0.0, 0.129484966168869693270611432679082, 0.0, 0.279705391489276667901467771423780,
    0.0, 0.381830050505118944950369775488975, 0.0, 0.417959183673469387755102040816327};

// The integral of a function of three values, by the Kronrod rule, and an estimate of its error: the absolute
// difference between that rule and the Gauss rule.
struct Estimate {
  dvec3 value{0.0};
  dvec3 error{0.0};
};

// Integrates function over [from, to] by one application of the Kronrod rule.
template <typename Function>
Estimate apply_kronrod(const Function& function, double from, double to) {
  const double middle = 0.5 * (from + to);
  const double half = 0.5 * (to - from);
  dvec3 kronrod = kronrod_weights[7] * function(middle);
  dvec3 gauss = gauss_weights[7] / kronrod_weights[7] * kronrod;
  for (int index = 0; index < 7; ++index) {
    const double step = half * kronrod_nodes[index];
    const dvec3 pair = function(middle - step) + function(middle + step);
    kronrod += kronrod_weights[index] * pair;
    gauss += gauss_weights[index] * pair;
  }
  return {half * kronrod, glm::abs(half * (kronrod - gauss))};
}

// A part of the range of integration: the fractions begin to end of the interval from .. to between two breaks.
struct Part {
  double from, to, begin, end;
  Estimate estimate;
};

// Integrates function over one part. Within an interval the variable is x = from + (to - from) * t * t * (3 - 2 * t),
// whose derivative vanishes at both ends, so that a function that goes like a square root at a tangent becomes smooth.
template <typename Function>
Part make_part(const Function& function, double from, double to, double begin, double end) {
  const double length = to - from;
  const auto smoothed = [&](double t) {
    return 6.0 * t * (1.0 - t) * length * function(from + length * t * t * (3.0 - 2.0 * t));
  };
  return {from, to, begin, end, apply_kronrod(smoothed, begin, end)};
}

// How exact an integral must be: each value to within the larger of the absolute and the relative bound.
struct Goal {
  double absolute;
  double relative;
  std::size_t most_parts;
};

// Returns the error of the estimate as a multiple of what is allowed, for the worst of the three values.
double excess(const dvec3& error, const dvec3& total, const Goal& goal) {
  double worst = 0.0;
  for (int channel = 0; channel < 3; ++channel) {
    const double allowed = std::max(goal.absolute, goal.relative * std::abs(total[channel]));
    worst = std::max(worst, error[channel] / std::max(allowed, 1e-300));
  }
  return worst;
}

// Integrates function from the first to the last of the sorted breaks, halving the worst part until the goal is met.
template <typename Function>
Estimate integrate(const Function& function, const std::vector<double>& breaks, const Goal& goal) {
  std::vector<Part> parts;
  for (std::size_t index = 1; index < breaks.size(); ++index) {
    if (breaks[index] > breaks[index - 1]) {
      parts.push_back(make_part(function, breaks[index - 1], breaks[index], 0.0, 1.0));
    }
  }
  while (true) {
    Estimate total;
    for (const Part& part : parts) {
      total.value += part.estimate.value;
      total.error += part.estimate.error;
    }
    if (excess(total.error, total.value, goal) <= 1.0 || parts.size() >= goal.most_parts) {
      return total;
    }
    const auto worst = std::max_element(parts.begin(), parts.end(), [&](const Part& left, const Part& right) {
      return excess(left.estimate.error, total.value, goal) < excess(right.estimate.error, total.value, goal);
    });
    const Part whole = *worst;
    const double middle = 0.5 * (whole.begin + whole.end);
    *worst = make_part(function, whole.from, whole.to, whole.begin, middle);
    parts.push_back(make_part(function, whole.from, whole.to, middle, whole.end));
  }
}

// Sorts the breaks and keeps those between low and high, with both of these added.
void keep_between(std::vector<double>& breaks, double low, double high) {
  std::erase_if(breaks, [&](double value) { return !(value > low && value < high); });
  breaks.push_back(low);
  breaks.push_back(high);
  std::sort(breaks.begin(), breaks.end());
}

// Adds the angles, in radians, at which a * cos(angle) + b * sin(angle) = c.
void add_crossings(std::vector<double>& angles, double a, double b, double c) {
  const double length = std::hypot(a, b);
  if (length > 0.0 && std::abs(c) <= length) {
    const double middle = std::atan2(b, a);
    const double half = std::acos(c / length);
    angles.push_back(middle - half);
    angles.push_back(middle + half);
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// The lights as seen from the receiving point.

// The directions of a light at one value of the outer variable. Angles are in radians.
struct Slice {
  double azimuth = 0.0;
  double low = 0.0;      // The lowest polar angle that the light covers.
  double high = 0.0;     // The highest polar angle. The slice is empty unless it is above low.
  double stretch = 1.0;  // The derivative of the azimuth by the outer variable.
};

// A light in spherical coordinates about a pole. A view without breaks holds a light that cannot be seen.
struct LightView {
  dvec3 pole{0.0}, first{0.0}, second{0.0};  // An orthonormal frame. Azimuths turn from first to second.
  double from = 0.0, to = 0.0;               // The range of the outer variable.
  std::function<Slice(double)> slice;        // The slice at a value of the outer variable.
  std::function<double(double)> locate;      // The outer variable at an azimuth. Empty if they are the same.
  std::vector<double> breaks;                // The values at which the inner limits have a kink. Sorted.
};

// Returns the azimuth of a direction in the frame of the view, in 0 .. 2 * pi.
double azimuth_of(const LightView& view, const dvec3& direction) {
  const double angle = std::atan2(glm::dot(direction, view.second), glm::dot(direction, view.first));
  return angle < 0.0 ? angle + 2.0 * pi : angle;
}

// Returns a unit vector perpendicular to the given unit vector.
dvec3 any_perpendicular(const dvec3& direction) {
  const dvec3 helper = std::abs(direction.x) < 0.6 ? dvec3(1.0, 0.0, 0.0) : dvec3(0.0, 1.0, 0.0);
  return glm::normalize(glm::cross(direction, helper));
}

// The outer variable is the azimuth itself: wraps the breaks into 0 .. 2 * pi.
void use_azimuth(LightView& view, std::vector<double> breaks) {
  view.from = 0.0;
  view.to = 2.0 * pi;
  for (double& value : breaks) {
    value -= 2.0 * pi * std::floor(value / (2.0 * pi));
  }
  view.breaks = std::move(breaks);
  keep_between(view.breaks, view.from, view.to);
}

// A sphere fills the cone of directions around its centre whose half angle has the sine radius / distance.
LightView view_sphere(const AreaShape& shape, const dvec3& point, const dvec3& normal) {
  LightView view;
  const double distance = glm::length(shape.centre - point);
  if (distance <= shape.radius || shape.radius <= 0.0) {
    return view;
  }
  view.pole = (shape.centre - point) / distance;
  view.first = any_perpendicular(view.pole);
  view.second = glm::cross(view.pole, view.first);
  const double half_angle = std::asin(shape.radius / distance);
  view.slice = [half_angle](double azimuth) { return Slice{azimuth, 0.0, half_angle, 1.0}; };
  std::vector<double> breaks;
  const double sine = std::sin(half_angle);
  add_crossings(breaks, sine * glm::dot(normal, view.first), sine * glm::dot(normal, view.second),
                -std::cos(half_angle) * glm::dot(normal, view.pole));
  use_azimuth(view, std::move(breaks));
  return view;
}

// The geometry that a rectangle and a disk share. Lengths are in world units.
struct Plane {
  double height;                  // The distance of the point from the plane.
  double foot_x, foot_y;          // The foot of the point on the plane, from the centre along right and up.
  double half_x, half_y;          // The lengths of right and up.
  double slope_x, slope_y, rest;  // dot(normal, q - point) = slope_x * x + slope_y * y + rest on the plane.
};

// Sets the frame of the view for a light in a plane. Returns false if the point is not in front of the light.
bool face_plane(const AreaShape& shape, const dvec3& point, const dvec3& normal, LightView& view, Plane& plane) {
  const dvec3 across = glm::cross(shape.up, shape.right);
  if (!(glm::length(across) > 0.0)) {
    return false;
  }
  view.pole = -glm::normalize(across);
  view.first = glm::normalize(shape.right);
  view.second = glm::normalize(shape.up);
  const dvec3 offset = point - shape.centre;
  plane.height = -glm::dot(offset, view.pole);
  plane.foot_x = glm::dot(offset, view.first);
  plane.foot_y = glm::dot(offset, view.second);
  plane.half_x = glm::length(shape.right);
  plane.half_y = glm::length(shape.up);
  plane.slope_x = glm::dot(normal, view.first);
  plane.slope_y = glm::dot(normal, view.second);
  plane.rest = -glm::dot(normal, offset);
  return plane.height > 0.0;
}

// Narrows the distances near .. far, along a line in the plane, to those at which |start + distance * step| <= half.
void clip_slab(double start, double step, double half, double& near, double& far) {
  if (step == 0.0) {
    far = std::abs(start) <= half ? far : -1.0;
    return;
  }
  const double one = (-half - start) / step;
  const double two = (half - start) / step;
  near = std::max(near, std::min(one, two));
  far = std::min(far, std::max(one, two));
}

// Returns the polar angles that a rectangle covers at an azimuth.
Slice slice_rectangle(const Plane& plane, double azimuth) {
  double near = 0.0;
  double far = 1e300;
  clip_slab(plane.foot_x, std::cos(azimuth), plane.half_x, near, far);
  clip_slab(plane.foot_y, std::sin(azimuth), plane.half_y, near, far);
  if (far <= near) {
    return Slice{azimuth, 0.0, 0.0, 1.0};
  }
  return Slice{azimuth, std::atan2(near, plane.height), std::atan2(far, plane.height), 1.0};
}

// Returns the polar angles that a disk covers at an azimuth, from the line's two crossings with its edge.
Slice slice_disk(const Plane& plane, double azimuth) {
  const double start_x = plane.foot_x / plane.half_x;
  const double start_y = plane.foot_y / plane.half_y;
  const double step_x = std::cos(azimuth) / plane.half_x;
  const double step_y = std::sin(azimuth) / plane.half_y;
  const double square = step_x * step_x + step_y * step_y;
  const double mixed = start_x * step_x + start_y * step_y;
  const double across = start_x * step_y - start_y * step_x;
  const double inside = square - across * across;
  const double reach = (std::sqrt(std::max(inside, 0.0)) - mixed) / square;
  const double near = std::max(0.0, (-std::sqrt(std::max(inside, 0.0)) - mixed) / square);
  if (inside <= 0.0 || reach <= near) {
    return Slice{azimuth, 0.0, 0.0, 1.0};
  }
  return Slice{azimuth, std::atan2(near, plane.height), std::atan2(reach, plane.height), 1.0};
}

// Adds the azimuth of a point of the plane, given from the centre along right and up, as seen from the foot.
void add_azimuth(std::vector<double>& breaks, const Plane& plane, double x, double y) {
  breaks.push_back(std::atan2(y - plane.foot_y, x - plane.foot_x));
}

// A rectangle has kinks at its corners and where the horizon crosses its edges.
LightView view_rectangle(const AreaShape& shape, const dvec3& point, const dvec3& normal) {
  LightView view;
  Plane plane;
  if (!face_plane(shape, point, normal, view, plane)) {
    return view;
  }
  std::vector<double> breaks;
  for (const double side : {-1.0, 1.0}) {
    const double x = side * plane.half_x;
    const double y = side * plane.half_y;
    add_azimuth(breaks, plane, x, plane.half_y);
    add_azimuth(breaks, plane, x, -plane.half_y);
    const double crossing_y = -(plane.slope_x * x + plane.rest) / plane.slope_y;
    const double crossing_x = -(plane.slope_y * y + plane.rest) / plane.slope_x;
    if (std::abs(crossing_y) <= plane.half_y) {
      add_azimuth(breaks, plane, x, crossing_y);
    }
    if (std::abs(crossing_x) <= plane.half_x) {
      add_azimuth(breaks, plane, crossing_x, y);
    }
  }
  view.slice = [plane](double azimuth) { return slice_rectangle(plane, azimuth); };
  use_azimuth(view, std::move(breaks));
  return view;
}

// A disk has kinks at the tangents from the foot and where the horizon crosses its edge.
LightView view_disk(const AreaShape& shape, const dvec3& point, const dvec3& normal) {
  LightView view;
  Plane plane;
  if (!face_plane(shape, point, normal, view, plane)) {
    return view;
  }
  const double scaled_x = plane.foot_x / plane.half_x;
  const double scaled_y = plane.foot_y / plane.half_y;
  std::vector<double> rim;  // Angles on the edge, where x = half_x * cos(angle) and y = half_y * sin(angle).
  add_crossings(rim, scaled_x, scaled_y, 1.0);
  add_crossings(rim, plane.slope_x * plane.half_x, plane.slope_y * plane.half_y, -plane.rest);
  std::vector<double> breaks;
  for (const double angle : rim) {
    add_azimuth(breaks, plane, plane.half_x * std::cos(angle), plane.half_y * std::sin(angle));
  }
  // A foot near the edge sees the extent change quickly across the direction of the edge.
  const double along = std::atan2(scaled_x * plane.half_y, -scaled_y * plane.half_x);
  breaks.push_back(along);
  breaks.push_back(along + pi);
  view.slice = [plane](double azimuth) { return slice_disk(plane, azimuth); };
  use_azimuth(view, std::move(breaks));
  return view;
}

// The geometry of a tube. Lengths are in world units.
struct Barrel {
  double radius;
  double distance;        // The distance of the point from the axis.
  double start_z, end_z;  // The ends of the tube along the axis, from the point.
};

// Returns the polar angles that a tube covers at an angle around its axis, counted from the side that faces the point.
Slice slice_tube(const Barrel& barrel, double angle) {
  const double x = barrel.distance - barrel.radius * std::cos(angle);
  const double y = barrel.radius * std::sin(angle);
  const double square = x * x + y * y;
  const double across = std::sqrt(square);
  const double stretch = barrel.radius * (barrel.distance * std::cos(angle) - barrel.radius) / square;
  return {std::atan2(y, x), std::atan2(across, barrel.end_z), std::atan2(across, barrel.start_z), stretch};
}

// Returns the angle around the axis at which the half plane of an azimuth first meets the tube.
double locate_on_tube(const Barrel& barrel, double azimuth) {
  const double inside = barrel.radius * barrel.radius - std::pow(barrel.distance * std::sin(azimuth), 2);
  if (inside < 0.0 || std::cos(azimuth) <= 0.0) {
    return -10.0;  // The half plane misses the tube. This value is outside every range, so it is left out later.
  }
  const double reach = barrel.distance * std::cos(azimuth) - std::sqrt(inside);
  return std::atan2(reach * std::sin(azimuth), barrel.distance - reach * std::cos(azimuth));
}

// A tube is sliced by its angle around the axis. It has kinks where the horizon crosses its two ends.
LightView view_tube(const AreaShape& shape, const dvec3& point, const dvec3& normal) {
  LightView view;
  const double half_length = glm::length(shape.right);
  const dvec3 offset = shape.centre - point;
  if (!(half_length > 0.0) || !(shape.radius > 0.0)) {
    return view;
  }
  view.pole = shape.right / half_length;
  const double middle_z = glm::dot(offset, view.pole);
  const dvec3 towards_axis = offset - middle_z * view.pole;
  const Barrel barrel{shape.radius, glm::length(towards_axis), middle_z - half_length, middle_z + half_length};
  if (barrel.distance <= shape.radius) {
    return view;
  }
  view.first = towards_axis / barrel.distance;
  view.second = glm::cross(view.pole, view.first);
  view.to = std::acos(shape.radius / barrel.distance);
  view.from = -view.to;
  const dvec3 local(glm::dot(normal, view.first), glm::dot(normal, view.second), glm::dot(normal, view.pole));
  for (const double z : {barrel.start_z, barrel.end_z}) {
    add_crossings(view.breaks, -shape.radius * local.x, shape.radius * local.y,
                  -(barrel.distance * local.x + z * local.z));
  }
  for (double& angle : view.breaks) {
    angle = std::remainder(angle, 2.0 * pi);
  }
  keep_between(view.breaks, view.from, view.to);
  view.slice = [barrel](double angle) { return slice_tube(barrel, angle); };
  view.locate = [barrel](double azimuth) { return locate_on_tube(barrel, azimuth); };
  return view;
}

// Returns the light as seen from the point.
LightView view_shape(const AreaShape& shape, const dvec3& point, const dvec3& normal) {
  switch (shape.kind) {
    case AreaShape::Kind::sphere:
      return view_sphere(shape, point, normal);
    case AreaShape::Kind::tube:
      return view_tube(shape, point, normal);
    case AreaShape::Kind::rectangle:
      return view_rectangle(shape, point, normal);
    case AreaShape::Kind::disk:
      return view_disk(shape, point, normal);
  }
  return {};
}

// ---------------------------------------------------------------------------------------------------------------------
// Integrals over the visible directions.

// The visible directions of one slice: w = cos(polar) * pole + sin(polar) * side.
struct Arc {
  dvec3 pole, side;
  double low, high;  // Radians. The arc is empty unless high is above low.
  double stretch;    // The derivative of the azimuth by the outer variable.

  dvec3 direction(double polar) const { return std::cos(polar) * pole + std::sin(polar) * side; }
};

// Returns the slice at a value of the outer variable, cut off where dot(normal, w) is not positive.
Arc visible_arc(const LightView& view, const dvec3& normal, double outer) {
  const Slice slice = view.slice(outer);
  const dvec3 side = std::cos(slice.azimuth) * view.first + std::sin(slice.azimuth) * view.second;
  Arc arc{view.pole, side, slice.low, slice.high, slice.stretch};
  const double along_pole = glm::dot(normal, view.pole);
  const double along_side = glm::dot(normal, side);
  if (along_pole > 0.0) {
    arc.high = std::min(arc.high, std::atan2(along_pole, -along_side));
  } else if (along_pole < 0.0) {
    arc.low = std::max(arc.low, std::atan2(-along_pole, along_side));
  } else if (along_side <= 0.0) {
    arc.high = arc.low;
  }
  return arc;
}

// The surface at the receiving point, for the mirror reflection.
struct Receiver {
  dvec3 normal;
  dvec3 eye;     // The direction from the point to the eye.
  dvec3 facing;  // F0, the reflectance when H is along the eye, per colour channel.
  double alpha;  // The width of the distribution of microfacets.
};

// Returns g(x) of the visibility term.
double visibility_part(double x, double alpha) {
  const double square = alpha * alpha;
  return 1.0 / (x + std::sqrt(square + (1.0 - square) * x * x));
}

// Returns F * D * V * dot(normal, w), per steradian, for a direction above the horizon.
dvec3 mirror_density(const Receiver& surface, const dvec3& direction) {
  const double cosine = glm::dot(surface.normal, direction);
  const dvec3 sum = direction + surface.eye;
  const double length = glm::length(sum);
  if (cosine <= 0.0 || length <= 0.0 || glm::dot(surface.normal, sum) <= 0.0) {
    return dvec3(0.0);
  }
  const dvec3 half = sum / length;
  const double square = surface.alpha * surface.alpha;
  // The base of D is (n.h)^2 (a^2 - 1) + 1 = a^2 (n.h)^2 + |n x h|^2, which keeps its digits near the peak.
  const double facet = glm::dot(surface.normal, half);
  const dvec3 tilt = glm::cross(surface.normal, half);
  const double base = square * facet * facet + glm::dot(tilt, tilt);
  const double distribution = square / (pi * base * base);
  const double visibility = visibility_part(cosine, surface.alpha) *
                            visibility_part(std::abs(glm::dot(surface.normal, surface.eye)), surface.alpha);
  const double grazing = std::pow(1.0 - std::min(1.0, std::abs(glm::dot(surface.eye, half))), 5);
  const dvec3 fresnel = surface.facing + (1.0 - surface.facing) * grazing;
  return fresnel * (distribution * visibility * cosine);
}

// Returns the direction in which a flat mirror would reflect the eye.
dvec3 mirror_direction(const Receiver& surface) {
  return 2.0 * glm::dot(surface.normal, surface.eye) * surface.normal - surface.eye;
}

// Integrates mirror_density * sin(polar) over the arc, split where D peaks and where dot(normal, H) changes sign.
dvec3 mirror_along(const Receiver& surface, const Arc& arc) {
  std::vector<double> breaks;
  const dvec3 peak = mirror_direction(surface);
  const double polar = std::atan2(glm::dot(peak, arc.side), glm::dot(peak, arc.pole));
  for (const double widths : {-12.0, -2.0, 0.0, 2.0, 12.0}) {
    breaks.push_back(polar + widths * surface.alpha);
  }
  const double eye_cosine = glm::dot(surface.normal, surface.eye);
  if (eye_cosine < 0.0) {
    add_crossings(breaks, glm::dot(surface.normal, arc.pole), glm::dot(surface.normal, arc.side), -eye_cosine);
  }
  keep_between(breaks, arc.low, arc.high);
  const auto density = [&](double angle) { return std::sin(angle) * mirror_density(surface, arc.direction(angle)); };
  return integrate(density, breaks, Goal{0.0, 1e-7, 60}).value;
}

// Integrates F * D * V * max(dot(normal, w), 0) over the solid angle of the visible directions.
dvec3 mirror_integral(const LightView& view, const Receiver& surface) {
  if (view.breaks.empty()) {
    return dvec3(0.0);
  }
  const double azimuth = azimuth_of(view, mirror_direction(surface));
  std::vector<double> breaks = view.breaks;
  breaks.push_back(view.locate ? view.locate(azimuth) : azimuth);
  keep_between(breaks, view.from, view.to);
  const auto along = [&](double outer) {
    const Arc arc = visible_arc(view, surface.normal, outer);
    return arc.high > arc.low ? arc.stretch * mirror_along(surface, arc) : dvec3(0.0);
  };
  return integrate(along, breaks, Goal{0.0, 1e-5, 200}).value;
}

}  // namespace

double form_factor(const AreaShape& shape, const dvec3& point, const dvec3& normal, double* error_estimate) {
  const LightView view = view_shape(shape, point, normal);
  Estimate total;
  if (!view.breaks.empty()) {
    // The inner integrand is dot(normal, w) * sin(polar), a trigonometric polynomial of degree 2, for which one
    // application of the Kronrod rule over at most half a turn is exact to rounding.
    const auto along = [&](double outer) {
      const Arc arc = visible_arc(view, normal, outer);
      if (arc.high <= arc.low) {
        return dvec3(0.0);
      }
      const auto density = [&](double polar) {
        return dvec3(glm::dot(normal, arc.direction(polar)) * std::sin(polar), 0.0, 0.0);
      };
      return arc.stretch * apply_kronrod(density, arc.low, arc.high).value;
    };
    total = integrate(along, view.breaks, Goal{1e-8, 0.0, 300});
  }
  if (error_estimate != nullptr) {
    *error_estimate = total.error.x / pi;
  }
  return total.value.x / pi;
}

Reflected reflected(const AreaShape& shape, const dvec3& point, const dvec3& normal, const dvec3& eye,
                    const double albedo[3], double metallic, double roughness) {
  const dvec3 colour(albedo[0], albedo[1], albedo[2]);
  const Receiver surface{normal, glm::normalize(eye - point), dvec3(0.04) * (1.0 - metallic) + colour * metallic,
                         std::max(roughness * roughness, 0.001)};
  const dvec3 diffuse = colour * ((1.0 - metallic) * form_factor(shape, point, normal));
  const dvec3 mirror = mirror_integral(view_shape(shape, point, normal), surface);
  return {{diffuse.x, diffuse.y, diffuse.z}, {mirror.x, mirror.y, mirror.z}};
}

}  // namespace trueshade
