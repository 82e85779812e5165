#pragma once
#include <array>
#include <cstdint>
#include <string_view>

#include "explain/surface.h"
#include "shading/light/light_table.h"

namespace trueshade {

/// Why a light adds something to a pixel, or does not. Of the last three the first that holds: a light that adds
/// nothing to a surface that faces away from it is `faces_away`, whatever made the light's term 0.
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
std::string_view text(LightFate fate);

/// What a light adds to a pixel: docs/arithmetic.md section 8 or docs/light_programs.md.
struct LightAtPixel {
  LightFate fate = LightFate::adds;
  float d = 0;                  ///< distance of a point or spot light, scene units
  std::array<float, 3> term{};  ///< R, G, B; 0 where it is out of reach
};

/// Whether the light's table leaves the surface to it: it has no place, or the squared distance is below its cut.
/// Sets `d`.
bool in_reach(const LightRow& light, const SurfacePlanes& surface, LightAtPixel& at);

/// Of a light that adds nothing, though it is in reach.
LightFate fate_without_light(const Light& light, const SurfacePlanes& surface);

/// The measure by which lights are ordered: |R| + |G| + |B| of the light's term, or infinity where this sum is NaN.
float strength(const LightAtPixel& light);

/// Whether the light's extent leaves the pixel in its draw.
bool inside_extent(const LightRow& light, const SurfacePlanes& surface);

}  // namespace trueshade
