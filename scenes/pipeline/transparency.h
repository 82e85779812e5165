#pragma once
#include <cstdint>
#include <string_view>

#include "core/blend_state.h"

namespace trueshade {

struct Pipeline;
struct Scene;

/// When surfaces of transparent materials (Material::transparent) are drawn. Spelled with hyphens outside C++. All but
/// `none`: after every opaque surface, in order of submission, tested against the depths that those left and leaving
/// them as they are.
enum class TransparencyMode : uint8_t {
  none,         ///< with the others, as if they were opaque
  into_albedo,  ///< blended into the G-buffer's colour plane alone, before the lights: what is behind them is lit in
                ///< the mixed colour. Strategies with a G-buffer only; where nothing opaque is there is no surface
  after_lights  ///< blended into the target, each fragment the sum of the lights on it, with the albedo's alpha
};
inline constexpr std::string_view kTransparencyNames[] = {"none", "into-albedo", "after-lights"};

/// Over what is there: colours mixed by alpha, coverage added up.
inline constexpr BlendState kBlendOver{true,
                                       {BlendEquation::add, BlendFactor::src_alpha, BlendFactor::one_minus_src_alpha},
                                       {BlendEquation::add, BlendFactor::one, BlendFactor::one_minus_src_alpha},
                                       {},
                                       {true, true, true, true}};

/// How transparent surfaces are drawn.
struct TransparencyState {
  TransparencyMode mode = TransparencyMode::after_lights;
  BlendState blend = kBlendOver;
  bool operator==(const TransparencyState&) const = default;
};

/// Whether surfaces of the scene are drawn apart from the opaque ones.
bool draws_transparent(const Scene& scene, const Pipeline& pipeline);

}  // namespace trueshade
