#pragma once
#include <cstdint>
#include <glm/vec3.hpp>

namespace trueshade {

/// f(d), d the distance to a point or spot light, in scene units; 1 for a directional light.
enum class Falloff : uint8_t {
  linear_range,    ///< max(0, 1 - d / range); exactly 0 from d = range on
  quadratic,       ///< 1 / (1 + k1 d + k2 d^2); no cutoff
  none,            ///< 1
  linear,          ///< 1 - d / range: negative beyond it
  attenuation,     ///< 1 / (k0 + k1 d + k2 d^2), at most 1e18; no cutoff. OpenGL 4.6 compatibility, 12.2.1.1
  inverse_square,  ///< max(0, 1 - (d / range)^4) / d^2, at most 1e18; exactly 0 from d = range on. KHR_lights_punctual
};

/// The cone of a spot light, of c = L . -direction; inner = cone_rad, outer = cone_rad + penumbra_rad. Of other
/// lights: 1.
enum class Cone : uint8_t {
  none,              ///< 1: a spot light is a point light
  smooth_cutoff,     ///< smoothstep(cutoff, mix(cutoff, 1, 0.1), c), cutoff = cos(outer)
  smooth_penumbra,   ///< smoothstep(cos(outer), cos(inner), c)
  exponent,          ///< max(c, 0)^spot_exponent where c >= cos(outer), else 0; 1 where outer is pi
  squared_penumbra,  ///< clamp(c * scale + offset, 0, 1)^2, scale = 1 / max(0.001, cos(inner) - cos(outer))
};

enum class Diffuse : uint8_t {
  clamped,    ///< max(N.L, 0): Lambert
  unclamped,  ///< N.L: negative where the surface faces away
};

enum class Specular : uint8_t {
  blinn_phong,  ///< max(N.H, 0)^shininess, H = unit(L + V)
  phong,        ///< clamp(R.V, 0, 1)^shininess, R = 2 clamp(N.L, 0, 1) N - L
  none,
};

/// Where a surface's specular colour and shininess come from. The last two are read from the plane `specular`.
enum class SpecularSource : uint8_t {
  model,               ///< specular_color and shininess of the model, the same everywhere
  albedo,              ///< the albedo, as for the diffuse term; shininess of the model
  material,            ///< Material::specular_color and shininess
  metallic_roughness,  ///< mix(0.04, base colour, metallic) and 2 / max(roughness, 0.04)^4 - 2 as an integer from 1 to
                       ///< 8192; the albedo is the base colour times (1 - metallic). The map multiplies both numbers
};

enum class Viewer : uint8_t {
  local,     ///< V = unit(eye - P)
  infinite,  ///< V = the view's z axis everywhere: OpenGL's (0, 0, 1) in eye space, LIGHT_MODEL_LOCAL_VIEWER false
};

enum class TermOrder : uint8_t {
  factored,      ///< (albedo * N.L + specular) * (colour * strength): fewest multiplications
  separate,      ///< albedo * N.L * colour * strength + colour * specular * strength, as the seed's GLSL is written
  albedo_last,   ///< (N.L + specular) * strength * colour; the albedo multiplies the sum, once
  with_ambient,  ///< (albedo * ambient + (albedo * N.L + specular) * colour) * strength: OpenGL's, with Light::ambient
};

/// What one light adds to a pixel, strength = falloff * cone: L = unit(light - P), and the terms named below; sums and
/// orders are those of docs/arithmetic.md, section 8. An ambient light adds albedo * colour in every model.
struct LightModel {
  bool renormalize = true;      ///< N = unit(stored normal); otherwise N as stored
  bool specular_masked = true;  ///< no specular where N.L <= 0
  float shininess = 32.0f;      ///< >= 0; an integer up to 8192 is powered exactly (binary powering in double)
  glm::vec3 specular_color{0.25f};
  Falloff falloff = Falloff::linear_range;
  TermOrder order = TermOrder::factored;
  bool alpha_from_albedo = false;  ///< target alpha where covered: the albedo's, otherwise 1
  Cone cone = Cone::none;
  Diffuse diffuse = Diffuse::clamped;
  Specular specular = Specular::blinn_phong;
  SpecularSource specular_source = SpecularSource::model;
  Viewer viewer = Viewer::local;
  bool emission = false;           ///< the sum starts from the plane `emission`, of Material::emission and its map
  glm::vec3 global_ambient{0.0f};  ///< and from albedo times this; each in [0, 1e18]
  float damping = 1.0f;            ///< multiplies the colour of every light; in [0, 1e18]
  bool clamp_result = false;       ///< the sum and alpha are clamped to [0, 1] before they are stored
  bool keeps_metals = false;       ///< of metallic_roughness, for light programs alone, and in no file: the plane
                                   ///< `specular` holds metallic, roughness, 0 and 0; the albedo is the base colour
  bool operator==(const LightModel&) const = default;
};

/// Whether surfaces carry their own specular colour and shininess.
constexpr bool reads_specular_plane(const LightModel& model) {
  return model.specular != Specular::none && model.specular_source >= SpecularSource::material;
}

/// Whether the model reads specular colour, specular map and shininess of materials.
constexpr bool takes_gloss(const LightModel& model) {
  return reads_specular_plane(model) && model.specular_source == SpecularSource::material;
}

/// Whether a surface can show its colour whatever the lights: the colour is its emission, and it reflects nothing.
constexpr bool shows_unlit(const LightModel& model) {
  return model.emission && model.order != TermOrder::albedo_last &&
         (model.specular == Specular::none || model.specular_source != SpecularSource::model);
}

/// Whether the albedo is the base colour times (1 - metallic).
constexpr bool maps_metals(const LightModel& model) {
  return model.specular_source == SpecularSource::metallic_roughness;
}

}  // namespace trueshade
