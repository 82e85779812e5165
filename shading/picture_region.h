#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "shading/frame.h"

namespace trueshade {

/// The least part of the picture around `region` that has to be drawn so that the region gets the picture's pixels:
/// whole squares of `light.tile`, and as many pixels around as bloom and the edge filter look away from a pixel.
/// `planes`: those that the frame needs.
PictureRegion region_to_draw(const Pipeline& pipeline, const PictureRegion& region,
                             std::span<const std::string> planes);

/// The part of `from`, an image of the region `drawn`, that shows the region `part` of it.
Image part_of(Image from, const PictureRegion& drawn, const PictureRegion& part);

/// Whether a region's pixels depend on a number that only the whole picture tells: see PictureConstants.
bool has_constants(const Pipeline& pipeline);

/// Draws the whole picture, some rows at a time, and keeps these numbers of it alone. Error as render_frame().
PictureConstants picture_constants(const PreparedScene& scene, const Pipeline& pipeline, const Execution& execution,
                                   const Progress& progress = {});

}  // namespace trueshade
