#include "shading/output/heat_map.h"

#include <algorithm>
#include <cstring>

#include "core/image_rows.h"
#include "core/threads/parallel_for.h"

namespace trueshade {
namespace {

// Sixteen equal steps of L*, each of the largest chroma that sRGB has there along a hue from blue by way of red to
// yellow (in Oklab: B. Ottosson, "A perceptual color space for image processing", 2020).
constexpr int kStops = 17, kSteps = 16;
constexpr uint8_t kStop[kStops][3] = {{2, 8, 39},      {24, 15, 72},   {50, 15, 96},   {80, 10, 114},  {112, 5, 122},
                                      {143, 1, 121},   {173, 4, 114},  {205, 2, 102},  {230, 31, 83},  {247, 64, 59},
                                      {253, 99, 40},   {253, 132, 43}, {254, 158, 52}, {251, 184, 82}, {245, 209, 126},
                                      {242, 231, 173}, {247, 249, 218}};

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
  std::vector<uint32_t> row(size_t(counts.width));
  for (int y = 0; y < counts.height; ++y) {
    read_row(counts, y, row.data());
    for (const uint32_t count : row) most = std::max(most, count);
  }
  uint32_t scale = 1;
  while (scale < most && scale < uint32_t(1) << 31) scale *= 2;
  return scale;
}

Image heat_image(const Image& counts, uint32_t scale, int threads) {
  std::array<std::array<uint8_t, 4>, 257> color;
  for (size_t step = 0; step < color.size(); ++step) {
    const std::array<uint8_t, 3> rgb = heat_color(int(step));
    color[step] = {rgb[0], rgb[1], rgb[2], 255};
  }
  Image out(counts.width, counts.height, Format::rgba8);
  parallel_for((out.height + kRowsOfBand - 1) / kRowsOfBand, threads, [&](int band) {
    std::vector<uint32_t> row(size_t(out.width));
    for (int y = band * kRowsOfBand; y < std::min((band + 1) * kRowsOfBand, out.height); ++y) {
      read_row(counts, y, row.data());
      uint8_t* texel = out.texel(0, y);
      for (const uint32_t count : row) {
        const uint64_t step = uint64_t(256) * count / scale;
        std::memcpy(texel, color[size_t(std::min<uint64_t>(step, 256))].data(), 4);
        texel += 4;
      }
    }
  });
  return out;
}

}  // namespace trueshade
