#pragma once
#include "core/image.h"
#include "raster/visibility/visibility.h"
#include "scenes/pipeline/pipeline.h"
#include "shading/sum/light_pass.h"

namespace trueshade {

/// Rounds a tile's colours to the target's format (docs/arithmetic.md section 7) and writes them into their place of
/// the image, whose rows run from the top down while the tile's y points up.
void store_target(const ColorTile& color, const TileRect& rect, HalfRound half_round, Image& target);

/// The same for a tile whose pixels are in their stored form, as blend_pixels() leaves them.
void write_stored(const ColorTile& stored, const TileRect& rect, Image& target);

/// Writes one plane of a tile into an AOV image of the same size.
/// Names are planes_to_draw()'s but for light.<i>; pixels without a surface get 0, depth its stored value. Of
/// `overdraw`, color.light_count holds the counts; of `Z`, color.plane[0] the distances.
void store_aov(std::string_view name, const VisibilityTile& visible, const SurfaceTile& surface, const ColorTile& color,
               const TileRect& rect, HalfRound half_round, Image& plane);

/// `specular`: the specular colour that the light model reads of each surface, its own plane, the albedo, or the
/// model's, and as alpha the shininess; `emission`: what the model reads of it, and as alpha the share of ambient light
/// that arrives.
void store_material_plane(std::string_view name, const SurfaceTile& surface, const LightModel& model,
                          const TileRect& rect, HalfRound half_round, Image& plane);

/// The format an AOV of that name has under a pipeline.
Format aov_format(std::string_view name, const GBufferState& planes);

}  // namespace trueshade
