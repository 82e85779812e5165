#include "shading/target.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/target.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cstring>

#include "core/half.h"
#include "raster/store-inl.h"
#include "shading/light_planes.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// RGBA8 codes of a tile, red in the low byte.
void pack_unorm8(const ColorTile& color, int pixels, uint32_t* out) {
  const DF d;
  const DI di;
  for (int i = 0; i < pixels; i += int(hn::Lanes(d))) {
    auto packed = hn::Zero(di);
    for (int c = 3; c >= 0; --c)
      packed = hn::Or(hn::ShiftLeft<8>(packed), hn::ConvertTo(di, unorm8_code(hn::Load(d, color.plane[c] + i))));
    hn::Store(hn::BitCast(DU(), packed), DU(), out + i);
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trueshade {
HWY_EXPORT(pack_unorm8);

namespace {

// Calls write(index in the tile, texel) for every pixel of the tile that the image has.
template <class Write>
void for_each_texel(const TileRect& rect, Image& image, const Write& write) {
  const int width = std::min(rect.size, image.width - rect.x), height = std::min(rect.size, image.height - rect.y);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      write(tile_index(rect.size, x, y), image.texel(rect.x + x, image.height - 1 - (rect.y + y)));
}

void write_channels(const float* value, Format format, HalfRound half_round, uint8_t* texel) {
  const FormatInfo f = info(format);
  for (int c = 0; c < f.channels; ++c) {
    if (f.bytes_per_channel == 4) {
      std::memcpy(texel + 4 * c, value + c, 4);
    } else if (f.bytes_per_channel == 2) {
      const uint16_t half = half_from_float(value[c], half_round);
      std::memcpy(texel + 2 * c, &half, 2);
    } else {
      texel[c] = uint8_t(value[c] * 255.0f + 0.5f);  // a read-back value RN(k / 255) gives k again
    }
  }
}

struct Planes {
  int first, count;
  float fourth;  // where the format has more channels than the plane
};

Planes planes_of(std::string_view name) {
  if (name == "position") return {kPosition, 3, 1.0f};
  if (name == "normal") return {kNormal, 3, 1.0f};
  if (name == "albedo") return {kAlbedo, 4, 0.0f};
  return {kUv, 2, 1.0f};
}

}  // namespace

void store_target(const ColorTile& color, const TileRect& rect, HalfRound half_round, Image& target) {
  if (target.format == Format::rgba8) {
    alignas(64) uint32_t packed[kMaxTilePixels];
    HWY_DYNAMIC_DISPATCH(pack_unorm8)(color, rect.size * rect.size, packed);
    const int width = std::min(rect.size, target.width - rect.x), height = std::min(rect.size, target.height - rect.y);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; x += kBlockSize)
        std::memcpy(target.texel(rect.x + x, target.height - 1 - (rect.y + y)), packed + tile_index(rect.size, x, y),
                    size_t(4 * std::min(kBlockSize, width - x)));
    return;
  }
  for_each_texel(rect, target, [&](int i, uint8_t* texel) {
    const float value[4] = {color.plane[0][i], color.plane[1][i], color.plane[2][i], color.plane[3][i]};
    write_channels(value, target.format, half_round, texel);
  });
}

void store_aov(std::string_view name, const VisibilityTile& visible, const SurfaceTile& surface, const ColorTile& color,
               const TileRect& rect, HalfRound half_round, Image& plane) {
  const uint32_t* integers = name == "id.object"                           ? surface.object
                             : name == "id.material"                       ? surface.material
                             : name == "light.count" || name == "overdraw" ? color.light_count
                                                                           : nullptr;
  if (integers != nullptr || name == "depth") {
    for_each_texel(rect, plane, [&](int i, uint8_t* texel) {
      if (integers == nullptr)
        std::memcpy(texel, visible.depth + i, 4);
      else if (surface.covered[i] != 0 || name == "overdraw")
        std::memcpy(texel, integers + i, 4);
    });
    return;
  }
  const Planes planes = planes_of(name);
  for_each_texel(rect, plane, [&](int i, uint8_t* texel) {
    if (surface.covered[i] == 0) return;
    float value[4] = {0.0f, 0.0f, 0.0f, planes.fourth};
    for (int c = 0; c < planes.count; ++c) value[c] = surface.plane[planes.first + c][i];
    write_channels(value, plane.format, half_round, texel);
  });
}

Format aov_format(std::string_view name, const GBufferState& planes) {
  if (name == "depth") return Format::d32f;
  if (name == "position") return planes.position_from_depth ? Format::rgba32f : planes.position.format;
  if (name == "normal") return planes.normal.format;
  if (name == "albedo") return planes.albedo.format;
  if (name == "uv") return planes.uv.format;
  return light_of_plane(name) ? Format::rgb32f : Format::r32ui;
}

}  // namespace trueshade
#endif  // HWY_ONCE
