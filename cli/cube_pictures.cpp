#include "cli/cube_pictures.h"

#include <algorithm>

namespace trueshade {
namespace {

void reverse_rows(Image& image) {
  const size_t row = image.row_bytes();
  for (int above = 0, below = image.height - 1; above < below; ++above, --below)
    std::swap_ranges(image.texel(0, above), image.texel(0, above) + row, image.texel(0, below));
}

/// Where a face is in the cross, in faces from the left and from the top.
struct CrossPlace {
  int column, row;
};
constexpr CrossPlace kPlaces[] = {{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}};

void put_face(const Image& face, CrossPlace place, Image& cross) {
  for (int y = 0; y < face.height; ++y)
    std::copy_n(face.texel(0, y), face.row_bytes(),
                cross.texel(place.column * face.width, place.row * face.height + y));
}

}  // namespace

std::string face_name(const std::string& path, CubeFace face) {
  const size_t dot = path.rfind('.');
  return path.substr(0, dot) + '.' + std::string(kCubeFaceNames[size_t(face)]) + path.substr(dot);
}

void reverse_rows(Frame& frame) {
  reverse_rows(frame.color);
  for (NamedImage& plane : frame.aovs) reverse_rows(plane.image);
}

void put_into_cross(const Frame& face, CubeFace which, Frame& cross) {
  const auto empty = [](const Image& image) { return Image(4 * image.width, 3 * image.height, image.format); };
  if (cross.color.texels.empty()) {
    cross.color = empty(face.color);
    for (const NamedImage& plane : face.aovs) cross.aovs.push_back({plane.name, empty(plane.image)});
  }
  const CrossPlace place = kPlaces[size_t(which)];
  put_face(face.color, place, cross.color);
  for (size_t plane = 0; plane < cross.aovs.size(); ++plane)
    put_face(face.aovs[plane].image, place, cross.aovs[plane].image);
}

}  // namespace trueshade
