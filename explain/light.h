#pragma once
#include <array>
#include <cstdint>
#include <string_view>

#include "explain/surface.h"
#include "shading/light/light_table.h"

namespace trueshade {

/// Why a light adds something to a pixel, or does not. A light in reach whose term is 0 gets the first fate that
/// applies of faces_away, behind_light, outside_cone and gives_nothing, whatever made the term 0.
enum class LightFate : uint8_t {
  adds,
  out_of_reach,   ///< the squared distance is not below the falloff's or the extent's end, or not finite
  not_drawn,      ///< its geometry does not cover the pixel, or is culled there
  faces_away,     ///< it adds nothing, and N . D is not above 0
  outside_cone,   ///< it adds nothing, and its direction is not within its outer cone
  behind_light,   ///< it adds nothing, and lies on the side to which a rectangle or disk does not shine
  gives_nothing,  ///< it adds nothing
};
inline constexpr size_t kLightFates = 7;

/// The text of a fate in accounts: `out of reach`.
std::string_view text(LightFate fate);

/// What one light adds to a surface (docs/arithmetic.md section 8 or docs/light_programs.md).
struct LightAtPixel {
  LightFate fate = LightFate::adds;
  float d = 0;                  ///< distance of a point or spot light, scene units
  std::array<float, 3> term{};  ///< R, G, B; 0 where it is out of reach
};

/// Whether a light reaches the surface: it has no place, or the squared distance is below the row's cut2. False where
/// the distance is NaN. Sets at.d, the distance, for a light that has a place, whatever the result.
bool in_reach(const LightRow& light, const SurfacePlanes& surface, LightAtPixel& at);

/// Why a light that reaches the surface adds nothing: one of the last four fates, the first that applies in the order
/// that LightFate states.
LightFate fate_without_light(const Light& light, const SurfacePlanes& surface);

/// The number that lights are sorted by: |R| + |G| + |B| of the term, or infinity where this sum is NaN.
float strength(const LightAtPixel& light);

/// Whether the surface lies within the light's extent, so that the light is drawn there. True where the extent has no
/// end; false where the distance is NaN.
bool inside_extent(const LightRow& light, const SurfacePlanes& surface);

}  // namespace trueshade
