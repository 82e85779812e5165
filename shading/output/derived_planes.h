#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/image.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade {

/// Side of the squares of pixels that `light.tile` counts in, from the window's lower left corner.
inline constexpr int kLightTile = 16;

/// The planes that must be drawn so that those asked for can be handed out or derived, each once: first those asked
/// for, in order, without the derived ones.
std::vector<std::string> planes_to_draw(std::span<const std::string> asked);

/// A plane made of other planes of the same frame, drawn as planes_to_draw() says. docs/views.md:
///   light.tile       lights that may reach the surfaces in the pixel's square of kLightTile pixels
///   light.intensity  luminance of the target
///   light.boxes      albedo with the lights' boxes among the surfaces, tested for depth; alpha: 1 where a box is seen
///   light.edges      the same with the boxes' edges
/// `name` is one of these. Needs FpScope.
Image derived_plane(std::string_view name, const Scene& scene, const Pipeline& pipeline, const Execution& execution,
                    const Image& target, std::span<const NamedImage> drawn);

/// Whether lights must be drawn for this plane, asked for or derived; others do not depend on what they add.
bool shows_light(std::string_view plane);

/// The plane of that name, which must be there.
const Image& plane_named(std::span<const NamedImage> planes, std::string_view name);

/// Luminance of linear Rec. 709 colour, f32: (0.2126 R + 0.7152 G) + 0.0722 B.
constexpr float luminance(float r, float g, float b) { return (0.2126f * r + 0.7152f * g) + 0.0722f * b; }

}  // namespace trueshade
