#include "cli/pages/pixel_classes.h"

#include <algorithm>

#include "cli/pages/page.h"

namespace trueshade {
namespace {

using oracle::kPixelClasses;
using oracle::PixelClass;
using oracle::StageVerdict;

/// The colour of a class on the map. Rare classes have bright colours.
constexpr Rgb color_of(PixelClass c) {
  switch (c) {
    case PixelClass::exact:
      return {38, 44, 56};
    case PixelClass::store_2:
      return {66, 92, 140};
    case PixelClass::edge:
      return {255, 180, 84};
    case PixelClass::depth_tie:
      return {86, 208, 255};
    case PixelClass::clip:
      return {181, 132, 255};
    case PixelClass::branch:
      return {120, 220, 120};
    case PixelClass::tex:
      return {90, 160, 160};
    case PixelClass::undefined:
      return {160, 160, 160};
    case PixelClass::violation:
      return {255, 40, 80};
    case PixelClass::left_out:
      return {72, 60, 44};
  }
  return {};  // unreachable: every enumerator returns above
}

constexpr const char* meaning_of(PixelClass c) {
  switch (c) {
    case PixelClass::exact:
      return "The value that the nominal vertices, order and rounding give; of planes of floats, one within the bound.";
    case PixelClass::store_2:
      return "The nominal surface, of which some channel is rounded to the other legal neighbour.";
    case PixelClass::edge:
      return "Another surface than the nominal one, at an edge that may lie on either side of the sample.";
    case PixelClass::depth_tie:
      return "Another surface, whose depth cannot be told from the nominal one's.";
    case PixelClass::clip:
      return "Another surface, at an edge that clipping made.";
    case PixelClass::branch:
      return "A comparison in the shader may go either way here, and went the other way.";
    case PixelClass::tex:
      return "A texture lookup, or the alpha test that it decides, has several legal results.";
    case PixelClass::undefined:
      return "OpenGL gives the value no meaning here, so every value is legal.";
    case PixelClass::violation:
      return "In no legal set: nothing that keeps the promises of the profile stores this value.";
    case PixelClass::left_out:
      return "Not judged: left out by a mask or for what is shown, and in none of the figures.";
  }
  return "";  // unreachable: every enumerator returns above
}

/// Of pixels that become one the worst is shown.
int rank_of(PixelClass c) {
  int rank = 0;
  for (size_t other = 0; other < kPixelClasses; ++other) rank += oracle::worse(c, PixelClass(other)) ? 1 : 0;
  return rank;
}

}  // namespace

std::vector<LayerClass> classes_of(const StageVerdict& stage) {
  std::vector<LayerClass> classes;
  for (size_t i = 0; i < kPixelClasses; ++i) {
    const auto c = PixelClass(i);
    classes.push_back({std::string(text(c)), meaning_of(c), color_of(c), stage.counts[i], rank_of(c)});
  }
  if (stage.left_out > 0)
    classes.push_back({std::string(text(PixelClass::left_out)), meaning_of(PixelClass::left_out),
                       color_of(PixelClass::left_out), stage.left_out, 0});
  return classes;
}

std::string class_key(PixelClass c) {
  const Rgb rgb = color_of(c);
  return "<i class=key style=\"background: rgb(" + std::to_string(rgb[0]) + ' ' + std::to_string(rgb[1]) + ' ' +
         std::to_string(rgb[2]) + ")\"></i>" + std::string(text(c));
}

Image class_picture(const StageVerdict& s) {
  const int side = (std::max({s.width, s.height, 1}) + kLargestFigure - 1) / kLargestFigure;
  Image map((s.width + side - 1) / side, (s.height + side - 1) / side, Format::rgba8);
  std::vector<PixelClass> worst(size_t(map.width) * size_t(map.height), PixelClass::exact);
  for (int y = 0; y < s.height; ++y)
    for (int x = 0; x < s.width; ++x) {
      PixelClass& shown = worst[size_t(y / side) * size_t(map.width) + size_t(x / side)];
      const PixelClass c = s.classes[size_t(y) * size_t(s.width) + size_t(x)];
      if (worse(c, shown)) shown = c;
    }
  const auto paint = [&](int x, int y, PixelClass c) {
    if (x < 0 || y < 0 || x >= map.width || y >= map.height) return;
    const Rgb rgb = color_of(c);
    std::copy(rgb.begin(), rgb.end(), map.texel(x, y));
    map.texel(x, y)[3] = 255;
  };
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) paint(x, y, worst[size_t(y) * size_t(map.width) + size_t(x)]);
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x)
      for (int k = 0; k < 9 && worst[size_t(y) * size_t(map.width) + size_t(x)] == PixelClass::violation; ++k)
        paint(x + k % 3 - 1, y + k / 3 - 1, PixelClass::violation);
  return map;
}

}  // namespace trueshade
