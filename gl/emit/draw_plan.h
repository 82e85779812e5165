#pragma once
#include <optional>
#include <string>
#include <vector>

#include "gl/emit/draw_state.h"
#include "gl/emit/glsl.h"

namespace trueshade::oracle {

/// What a draw is of.
enum class DrawnGeometry : uint8_t {
  scene,     ///< its instances, all or the opaque ones
  glass,     ///< its transparent instances
  quad,      ///< a quad over the image, once
  quads,     ///< one for each light that is drawn as a quad
  meshes,    ///< a mesh in the world for each of the others
  triangle,  ///< one over the image, made by the vertex shader
};

/// Of which lights: how often it is drawn.
enum class DrawnLights : uint8_t { none, all, first, others, each };

/// A kind of draw: the names of its shaders' files (`trueshade glsl`), the geometry that it draws, and its state.
struct PlannedDraw {
  std::string vert, frag;
  DrawnGeometry geometry;
  DrawnLights lights;
  DrawState state;
};

/// The geometry pass, of shaders_of() and planes_of() with those options.
PlannedDraw geometry_draw(const Pipeline& pipeline);
/// Draws into the target, in order; quads and meshes of deferred-volumes take turns by light.
std::vector<PlannedDraw> light_draws(const Pipeline& pipeline, const GlslOptions& options);
/// Transparent surfaces: before the lights into the G-buffer's colour, or after them into the target; nothing where
/// they are drawn with the others.
std::optional<PlannedDraw> glass_draw(const Pipeline& pipeline, const GlslOptions& options);

/// Whether the target is stored in a format that has an alpha where its own has none: the alpha stays 1, which is what
/// blending reads there.
inline bool alpha_stands_in(const Pipeline& pipeline, const GlslOptions& options) {
  return renderable(pipeline.target, options.rgb16f) != pipeline.target;
}

}  // namespace trueshade::oracle
