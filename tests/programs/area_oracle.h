// An independent numerical oracle for area lights, for tests only.
//
// Everything here is found by deterministic numerical integration over directions, in double precision. No closed
// form of an illumination integral is used, so the oracle shares nothing with the code that it judges.
//
// Positions and lengths are in world units, directions are unit vectors, and every light has unit radiance.
#pragma once

#include <glm/glm.hpp>

namespace trueshade {

// An area light with Lambertian emission.
//
// sphere:    centre and radius. It emits outward, and a point inside it receives nothing.
// tube:      the side, without end caps, of the circular cylinder about the segment from centre - right to
//            centre + right. It emits outward.
// rectangle: the points centre + x * right + y * up with |x| <= 1 and |y| <= 1. right and up are perpendicular half
//            extents. It emits only on the side that normalize(cross(up, right)) points to.
// disk:      the points centre + x * right + y * up with x * x + y * y <= 1, emitting on the same side.
struct AreaShape {
  enum class Kind { sphere, tube, rectangle, disk };

  Kind kind = Kind::sphere;
  glm::dvec3 centre{0.0};
  glm::dvec3 right{0.0};  // World units. A sphere ignores it.
  glm::dvec3 up{0.0};     // World units. A sphere and a tube ignore it.
  double radius = 0.0;    // World units. A rectangle and a disk ignore it.
};

// Light reflected towards the eye, one value per colour channel, for a light of unit radiance.
struct Reflected {
  double diffuse[3];
  double mirror[3];
};

// Returns the integral of max(dot(normal, w), 0) / pi over the solid angle of the visible directions w of the light.
// The result has no unit and lies between 0 and 1. normal must have unit length.
// If error_estimate is given, it receives a bound on the absolute error that is usually far too large.
double form_factor(const AreaShape& shape, const glm::dvec3& point, const glm::dvec3& normal,
                   double* error_estimate = nullptr);

// Returns the diffuse and the mirror reflection at the point, as seen from the position eye.
//
// With E = normalize(eye - point), H = normalize(w + E), a = max(roughness * roughness, 0.001) and
// F0 = mix(0.04, albedo, metallic):
//   diffuse = albedo * (1 - metallic) * form_factor.
//   mirror  = the integral of F * D * V * max(dot(normal, w), 0) over the solid angle of the visible directions w.
//   D = a^2 / (pi * (dot(normal, H)^2 * (a^2 - 1) + 1)^2) where dot(normal, H) > 0, and 0 elsewhere.
//   V = g(dot(normal, w)) * g(|dot(normal, E)|), with g(x) = 1 / (x + sqrt(a^2 + (1 - a^2) * x^2)).
//   F = F0 + (1 - F0) * (1 - |dot(E, H)|)^5.
Reflected reflected(const AreaShape& shape, const glm::dvec3& point, const glm::dvec3& normal, const glm::dvec3& eye,
                    const double albedo[3], double metallic, double roughness);

}  // namespace trueshade
