#pragma once
// What a light program is given of a surface, a light and the view, by the names of programs/light_interface.glsl.
#include <string_view>

#include "judge/bounds/interval.h"
#include "judge/bounds/shaded_surface.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// How to read one scalar input of a light program from a surface: of "surface.normal.y", the normal and component 1.
struct SurfaceField {
  Interval (*of)(const ShadedSurface& surface, size_t component);
  size_t component;
  /// The scalar at this surface.
  Interval at(const ShadedSurface& surface) const { return of(surface, component); }
};

/// How to read one scalar input of a light program from a light: of "light.color.x", the colour and component 0.
struct LightField {
  Interval (*of)(const Light& light, uint32_t index, size_t component);
  size_t component;
  /// The scalar of this light, whose place in the scene is `index`.
  Interval at(const Light& light, uint32_t index) const { return of(light, index, component); }
};

/// How to read the input of this name, "surface.normal.y". Error(bad_input) for a name that a surface does not give.
SurfaceField surface_field(std::string_view name);
/// How to read the input of this name, "light.color.x". Error(bad_input) for a name that a light does not give.
LightField light_field(std::string_view name);

/// The value of an input that is the same for the whole frame: "view.eye.x", a component of a matrix such as
/// "view.view_projection[2].y", or a parameter. Error(usage) for a parameter without a value. Error(bad_input) for any
/// other name, and for the view's or the projection's matrix alone where the camera gives only their product.
Interval frame_field(std::string_view name, const Scene& scene, const Pipeline& pipeline);

/// The component that an input's name ends with: 0 to 3 for the letter behind the last dot, 0 where the input is a
/// scalar.
size_t component_of(std::string_view name);

}  // namespace trueshade::oracle
