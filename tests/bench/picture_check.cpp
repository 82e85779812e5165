// When are two pictures one? Expected values from pictures made by hand.
#include "bench/picture_check.h"

#include <cstring>

#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "tests/catch.hpp"

namespace trueshade {
namespace {

Image codes_image(int width, int height, uint8_t code) {
  Image image(width, height, Format::rgba8);
  std::memset(image.texels.data(), code, image.texels.size());
  return image;
}

Image floats_image(float value) {
  Image image(2, 1, Format::rgba32f);
  for (size_t i = 0; i < image.texels.size(); i += sizeof value) std::memcpy(image.texels.data() + i, &value, 4);
  return image;
}

}  // namespace

TEST_CASE("Pixels are apart where any channel is over so many codes") {
  const Image a = codes_image(7, 5, 100);
  Image b = a;
  CHECK(pixels_apart(a, b, 2) == 0);
  b.texel(3, 2)[1] = 102;
  CHECK(pixels_apart(a, b, 2) == 0);
  CHECK(pixels_apart(a, b, 1) == 1);
  b.texel(3, 2)[1] = 103;
  b.texel(3, 2)[2] = 0;  // the same pixel
  b.texel(6, 4)[3] = 97;
  CHECK(pixels_apart(a, b, 2) == 2);
  CHECK(pixels_apart(b, a, 2) == 2);
}

TEST_CASE("Of float values over 1 a code is 1/255 of the larger") {
  CHECK(pixels_apart(floats_image(100.0f), floats_image(100.7f), 2) == 0);
  CHECK(pixels_apart(floats_image(100.0f), floats_image(101.0f), 2) == 2);
  CHECK(pixels_apart(floats_image(0.5f), floats_image(0.51f), 2) == 2);
}

TEST_CASE("A peer's picture is right, the same, or of another strategy") {
  Scene scene = builtin_scene("city,objects=100,lights=20");
  for (Light& light : scene.lights) light.color *= 0.02f;  // so faint that blending and summing give two pictures
  const PreparedScene prepared(scene);
  Pipeline loop = presets().front().pipeline;
  loop.width = 90, loop.height = 70;
  loop.strategy = Strategy::deferred_loop;
  Pipeline blended = loop;
  blended.strategy = Strategy::deferred_volumes;
  const Image timed = render_frame(prepared, loop).color, per_light = render_frame(prepared, blended).color;
  const PictureCheck same = picture_check(prepared, {}, loop, timed, {timed, loop});
  CHECK(same.right());
  CHECK(same.same());
  CHECK(same.off_ours == 0);
  const PictureCheck other = picture_check(prepared, {}, loop, timed, {per_light, blended});
  CHECK(other.right());
  CHECK(other.off_ours == 0);
  CHECK_FALSE(other.same_rounding);
  CHECK_FALSE(other.same());
  const PictureCheck wrong = picture_check(prepared, {}, loop, timed, {codes_image(90, 70, 200), loop});
  CHECK_FALSE(wrong.right());
  CHECK_FALSE(wrong.same());
  CHECK(wrong.pixels == 90 * 70);
  CHECK(wrong.one_in == 100);
  CHECK(one_pixel_in(builtin_scene("lecture")) == 40);  // it has textures
  PictureCheck edge{Strategy::deferred_loop, true, 2.0, 25, 26, 1000, 40};
  CHECK(edge.right());
  CHECK_FALSE(edge.same_shading());
}

}  // namespace trueshade
