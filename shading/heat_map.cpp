#include "shading/heat_map.h"

#include <algorithm>
#include <cstring>

namespace trueshade {
namespace {

// Sixteen equal steps of L*, each of the largest chroma that sRGB has there along a hue from blue by way of red to
// yellow (in Oklab: B. Ottosson, "A perceptual color space for image processing", 2020).
constexpr int kStops = 17, kSteps = 16;
constexpr uint8_t kStop[kStops][3] = {{2, 8, 39},      {24, 15, 72},   {50, 15, 96},   {80, 10, 114},  {112, 5, 122},
                                      {143, 1, 121},   {173, 4, 114},  {205, 2, 102},  {230, 31, 83},  {247, 64, 59},
                                      {253, 99, 40},   {253, 132, 43}, {254, 158, 52}, {251, 184, 82}, {245, 209, 126},
                                      {242, 231, 173}, {247, 249, 218}};

uint32_t count_at(const Image& counts, int x, int y) {
  uint32_t count;
  std::memcpy(&count, counts.texel(x, y), sizeof count);
  return count;
}

}  // namespace

std::array<uint8_t, 3> heat_color(int step) {
  const int stop = std::min(step / kSteps, kStops - 2), past = step - stop * kSteps;
  std::array<uint8_t, 3> rgb;
  for (size_t k = 0; k < 3; ++k)
    rgb[k] = uint8_t((kStop[stop][k] * (kSteps - past) + kStop[stop + 1][k] * past + kSteps / 2) / kSteps);
  return rgb;
}

uint32_t heat_scale(const Image& counts) {
  uint32_t most = 1;
  for (int y = 0; y < counts.height; ++y)
    for (int x = 0; x < counts.width; ++x) most = std::max(most, count_at(counts, x, y));
  uint32_t scale = 1;
  while (scale < most && scale < uint32_t(1) << 31) scale *= 2;
  return scale;
}

Image heat_image(const Image& counts, uint32_t scale) {
  Image out(counts.width, counts.height, Format::rgba8);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      const uint64_t step = uint64_t(256) * count_at(counts, x, y) / scale;
      const std::array<uint8_t, 3> rgb = heat_color(int(std::min<uint64_t>(step, 256)));
      std::copy(rgb.begin(), rgb.end(), out.texel(x, y));
      out.texel(x, y)[3] = 255;
    }
  return out;
}

}  // namespace trueshade
