#include "shading/output/view_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/image_rows.h"
#include "core/srgb_codes.h"
#include "core/threads/parallel_for.h"
#include "shading/output/derived_planes.h"
#include "shading/output/overlay.h"

namespace trueshade {
namespace {

using Rgb = std::array<uint8_t, 3>;

uint8_t code(double share) { return uint8_t((share > 0.0 ? std::min(share, 1.0) : 0.0) * 255.0 + 0.5); }

/// Calls row(y, values, objects) for every row, bands of them at a time: values of `channels` channels of `shown`, and
/// the plane id.object.
template <typename Row>
void for_each_row(const Image& shown, int channels, const Image& object, int threads, const Row& row) {
  const size_t width = size_t(shown.width);
  parallel_for((shown.height + kRowsOfBand - 1) / kRowsOfBand, threads, [&](int band) {
    std::vector<float> values(width * size_t(channels));
    std::vector<uint32_t> objects(width);
    for (int y = band * kRowsOfBand; y < std::min((band + 1) * kRowsOfBand, shown.height); ++y) {
      if (channels != 0) read_row(shown, y, channels, values.data());
      read_row(object, y, objects.data());
      row(y, values.data(), objects.data());
    }
  });
}

/// A picture of color(the pixel's values of `shown`) where there is a surface.
template <int kChannels, typename Color>
Image picture(const Image& shown, const Image& object, int threads, const Color& color) {
  Image view(object.width, object.height, Format::rgba8);
  for_each_row(shown, kChannels, object, threads, [&](int y, const float* values, const uint32_t* objects) {
    uint8_t* texel = view.texel(0, y);
    const float* known = nullptr;  // values that `rgb` is the colour of: neighbours often have the same
    Rgb rgb{};
    for (int x = 0; x < view.width; ++x, values += kChannels, texel += 4) {
      const bool drawn = objects[x] != 0;
      if (drawn && (known == nullptr || std::memcmp(known, values, kChannels * sizeof(float)) != 0)) {
        rgb = color(values);
        known = values;
      }
      const uint8_t surface[4] = {rgb[0], rgb[1], rgb[2], 255};
      const uint8_t empty[4] = {kEmptyColor[0], kEmptyColor[1], kEmptyColor[2], 255};
      std::memcpy(texel, drawn ? surface : empty, sizeof surface);
    }
  });
  return view;
}

/// Where a value lies between the least and the largest, from 0 to 1.
double share(const Extent& extent, double value) {
  return extent.most > extent.least ? (value - extent.least) / (extent.most - extent.least) : 0.5;
}

/// Extents of the finite values where there is a surface.
template <int kChannels>
std::array<Extent, 3> extents(const Image& plane, const Image& object, int threads) {
  std::vector<std::array<Extent, 3>> of_row(size_t(plane.height));
  for_each_row(plane, kChannels, object, threads, [&](int y, const float* values, const uint32_t* objects) {
    std::array<Extent, 3> row;
    for (int x = 0; x < plane.width; ++x)
      for (size_t c = 0; c < kChannels; ++c) {
        const float value = values[kChannels * size_t(x) + c];
        if (objects[x] != 0 && std::isfinite(value)) row[c].add({value, value});
      }
    of_row[size_t(y)] = row;
  });
  std::array<Extent, 3> all;
  for (const auto& row : of_row)
    for (size_t c = 0; c < kChannels; ++c) all[c].add(row[c]);
  return all;
}

Rgb linear_color(const float* value) {
  return {srgb8_code_of(value[0]), srgb8_code_of(value[1]), srgb8_code_of(value[2])};
}

Image directions(const Image& normal, const Image& object, int threads) {
  if (info(normal.format).number_class == NumberClass::unorm)  // (n + 1) / 2 already
    return picture<3>(normal, object, threads, [](const float* n) { return Rgb{code(n[0]), code(n[1]), code(n[2])}; });
  const auto halved = [](float n) { return code(0.5 * double(n) + 0.5); };
  return picture<3>(normal, object, threads, [&](const float* n) {
    return Rgb{halved(n[0]), halved(n[1]), halved(n[2])};
  });
}

Image places(const Image& position, const Image& object, const std::array<Extent, 3>& extent, int threads) {
  return picture<3>(position, object, threads, [&](const float* p) {
    return Rgb{code(share(extent[0], p[0])), code(share(extent[1], p[1])), code(share(extent[2], p[2]))};
  });
}

Image distances(const Image& distance, const Image& object, const Extent& extent, int threads) {
  return picture<1>(distance, object, threads, [&](const float* z) {
    const uint8_t grey = code(1.0 - 0.875 * share(extent, z[0]));
    return Rgb{grey, grey, grey};
  });
}

/// What is past the last whole number below; a whole number counts as the end of its unit, but 0.
double part(double x) { return x == 0.0 ? 0.0 : x - (std::ceil(x) - 1.0); }

Image texture_places(const Image& uv, const Image& object, int threads) {
  return picture<2>(uv, object, threads, [](const float* place) {
    const double u = part(place[0]), v = part(place[1]);
    const bool odd = std::floor(8.0 * u) - 2.0 * std::floor(4.0 * u) != std::floor(8.0 * v) - 2.0 * std::floor(4.0 * v);
    return Rgb{code(u), code(v), code(odd ? 0.4 : 0.0)};
  });
}

}  // namespace

std::vector<std::string> planes_of_view(ImageView view) {
  switch (view) {
    case ImageView::lit:
      return {};
    case ImageView::light_boxes:
    case ImageView::light_edges:
      return {"albedo", "id.object", "depth"};
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

std::array<Extent, 3> view_extents(ImageView view, int threads, std::span<const NamedImage> planes) {
  const Image& shown = plane_named(planes, planes_of_view(view)[0]);
  const Image& object = plane_named(planes, "id.object");
  return view == ImageView::depth ? extents<1>(shown, object, threads) : extents<3>(shown, object, threads);
}

Image view_image(ImageView view, int threads, std::span<const NamedImage> planes) {
  return view_image(view, threads, planes,
                    shows_extents(view) ? view_extents(view, threads, planes) : std::array<Extent, 3>{});
}

Image view_image(ImageView view, int threads, std::span<const NamedImage> planes,
                 const std::array<Extent, 3>& of_picture) {
  const Image& shown = plane_named(planes, planes_of_view(view)[0]);
  const Image& object = plane_named(planes, "id.object");
  if (view == ImageView::depth) return distances(shown, object, of_picture[0], threads);
  if (view == ImageView::normal) return directions(shown, object, threads);
  if (view == ImageView::position) return places(shown, object, of_picture, threads);
  if (view == ImageView::uv) return texture_places(shown, object, threads);
  return picture<3>(shown, object, threads, linear_color);
}

Image boxes_image(const Scene& boxes, const Image& boxed, int threads, std::span<const NamedImage> planes) {
  Image out = picture<3>(plane_named(planes, "albedo"), plane_named(planes, "id.object"), threads, linear_color);
  std::vector<uint32_t> color(boxes.instances.size() + 1);
  for (uint32_t object = 1; object < color.size(); ++object) {
    const Rgb rgb = linear_color(&overlay_color(boxes, object)[0]);
    const uint8_t texel[4] = {rgb[0], rgb[1], rgb[2], 255};
    std::memcpy(&color[object], texel, 4);
  }
  for_each_row(boxed, 0, boxed, threads, [&](int y, const float*, const uint32_t* objects) {
    uint8_t* texel = out.texel(0, y);
    for (int x = 0; x < out.width; ++x, texel += 4) {  // no branch on where bars are: that cannot be predicted
      uint32_t under;
      std::memcpy(&under, texel, 4);
      const uint32_t box = color[objects[x]], shown = objects[x] != 0 ? box : under;
      std::memcpy(texel, &shown, 4);
    }
  });
  return out;
}

}  // namespace trueshade
