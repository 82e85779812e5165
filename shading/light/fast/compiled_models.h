#pragma once
#include <cstddef>
#include <cstdint>
#include <iterator>

#include "shading/light/light_shape.h"

namespace trueshade {

/// A shape that kernels are compiled for.
struct CompiledModel {
  LightShape shape;
  bool blended;  ///< some preset blends lights of this shape, so the blending kernel is compiled for it too
};

/// Models of the presets. All others run the general kernel, with equal bits (tests/shading/light_models.cpp).
inline constexpr CompiledModel kCompiledModels[] = {
    // Blinn-Phong, shininess 32, a linear window.
    {.shape = {.renormalize = true,
               .specular_masked = true,
               .falloff = Falloff::linear_range,
               .order = TermOrder::factored,
               .cone = Cone::none,
               .diffuse = Diffuse::clamped,
               .specular = Specular::blinn_phong,
               .source = SpecularSource::model,
               .squared = true,
               .power = 16},
     .blended = true},
    // The same with any even shininess.
    {.shape = {.renormalize = true,
               .specular_masked = true,
               .falloff = Falloff::linear_range,
               .order = TermOrder::factored,
               .cone = Cone::none,
               .diffuse = Diffuse::clamped,
               .specular = Specular::blinn_phong,
               .source = SpecularSource::model,
               .squared = true,
               .power = -1},
     .blended = true},
    // Blinn-Phong not masked, 1 / (1 + k1 d + k2 d^2), shininess 32.
    {.shape = {.renormalize = false,
               .specular_masked = false,
               .falloff = Falloff::quadratic,
               .order = TermOrder::separate,
               .cone = Cone::none,
               .diffuse = Diffuse::clamped,
               .specular = Specular::blinn_phong,
               .source = SpecularSource::model,
               .squared = true,
               .power = 16},
     .blended = false},
    // Lambert under spot lights without a distance term.
    {.shape = {.renormalize = true,
               .specular_masked = true,
               .falloff = Falloff::none,
               .order = TermOrder::albedo_last,
               .cone = Cone::smooth_cutoff,
               .diffuse = Diffuse::clamped,
               .specular = Specular::none,
               .source = SpecularSource::model,
               .squared = false,
               .power = -1},
     .blended = false},
    // Lambert with a linear window.
    {.shape = {.renormalize = false,
               .specular_masked = true,
               .falloff = Falloff::linear_range,
               .order = TermOrder::factored,
               .cone = Cone::none,
               .diffuse = Diffuse::clamped,
               .specular = Specular::none,
               .source = SpecularSource::model,
               .squared = false,
               .power = -1},
     .blended = true},
    // Phong under spot lights, shininess 60.
    {.shape = {.renormalize = true,
               .specular_masked = false,
               .falloff = Falloff::none,
               .order = TermOrder::factored,
               .cone = Cone::smooth_penumbra,
               .diffuse = Diffuse::clamped,
               .specular = Specular::phong,
               .source = SpecularSource::albedo,
               .squared = false,
               .power = 60},
     .blended = true},
    // OpenGL's fixed function.
    {.shape = {.renormalize = true,
               .specular_masked = true,
               .falloff = Falloff::attenuation,
               .order = TermOrder::with_ambient,
               .cone = Cone::exponent,
               .diffuse = Diffuse::clamped,
               .specular = Specular::blinn_phong,
               .source = SpecularSource::material,
               .squared = false,
               .power = -1},
     .blended = false},
    // Blinn-Phong of glTF's materials under its punctual lights.
    {.shape = {.renormalize = true,
               .specular_masked = true,
               .falloff = Falloff::inverse_square,
               .order = TermOrder::factored,
               .cone = Cone::squared_penumbra,
               .diffuse = Diffuse::clamped,
               .specular = Specular::blinn_phong,
               .source = SpecularSource::metallic_roughness,
               .squared = false,
               .power = -1},
     .blended = false}};

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
      if (shape == shape_of(model, shape.power >= 0)) {
        kernel(CompiledShape<kIndex>{});
        return true;
      }
    }
    return with_compiled_shape<kFor, kIndex + 1>(model, kernel);
  }
}

}  // namespace trueshade
