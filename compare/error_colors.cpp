#include "compare/error_colors.h"

#include <algorithm>
#include <cmath>

namespace trueshade::compare {

std::array<uint8_t, 3> error_color(float error) {
  constexpr int kColors[][3] = {{0, 0, 4},      {29, 17, 71},   {81, 18, 124},   {131, 38, 129}, {183, 55, 121},
                                {230, 81, 100}, {251, 135, 97}, {254, 194, 135}, {252, 253, 191}};  // eighths
  constexpr int kSteps = int(std::size(kColors)) - 1;
  const float at = std::clamp(error, 0.0f, 1.0f) * float(kSteps);
  const int step = std::min(int(at), kSteps - 1);
  std::array<uint8_t, 3> color{};
  for (size_t c = 0; c < 3; ++c) {
    const auto from = float(kColors[step][c]), to = float(kColors[step + 1][c]);
    color[c] = uint8_t(std::lround(from + (to - from) * (at - float(step))));
  }
  return color;
}

Image error_picture(std::span<const float> map, int width, int height) {
  Image image(width, height, Format::rgba8);
  for (size_t i = 0; i < map.size(); ++i) {
    const std::array<uint8_t, 3> color = error_color(map[i]);
    std::copy(color.begin(), color.end(), image.texels.begin() + std::ptrdiff_t(4 * i));
    image.texels[4 * i + 3] = 255;
  }
  return image;
}

}  // namespace trueshade::compare
