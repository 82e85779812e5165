#pragma once
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "gl/driver/context.h"
#include "scenes/light.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// A vertex to be lit. The eye is at the origin and looks along -z.
struct LitPoint {
  glm::vec3 position, normal;
  glm::vec4 albedo;   ///< the material's ambient and diffuse
  Material material;  ///< its specular colour, shininess (up to 128) and emission
};

/// The colours that OpenGL's own lighting (glLight, glMaterial; compatibility profile, 12.2.1) gives the points, each
/// drawn into one pixel of RGBA32F. GL_NORMALIZE is on, everything else as a new context has it. Nothing where the
/// driver has no compatibility profile.
///   lights: at most 8, point, spot or directional, spot exponents up to 128, a cutoff up to 90 degrees or 180
std::optional<std::vector<std::array<float, 4>>> fixed_function_colors(const GlContext& context,
                                                                       std::span<const LitPoint> points,
                                                                       std::span<const Light> lights);

}  // namespace trueshade::oracle
