#pragma once
#include <array>
#include <span>

#include "scenes/scene.h"
#include "scenes/scene_defaults.h"

namespace trueshade {

/// The mean luminance that a scene's surfaces give back of white light, in [0, 1e18]: colours of materials times the
/// means of vertices' colours and of colour maps (the smallest level of a whole chain), each instance by its triangles.
double mean_reflectance(const Scene& scene);

inline constexpr size_t kLightsOfOurs = 4;  ///< that add_lights_of_ours() appends, the last of them ambient

/// Appends lights of ours to those of a scene, as a photographer lights an object: a warm key light from the upper
/// left, a cool fill light from the right, a light from behind, and faint ambient light, over a dark background. Dark
/// surfaces get more light, up to 5 times as much as grey ones but none that would cut a bright surface off at 1, and
/// white ones less. Lamps less than 1e-9 units away shine as from far away. In a photometric scene the lights are as
/// bright at their distance as in others. None where the scene has them already.
void add_lights_of_ours(Scene& scene);

struct LampPlace {
  glm::vec3 position;   ///< of a point light
  glm::vec3 direction;  ///< of a directional light
};
/// Where its lamps stand, all lights of ours but the ambient one, for an eye that has gone around `vertical`, an axis
/// of length 1, from the front (+z, or -y where z is vertical) to the right: at `turn` = (sine, cosine) of that angle.
/// They go with the eye, so that a model is lit from every side as from the front. At (0, 1) as add_lights_of_ours()
/// places them.
std::array<LampPlace, kLightsOfOurs - 1> lamps_for(const Scene& scene, const glm::dvec3& vertical,
                                                   const glm::dvec2& turn);

/// Puts the lamps of a scene there.
void place_lamps(Scene& scene, std::span<const LampPlace> places);
/// The same around the y axis.
void turn_lamps(Scene& scene, const glm::dvec2& turn);

/// How many times as much light one of these lamps gives in a photometric scene as in others; 1 for ambient light.
double spread_light(const Light& lamp);

/// Puts a level grey disc under what is drawn, a little below its lowest point, eight times as wide. It is darker
/// where there is more light of ours, so that it looks the same under any object, and far away it is as the background.
/// Nothing where nothing is drawn, where the disc would leave the range of positions, or where lamps shine as from far
/// away, so that no part of the disc would be dark. The camera's far plane is
/// moved behind it; the camera of camera_seeing() is above it.
void add_ground(Scene& scene);
/// Takes that instance away, where there is one; its mesh and its material stay.
void remove_ground(Scene& scene);

/// Moves a camera's far plane behind that ground. `bounds`: of what stands on it, see bounds_without_ground().
void see_ground(Camera& camera, const Bounds& bounds);

}  // namespace trueshade
