#include "shading/view_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/srgb.h"
#include "shading/derived_planes.h"

namespace trueshade {
namespace {

using Rgb = std::array<uint8_t, 3>;

uint8_t code(double share) { return uint8_t((share > 0.0 ? std::min(share, 1.0) : 0.0) * 255.0 + 0.5); }

/// A picture of color(x, y) where there is a surface, or the plane `also` has an alpha.
template <typename Color>
Image picture(const Image& object, const Color& color, const Image* also = nullptr) {
  Image view(object.width, object.height, Format::rgba8);
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) {
      const bool shown = object.value(x, y, 0) != 0.0 || (also != nullptr && also->value(x, y, 3) != 0.0);
      const Rgb rgb = shown ? color(x, y) : Rgb{kEmptyColor[0], kEmptyColor[1], kEmptyColor[2]};
      std::copy(rgb.begin(), rgb.end(), view.texel(x, y));
      view.texel(x, y)[3] = 255;
    }
  return view;
}

/// Least and largest finite value of a channel where there is a surface.
struct Extent {
  double least = std::numeric_limits<double>::infinity(), most = -least;

  Extent(const Image& plane, int channel, const Image& object) {
    for (int y = 0; y < plane.height; ++y)
      for (int x = 0; x < plane.width; ++x) {
        const double value = plane.value(x, y, channel);
        if (object.value(x, y, 0) == 0.0 || !std::isfinite(value)) continue;
        least = std::min(least, value);
        most = std::max(most, value);
      }
  }
  double share(double value) const { return most > least ? (value - least) / (most - least) : 0.5; }
};

Image linear_colors(const Image& plane, const Image& object, const Image* also = nullptr) {
  const auto color = [&](int x, int y) {
    Rgb rgb;
    for (int k = 0; k < 3; ++k) rgb[size_t(k)] = srgb8_from_linear(float(plane.value(x, y, k)));
    return rgb;
  };
  return picture(object, color, also);
}

Image directions(const Image& normal, const Image& object) {
  const bool halved = info(normal.format).number_class == NumberClass::unorm;  // (n + 1) / 2 already
  return picture(object, [&](int x, int y) {
    Rgb rgb;
    for (int k = 0; k < 3; ++k) {
      const double value = normal.value(x, y, k);
      rgb[size_t(k)] = code(halved ? value : 0.5 * value + 0.5);
    }
    return rgb;
  });
}

Image places(const Image& position, const Image& object) {
  const Extent extent[3] = {{position, 0, object}, {position, 1, object}, {position, 2, object}};
  return picture(object, [&](int x, int y) {
    Rgb rgb;
    for (int k = 0; k < 3; ++k) rgb[size_t(k)] = code(extent[k].share(position.value(x, y, k)));
    return rgb;
  });
}

Image distances(const Image& distance, const Image& object) {
  const Extent extent(distance, 0, object);
  return picture(object, [&](int x, int y) {
    const uint8_t grey = code(1.0 - 0.875 * extent.share(distance.value(x, y, 0)));
    return Rgb{grey, grey, grey};
  });
}

/// What is past the last whole number below; a whole number counts as the end of its unit, but 0.
double part(double x) { return x == 0.0 ? 0.0 : x - (std::ceil(x) - 1.0); }

Image texture_places(const Image& uv, const Image& object) {
  return picture(object, [&](int x, int y) {
    const double u = uv.value(x, y, 0), v = uv.value(x, y, 1);
    const bool odd = std::floor(8.0 * part(u)) - 2.0 * std::floor(4.0 * part(u)) !=
                     std::floor(8.0 * part(v)) - 2.0 * std::floor(4.0 * part(v));
    return Rgb{code(part(u)), code(part(v)), code(odd ? 0.4 : 0.0)};
  });
}

}  // namespace

std::vector<std::string> planes_of_view(ImageView view) {
  switch (view) {
    case ImageView::lit:
      return {};
    case ImageView::light_boxes:
      return {"light.boxes", "id.object"};
    case ImageView::light_edges:
      return {"light.edges", "id.object"};
    case ImageView::albedo:
      return {"albedo", "id.object"};
    case ImageView::specular:
      return {"specular", "id.object"};
    case ImageView::depth:
      return {"Z", "id.object"};
    case ImageView::normal:
      return {"normal", "id.object"};
    case ImageView::position:
      return {"position", "id.object"};
    case ImageView::uv:
      return {"uv", "id.object"};
    case ImageView::light_count:
    case ImageView::light_tile:
    case ImageView::overdraw:
      return {std::string(heat_plane(view))};
  }
  return {};
}

std::string_view heat_plane(ImageView view) {
  if (view == ImageView::light_count) return "light.count";
  if (view == ImageView::light_tile) return "light.tile";
  if (view == ImageView::overdraw) return "overdraw";
  return "";
}

Image view_image(ImageView view, std::span<const NamedImage> planes) {
  const Image& shown = plane_named(planes, planes_of_view(view)[0]);
  const Image& object = plane_named(planes, "id.object");
  if (view == ImageView::depth) return distances(shown, object);
  if (view == ImageView::normal) return directions(shown, object);
  if (view == ImageView::position) return places(shown, object);
  if (view == ImageView::uv) return texture_places(shown, object);
  const bool boxes = view == ImageView::light_boxes || view == ImageView::light_edges;
  return linear_colors(shown, object, boxes ? &shown : nullptr);
}

}  // namespace trueshade
