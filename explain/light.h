#pragma once
#include <array>
#include <string_view>

#include "explain/surface.h"
#include "scenes/pipeline/light_model.h"
#include "shading/light/light_table.h"

namespace trueshade {

/// Why a light adds something to a pixel, or does not.
enum class LightFate : uint8_t {
  adds,
  out_of_reach,  ///< the squared distance is not below the falloff's or the extent's end, or not finite
  faces_away,    ///< N . L is not above 0, and the model adds nothing there
  outside_cone,
  not_drawn,     ///< its geometry does not cover the pixel, or is culled there
  gives_nothing  ///< the light program makes 0 of it
};
inline constexpr size_t kLightFates = 6;
std::string_view text(LightFate fate);

/// What a pixel is lit with beside its lights: what they all read. docs/arithmetic.md section 8.
struct LitPixel {
  std::array<float, 3> position, normal, viewer;  ///< N and V as the model has them
  std::array<float, 4> albedo;
  std::array<float, 3> specular;  ///< ks: of the surface, of the model, or the albedo
  float shininess;
  float occlusion;
  std::array<float, 3> start;  ///< what the sum starts from
  float alpha;                 ///< before the target rounds it
};
LitPixel lit_pixel(const LightModel& model, const LightTable& lights, const SurfacePlanes& surface);

/// One light's term with the numbers on its way, named as in section 8. What the light's fate leaves out is 0.
struct LightAtPixel {
  LightFate fate = LightFate::adds;
  std::array<float, 3> D{}, L{};
  float d2 = 0, d = 0, r = 0, a = 0, nl = 0;
  float f = 1;              ///< falloff
  float cosine = 0, g = 1;  ///< to the cone's axis, and the cone; where there is one
  float c = 0;              ///< diffuse
  float x = 0, s = 0;       ///< what is raised to the shininess, and the power
  std::array<float, 3> term{};
};
LightAtPixel light_at(const LightModel& model, const LightRow& light, const LitPixel& pixel);

/// The measure by which lights are ordered: |R| + |G| + |B| of the light's term, or infinity where this sum is NaN.
float strength(const LightAtPixel& light);

/// A sum of terms, or one term that is drawn by itself, as the target receives it: albedo and clamp applied.
std::array<float, 4> received(const LightModel& model, const LitPixel& pixel, const std::array<float, 3>& sum);

/// Whether the light's extent leaves the pixel in its draw.
bool inside_extent(const LightRow& light, const LitPixel& pixel);

}  // namespace trueshade
