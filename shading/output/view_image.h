#pragma once
#include <array>
#include <span>
#include <string>
#include <vector>

#include "core/image.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"
#include "shading/output/extent.h"

namespace trueshade {

/// Colour of pixels without a surface, sRGB codes.
inline constexpr uint8_t kEmptyColor[3] = {24, 26, 31};

/// Planes that a view is made of, by their `--aov` names; view_image() finds them by name among those it is given.
std::vector<std::string> planes_of_view(ImageView view);

/// Whether the colours of a view depend on the extents of its values: depth and position.
constexpr bool shows_extents(ImageView view) { return view == ImageView::depth || view == ImageView::position; }

/// Of the finite values that a view of shows_extents() shows where there is a surface; of `depth` the first alone.
std::array<Extent, 3> view_extents(ImageView view, int threads, std::span<const NamedImage> planes);

/// Planes in colours to look at: rgba8, sRGB codes, alpha 255. docs/views.md has every formula (f64 of the stored
/// values); equal planes are equal views, on any number of threads. Not for `lit`, heat maps (heat_map.h) and
/// boxes.
Image view_image(ImageView view, int threads, std::span<const NamedImage> planes);

/// The same of a part of a picture whose view_extents() are these; read where shows_extents().
Image view_image(ImageView view, int threads, std::span<const NamedImage> planes,
                 const std::array<Extent, 3>& of_picture);

/// The views light-boxes and light-edges: the scene of what they show, and its overlay().
Image boxes_image(const Scene& boxes, const Image& boxed, int threads, std::span<const NamedImage> planes);

/// Whether a view shows light_boxes() or light_box_edges() among the surfaces.
constexpr bool shows_boxes(ImageView view) { return view == ImageView::light_boxes || view == ImageView::light_edges; }

/// The plane that a view shows as a heat map; empty for other views.
std::string_view heat_plane(ImageView view);

}  // namespace trueshade
