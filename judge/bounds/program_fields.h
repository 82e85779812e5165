#pragma once
// What a light program is given of a surface, a light and the view, by the names of programs/light_interface.glsl.
#include <string_view>

#include "judge/bounds/interval.h"
#include "judge/bounds/shaded_surface.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// A scalar of a surface: "surface.normal.y".
struct SurfaceField {
  Interval (*of)(const ShadedSurface& surface, size_t component);
  size_t component;
  /// The field of a surface.
  Interval at(const ShadedSurface& surface) const { return of(surface, component); }
};

/// A scalar of a light: "light.color.x". Its index is its place in the scene.
struct LightField {
  Interval (*of)(const Light& light, uint32_t index, size_t component);
  size_t component;
  /// The field of a light.
  Interval at(const Light& light, uint32_t index) const { return of(light, index, component); }
};

/// The field of a name. Error(bad_input) for a name that nothing gives.
SurfaceField surface_field(std::string_view name);
/// The field of a name. Error(bad_input) for a name that nothing gives.
LightField light_field(std::string_view name);

/// What holds for the whole frame: "view.eye.x", a component of a matrix, "view.view_projection[2].y", or a parameter.
/// Error(usage) for a parameter without a value. Error(bad_input) for other names that nothing gives, and for a name of
/// the view's or the projection's matrix alone where the camera is their product.
Interval frame_field(std::string_view name, const Scene& scene, const Pipeline& pipeline);

/// The component that a name ends with: 0 to 3 for the letter behind the last dot, 0 for a scalar.
size_t component_of(std::string_view name);

}  // namespace trueshade::oracle
