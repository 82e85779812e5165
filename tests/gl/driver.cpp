#include "tests/gl/driver.h"

#include <cstring>

#include "tests/catch.hpp"

namespace trueshade::testing {

using namespace trueshade::oracle;

namespace {

template <typename Texel>
std::vector<Texel> bottom_first(const Image* image) {
  std::vector<Texel> out;
  if (image == nullptr) return out;
  REQUIRE(size_t(info(image->format).bytes_per_texel()) == sizeof(Texel));
  for (int y = image->height - 1; y >= 0; --y)
    for (int x = 0; x < image->width; ++x) {
      Texel texel;
      std::memcpy(&texel, image->texel(x, y), sizeof texel);
      out.push_back(texel);
    }
  return out;
}

}  // namespace

Planes planes_of_capture(const Capture& capture) {
  Planes planes;
  planes.width = capture.color.width;
  planes.height = capture.color.height;
  planes.object = bottom_first<uint32_t>(capture.plane("id.object"));
  planes.depth = bottom_first<float>(capture.plane("depth"));
  planes.position = bottom_first<std::array<float, 4>>(capture.plane("position"));
  planes.normal = bottom_first<std::array<float, 4>>(capture.plane("normal"));
  planes.albedo = bottom_first<std::array<float, 4>>(capture.plane("albedo"));
  planes.uv = bottom_first<std::array<float, 4>>(capture.plane("uv"));
  return planes;
}

Planes drawn_by_gl(const GlContext& context, const Scene& scene, const Pipeline& pipeline, const GlDraw& draw,
                   int rotation) {
  return planes_of_capture(GlRenderer(context, scene, rotation).draw(pipeline, draw).capture);
}

}  // namespace trueshade::testing
