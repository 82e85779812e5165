#pragma once
#include <glm/vec3.hpp>
#include <iterator>
#include <string_view>
#include <variant>

#include "scenes/light.h"

// The fields of a light, a row each. What reads, writes, checks, moves or hashes lights visits the rows: scene files
// and exports of glTF, `--resolved`, Python, light programs.
namespace trueshade {

/// What a scene file says of a light, and what may move. Properties are set in this order, so that an intensity
/// multiplies the colour of its time.
enum class LightProperty : uint8_t {
  position,
  direction,
  color,
  intensity,
  range,
  attenuation,
  cone,
  penumbra,
  ambient,
  spot_exponent,
  radius,
  right,
  up
};

/// How a property is written in scene files and in Python.
enum class LightValueKind : uint8_t {
  number,
  three_numbers,
  degrees,     ///< the member holds radians
  unit_vector  ///< any vector but 0; the member holds its direction
};

/// Where scene_hash() has a member.
enum class LightHash : uint8_t {
  first,   ///< of all lights
  area,    ///< behind `first`, of lights with an area
  second,  ///< behind a mark, of lights of which a member of this part is not its default
  later    ///< the same behind another mark
};

/// Types of lights, a bit each.
using LightTypeSet = uint32_t;
template <class... Types>
constexpr LightTypeSet set_of(Types... types) {
  return (... | (LightTypeSet(1) << unsigned(types)));
}
constexpr bool contains(LightTypeSet set, LightType type) { return (set & set_of(type)) != 0; }

/// What is known of a field.
struct LightField {
  LightProperty property;
  std::string_view name;    ///< in light programs and exported tracks
  std::string_view key;     ///< in scene files and of Python's add_light()
  std::string_view member;  ///< in exported and resolved scenes; empty: the property is a part of other rows' members
  std::variant<float Light::*, glm::vec3 Light::*> at;
  LightValueKind kind;
  double least, most;  ///< of each number under the key. `least` of kAboveZero: what is above 0
  LightTypeSet types;  ///< lights that have the key
  bool required;       ///< in these lights
  LightHash hash = LightHash::first;
};

inline constexpr double kAboveZero = 1e-30, kMostOfLight = 1e18;

namespace light_sets {
using enum LightType;
inline constexpr LightTypeSet kAll = set_of(ambient, directional, point, spot, sphere, tube, rectangle, disk),
                              kPlaced = set_of(point, spot, sphere, tube, rectangle, disk),
                              kPunctual = set_of(directional, point, spot), kPointLike = set_of(point, spot),
                              kAimed = set_of(directional, spot), kSpot = set_of(spot), kRound = set_of(sphere, tube),
                              kFlat = set_of(rectangle, disk), kWithAxis = set_of(tube, rectangle, disk);
}  // namespace light_sets

/// A row each, in the order of LightProperty.
inline constexpr LightField kLightFields[] = {
    {LightProperty::position, "position", "position", "position", &Light::position, LightValueKind::three_numbers,
     -kMostOfLight, kMostOfLight, light_sets::kPlaced, true},
    {LightProperty::direction, "direction", "direction", "direction", &Light::direction, LightValueKind::unit_vector,
     -1e9, 1e9, light_sets::kAimed, true},
    {LightProperty::color, "color", "color", "color", &Light::color, LightValueKind::three_numbers, 0.0, kMostOfLight,
     light_sets::kAll, false},
    {LightProperty::intensity, "intensity", "intensity", "", &Light::color, LightValueKind::number, 0.0, kMostOfLight,
     light_sets::kAll, false},
    {LightProperty::range, "range", "range", "range", &Light::range, LightValueKind::number, kAboveZero, kMostOfLight,
     light_sets::kPlaced, false},
    {LightProperty::attenuation, "attenuation", "attenuation", "attenuation", &Light::attenuation,
     LightValueKind::three_numbers, 0.0, kMostOfLight, light_sets::kPointLike, false},
    {LightProperty::cone, "cone", "cone_deg", "cone_rad", &Light::cone_rad, LightValueKind::degrees, 0.0, 180.0,
     light_sets::kSpot, true},
    {LightProperty::penumbra, "penumbra", "penumbra_deg", "penumbra_rad", &Light::penumbra_rad, LightValueKind::degrees,
     0.0, 180.0, light_sets::kSpot, false},
    {LightProperty::ambient, "ambient", "ambient", "ambient", &Light::ambient, LightValueKind::three_numbers, 0.0,
     kMostOfLight, light_sets::kPunctual, false, LightHash::second},
    {LightProperty::spot_exponent, "spot_exponent", "spot_exponent", "spot_exponent", &Light::spot_exponent,
     LightValueKind::number, 0.0, 8192.0, light_sets::kSpot, false, LightHash::second},
    {LightProperty::radius, "radius", "radius", "", &Light::right, LightValueKind::number, kAboveZero, kMostOfLight,
     light_sets::kRound, true},
    {LightProperty::right, "right", "right", "right", &Light::right, LightValueKind::three_numbers, -kMostOfLight,
     kMostOfLight, light_sets::kWithAxis, true, LightHash::area},
    {LightProperty::up, "up", "up", "up", &Light::up, LightValueKind::three_numbers, -kMostOfLight, kMostOfLight,
     light_sets::kFlat, true, LightHash::area}};

constexpr const LightField& row_of(LightProperty property) { return kLightFields[size_t(property)]; }
static_assert([] {
  for (size_t i = 0; i < std::size(kLightFields); ++i)
    if (size_t(kLightFields[i].property) != i) return false;
  return true;
}());

/// Calls `visit(row, value)` for each member of a light in the order of the rows; a value is a float or a glm::vec3,
/// const where the light is.
template <class AnyLight, class Visit>
void visit_members(AnyLight& light, const Visit& visit) {
  for (const LightField& row : kLightFields)
    if (!row.member.empty()) std::visit([&](auto member) { visit(row, light.*member); }, row.at);
}

}  // namespace trueshade
