#pragma once
#include <cmath>
#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>

#include "scenes/scene.h"

// The generators behind builtin_scene(), one file each.
namespace trueshade::builtin {

/// What the text after the scene's name said.
struct Parameters {
  std::optional<uint32_t> lights, objects;  ///< absent: the scene's own number
  uint64_t seed = 1;
  bool constant_radius = false;  ///< radius=constant: lights keep their range however many there are
  bool glass = false;            ///< glass=1: with transparent surfaces

  uint32_t lights_or(uint32_t usual) const { return lights.value_or(usual); }
  uint32_t objects_or(uint32_t usual) const { return objects.value_or(usual); }

  /// What ranges and heights of lights are multiplied by. radius=overlap: lights spread over a surface reach as many
  /// neighbours as the scene's own number would, so a range shrinks as the square root of their number grows.
  double reach(uint32_t usual_lights) const {
    const uint32_t count = lights_or(usual_lights);
    return constant_radius || count == 0 ? 1.0 : std::sqrt(double(usual_lights) / double(count));
  }
};

/// A point light of both light models: the linear window ends at `range`, the quadratic falloff is 1/12 there.
Light point_light(const glm::dvec3& position, const glm::dvec3& color, double range);

/// Adds a light that goes round an ellipse, or to and fro where one axis is 0; see Orbit. Its place at time 0 is its
/// own.
void add_moving(Scene& scene, const Light& light, const glm::dvec3& u, const glm::dvec3& v, double period,
                double phase);

/// Point `index` of an endless sequence in the unit square that fills it evenly from the start (Martin Roberts, "The
/// Unreasonable Effectiveness of Quasirandom Sequences", 2018: R2).
glm::dvec2 even_point(uint32_t index);

/// Saturated colour of a hue in turns (any real), red at 0, of largest channel 1 and smallest channel 1 - saturation.
glm::dvec3 color_of_hue(double hue, double saturation);

Mesh rabbit_mesh();  ///< closed, 40,000 triangles, about 1 unit high, standing on y = 0 and looking along +z
Mesh knot_mesh();    ///< a fluted tube along the (2, 3) torus knot, of radius 1.6 about the y axis; closed

Scene city(const Parameters& parameters);
Scene rabbits(const Parameters& parameters);
Scene sphere(const Parameters& parameters);
Scene red(const Parameters& parameters);
Scene cornell(const Parameters& parameters);
Scene circle(const Parameters& parameters);
Scene lecture(const Parameters& parameters);
Scene atrium(const Parameters& parameters);

}  // namespace trueshade::builtin
