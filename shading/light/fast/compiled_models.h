#pragma once
#include <cstddef>
#include <cstdint>
#include <iterator>

#include "shading/light/light_shape.h"

namespace trueshade {

/// Blinn-Phong with shininess 32 and a linear window.
inline constexpr LightShape kWindowBlinn = {.specular = Specular::blinn_phong, .squared = true, .power = 16};
/// Blinn-Phong not masked, 1 / (1 + k1 d + k2 d^2), shininess 32.
inline constexpr LightShape kQuadraticBlinn = {.renormalize = false,
                                               .specular_masked = false,
                                               .falloff = Falloff::quadratic,
                                               .order = TermOrder::separate,
                                               .specular = Specular::blinn_phong,
                                               .squared = true,
                                               .power = 16};
/// Lambert with a linear window.
inline constexpr LightShape kWindowLambert = {.renormalize = false};
/// Lambert under spot lights without a distance term.
inline constexpr LightShape kSpotLambert = {
    .falloff = Falloff::none, .order = TermOrder::albedo_last, .cone = Cone::smooth_cutoff};
/// Phong of the albedo's colour under spot lights, shininess 60.
inline constexpr LightShape kSpotPhong = {.specular_masked = false,
                                          .falloff = Falloff::none,
                                          .cone = Cone::smooth_penumbra,
                                          .specular = Specular::phong,
                                          .source = SpecularSource::albedo,
                                          .power = 60};
/// OpenGL's fixed function.
inline constexpr LightShape kFixedFunction = {.falloff = Falloff::attenuation,
                                              .order = TermOrder::with_ambient,
                                              .cone = Cone::exponent,
                                              .specular = Specular::blinn_phong,
                                              .source = SpecularSource::material};
/// Blinn-Phong of glTF's materials under its punctual lights.
inline constexpr LightShape kPunctual = {.falloff = Falloff::inverse_square,
                                         .cone = Cone::squared_penumbra,
                                         .specular = Specular::blinn_phong,
                                         .source = SpecularSource::metallic_roughness};

/// A shape that kernels are compiled for.
struct CompiledModel {
  LightShape shape;
  bool blended;  ///< some preset blends lights of this shape, so the blending kernel is compiled for it too
};

/// Models of the presets. All others run the general kernel, with equal bits (tests/shading/light_models.cpp).
inline constexpr CompiledModel kCompiledModels[] = {
    {.shape = kWindowBlinn, .blended = true},  {.shape = kQuadraticBlinn, .blended = false},
    {.shape = kSpotLambert, .blended = false}, {.shape = kWindowLambert, .blended = true},
    {.shape = kSpotPhong, .blended = true},    {.shape = kFixedFunction, .blended = false},
    {.shape = kPunctual, .blended = false},
};

/// A shape as a type, whose branches the compiler folds.
template <size_t kIndex>
struct CompiledShape {
  static constexpr LightShape shape = kCompiledModels[kIndex].shape;
  static constexpr bool compiled = true;
};

/// Which of the models a kernel is compiled for.
enum class CompiledFor : uint8_t { all, blended };

/// Calls kernel(shape) with the shape that is compiled for the model. False where there is none.
template <CompiledFor kFor, size_t kIndex = 0, class Kernel>
bool with_compiled_shape(const LightModel& model, const Kernel& kernel) {
  if constexpr (kIndex == std::size(kCompiledModels)) {
    return false;
  } else {
    if constexpr (kFor == CompiledFor::all || kCompiledModels[kIndex].blended) {
      constexpr LightShape shape = kCompiledModels[kIndex].shape;
      if (shape == (shape.power >= 0 ? shape_with_power(model) : shape_of(model))) {
        kernel(CompiledShape<kIndex>{});
        return true;
      }
    }
    return with_compiled_shape<kFor, kIndex + 1>(model, kernel);
  }
}

}  // namespace trueshade
