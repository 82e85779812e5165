#pragma once
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <string_view>

namespace trueshade {

enum class LightType : uint8_t { ambient, directional, point, spot, sphere, tube, rectangle, disk };

/// From where a light reaches a surface, and so which field of LightVolumes bounds it.
enum class LightReach : uint8_t {
  everywhere,  ///< the light has no place, and nothing bounds it
  all_around,  ///< its position; LightVolumes::point
  to_one_side  ///< its position, about `direction`; LightVolumes::spot
};

/// What all lights of a type have in common.
struct LightTypeRow {
  std::string_view name;  ///< in files and in all that is printed
  LightReach reach;
  bool is_aimed;  ///< reads Light::direction
  bool in_gltf;   ///< KHR_lights_punctual has the type, by the same name
  bool has_area;  ///< reads Light::right and Light::up
};

/// A row each, in the order of LightType.
inline constexpr LightTypeRow kLightTypes[] = {{"ambient", LightReach::everywhere, false, false, false},
                                               {"directional", LightReach::everywhere, true, true, false},
                                               {"point", LightReach::all_around, false, true, false},
                                               {"spot", LightReach::to_one_side, true, true, false},
                                               {"sphere", LightReach::all_around, false, false, true},
                                               {"tube", LightReach::all_around, false, false, true},
                                               {"rectangle", LightReach::to_one_side, true, false, true},
                                               {"disk", LightReach::to_one_side, true, false, true}};

/// What holds for all lights of a type.
constexpr const LightTypeRow& row_of(LightType type) { return kLightTypes[size_t(type)]; }
/// As scene files have it: `point`.
constexpr std::string_view name_of(LightType type) { return row_of(type).name; }
/// Whether lights of the type have a position, a distance to a surface, and a range.
constexpr bool is_placed(LightType type) { return row_of(type).reach != LightReach::everywhere; }
/// Whether light leaves a surface, which `right` and `up` of the light span.
constexpr bool has_area(LightType type) { return row_of(type).has_area; }

constexpr bool is_ambient(LightType type) { return type == LightType::ambient; }          ///< on all alike
constexpr bool is_directional(LightType type) { return type == LightType::directional; }  ///< from far away
constexpr bool is_spot(LightType type) { return type == LightType::spot; }                ///< in a cone

/// One light in world space. A light model reads the fields it names and no others.
struct Light {
  LightType type = LightType::point;
  glm::vec3 position{0.0f};                ///< scene units; of an area light its centre
  glm::vec3 direction{0.0f, 0.0f, -1.0f};  ///< unit, the way the light travels
  glm::vec3 color{1.0f};                   ///< linear RGB times intensity, of an area light radiance; [0, 1e18]
  float range = std::numeric_limits<float>::infinity();  ///< scene units; a window falloff is 0 from here on
  glm::vec3 attenuation{1.0f, 0.0f, 0.0f};               ///< k0, k1 [1/unit], k2 [1/unit^2]
  float cone_rad = 3.14159265f;                          ///< half angle of the fully lit cone; spot
  float penumbra_rad = 0.0f;                             ///< angle past cone_rad over which the light fades to 0; spot
  glm::vec3 ambient{0.0f};     ///< its share of ambient light, falling off as `color` does; each in [0, 1e18]
  float spot_exponent = 0.0f;  ///< of the cosine to the axis; in [0, 8192]; spot
  // Half extents of area lights, scene units:
  //   sphere           right.x: its radius
  //   tube             right: half of its axis, from the middle to an end; up.x: its radius
  //   rectangle, disk  right and up: from the centre to the edge, at right angles; light goes to the side of
  //                    cross(up, right) alone, whose unit vector `direction` is
  glm::vec3 right{0.0f}, up{0.0f};
};

/// Light of this colour that reaches every surface alike, whichever way it faces.
inline Light ambient_light(const glm::vec3& color) {
  Light light;
  light.type = LightType::ambient;
  light.color = color;
  return light;
}

}  // namespace trueshade
