#include "shading/target.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/target.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "core/half.h"
#include "core/small_float.h"
#include "raster/store-inl.h"
#include "shading/light_planes.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Codes of `count` channels of a tile from `first` on, the first in the lowest bits. `color` holds them already, or
/// values to encode.
void pack_codes(const ColorTile& color, bool encode, int pixels, Format format, int first, int count, uint32_t* out) {
  const DF d;
  const DI di;
  const FormatInfo layout = info(format);
  for (int i = 0; i < pixels; i += int(hn::Lanes(d))) {
    auto packed = hn::Zero(di);
    for (int c = first + count - 1; c >= first; --c) {
      const VF value = hn::Load(d, color.plane[c] + i);
      const VF code = encode ? encoded(value, format, c, HalfRound::toward_zero) : value;
      packed = hn::Or(hn::ShiftLeftSame(packed, layout.bits[size_t(c)]), hn::ConvertTo(di, code));
    }
    hn::Store(hn::BitCast(DU(), packed), DU(), out + i);
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trueshade {
HWY_EXPORT(pack_codes);

namespace {

// Calls write(index in the tile, texel) for every pixel of the tile that the image has.
template <class Write>
void for_each_texel(const TileRect& rect, Image& image, const Write& write) {
  const int width = std::min(rect.size, image.width - rect.x), height = std::min(rect.size, image.height - rect.y);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      write(tile_index(rect.size, x, y), image.texel(rect.x + x, image.height - 1 - (rect.y + y)));
}

uint32_t channel_bits(float value, int bits, bool unorm, HalfRound half_round) {
  if (unorm)
    return uint32_t(value * float((1u << bits) - 1) + 0.5f);  // a read-back value RN(k / largest) gives k again
  if (bits == 32) return std::bit_cast<uint32_t>(value);
  return bits == 16 ? half_from_float(value, half_round) : unsigned_from_float(value, bits, half_round);
}

void write_channels(const float* value, Format format, HalfRound half_round, uint8_t* texel) {
  const FormatInfo f = info(format);
  uint32_t word = 0;
  for (int c = 0, first = 0; c < f.channels; first += f.bits[size_t(c)], ++c) {
    const uint32_t code = channel_bits(value[c], f.bits[size_t(c)], f.number_class == NumberClass::unorm, half_round);
    word |= f.packed() ? code << first : 0;
    if (!f.packed()) std::memcpy(texel + c * f.bytes_per_channel, &code, size_t(f.bytes_per_channel));
  }
  if (f.packed()) std::memcpy(texel, &word, sizeof word);
}

/// Words of a tile, one a texel, into their places `step` bytes apart.
void write_words(const uint32_t* words, int at_byte, int step, const TileRect& rect, Image& target) {
  const int width = std::min(rect.size, target.width - rect.x), height = std::min(rect.size, target.height - rect.y);
  const int whole = step == 4 ? width / kBlockSize * kBlockSize : 0;
  for (int y = 0; y < height; ++y) {
    uint8_t* to = target.texel(rect.x, target.height - 1 - (rect.y + y)) + at_byte;
    const uint32_t* from = words + tile_index(rect.size, 0, y);  // of the row's first block; the next is a block on
    for (int x = 0; x < whole; x += kBlockSize) std::memcpy(to + 4 * x, from + x * kBlockSize, 4 * kBlockSize);
    for (int x = whole; x < width; ++x)
      std::memcpy(to + x * step, from + x / kBlockSize * kBlockPixels + x % kBlockSize, 4);
  }
}

void write_tile(const ColorTile& color, bool encode, const TileRect& rect, HalfRound half_round, Image& target) {
  const FormatInfo layout = info(target.format);
  if (layout.number_class == NumberClass::unorm) {
    alignas(64) uint32_t words[kMaxTilePixels];
    const int channels = layout.bytes_per_channel == 2 ? 2 : 4;  // of a word
    for (int first = 0; first < layout.channels; first += channels) {
      HWY_DYNAMIC_DISPATCH(pack_codes)(color, encode, rect.size * rect.size, target.format, first, channels, words);
      write_words(words, first * layout.bytes_per_channel, layout.bytes_per_texel(), rect, target);
    }
    return;
  }
  for_each_texel(rect, target, [&](int i, uint8_t* texel) {
    const float value[4] = {color.plane[0][i], color.plane[1][i], color.plane[2][i], color.plane[3][i]};
    write_channels(value, target.format, half_round, texel);
  });
}

/// A channel of a plane: values of the tile, or one value where there are none.
struct Channel {
  const float* values;
  float constant;
};

/// Texels of a row of a block, of channels of one kind.
template <int kChannels, typename Code, class Encode>
void encode_channels(const float (&value)[4][kBlockSize], const Encode& encode, uint8_t* texels) {
  Code codes[kBlockSize * kChannels];
  for (int k = 0; k < kBlockSize; ++k)
    for (int c = 0; c < kChannels; ++c) codes[k * kChannels + c] = encode(value[c][k]);
  std::memcpy(texels, codes, sizeof codes);
}

void encode_run(const float (&value)[4][kBlockSize], Format format, HalfRound half_round, uint8_t* texels) {
  const auto half = [half_round](float v) { return half_from_float(v, half_round); };
  switch (format) {
    case Format::rgba32f:
      return encode_channels<4, float>(
          value, [](float v) { return v; }, texels);
    case Format::rgba16f:
      return encode_channels<4, uint16_t>(value, half, texels);
    case Format::rgb16f:
      return encode_channels<3, uint16_t>(value, half, texels);
    case Format::rgba8:
      return encode_channels<4, uint8_t>(
          value, [](float v) { return uint8_t(v * 255.0f + 0.5f); }, texels);
    default:
      for (int k = 0; k < kBlockSize; ++k) {
        const float of_texel[4] = {value[0][k], value[1][k], value[2][k], value[3][k]};
        write_channels(of_texel, format, half_round, texels + k * info(format).bytes_per_texel());
      }
  }
}

/// A plane's part of a tile, rows of blocks at a time; 0 without a surface. `halved`: (v + 1) / 2, of constants too.
void store_channels(const Channel (&channels)[4], bool halved, const SurfaceTile& surface, const TileRect& rect,
                    HalfRound half_round, Image& plane) {
  const int width = std::min(rect.size, plane.width - rect.x), height = std::min(rect.size, plane.height - rect.y);
  const size_t texel = size_t(info(plane.format).bytes_per_texel());
  uint8_t texels[kBlockSize * 4 * sizeof(float)];
  float constant[4][kBlockSize];
  for (int c = 0; c < 4; ++c) std::fill_n(constant[c], kBlockSize, channels[c].constant);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; x += kBlockSize) {
      const int first = tile_index(rect.size, x, y);
      float value[4][kBlockSize];
      for (int c = 0; c < 4; ++c) {
        const float* const from = channels[c].values != nullptr ? channels[c].values + first : constant[c];
        for (int k = 0; k < kBlockSize; ++k) value[c][k] = halved ? from[k] * 0.5f + 0.5f : from[k];
        for (int k = 0; k < kBlockSize; ++k)
          value[c][k] = std::bit_cast<float>(std::bit_cast<int32_t>(value[c][k]) & surface.covered[first + k]);
      }
      encode_run(value, plane.format, half_round, texels);
      std::memcpy(plane.texel(rect.x + x, plane.height - 1 - (rect.y + y)), texels,
                  texel * size_t(std::min(kBlockSize, width - x)));
    }
}

}  // namespace

void store_target(const ColorTile& color, const TileRect& rect, HalfRound half_round, Image& target) {
  write_tile(color, true, rect, half_round, target);
}

void write_stored(const ColorTile& stored, const TileRect& rect, Image& target) {
  write_tile(stored, false, rect, HalfRound::toward_zero, target);
}

void store_aov(std::string_view name, const VisibilityTile& visible, const SurfaceTile& surface, const ColorTile& color,
               const TileRect& rect, HalfRound half_round, Image& plane) {
  const uint32_t* integers = name == "id.object"                           ? surface.object
                             : name == "id.material"                       ? surface.material
                             : name == "light.count" || name == "overdraw" ? color.light_count
                                                                           : nullptr;
  if (integers != nullptr || name == "depth") {
    uint32_t words[kMaxTilePixels];
    for (int i = 0; i < rect.size * rect.size; ++i)
      words[i] = integers == nullptr                             ? std::bit_cast<uint32_t>(visible.depth[i])
                 : surface.covered[i] != 0 || name == "overdraw" ? integers[i]
                                                                 : 0;
    write_words(words, 0, 4, rect, plane);
    return;
  }
  const auto of = [&surface](int first, int c) { return Channel{surface.plane[first + c], 0.0f}; };
  const Channel zero{nullptr, 0.0f}, one{nullptr, 1.0f};
  const auto store = [&](const Channel(&channels)[4], bool halved) {
    store_channels(channels, halved, surface, rect, half_round, plane);
  };
  if (name == "position") return store({of(kPosition, 0), of(kPosition, 1), of(kPosition, 2), one}, false);
  if (name == "albedo") return store({of(kAlbedo, 0), of(kAlbedo, 1), of(kAlbedo, 2), of(kAlbedo, 3)}, false);
  if (name == "uv") return store({of(kUv, 0), of(kUv, 1), zero, one}, false);
  const bool halved = info(plane.format).number_class == NumberClass::unorm;
  store({of(kNormal, 0), of(kNormal, 1), of(kNormal, 2), one}, halved);
}

void store_material_plane(std::string_view name, const SurfaceTile& surface, const LightModel& model,
                          const TileRect& rect, HalfRound half_round, Image& plane) {
  const bool emission = name == "emission", own = reads_specular_plane(model);
  const bool albedo = model.specular_source == SpecularSource::albedo;
  Channel channels[4];
  for (int c = 0; c < 3; ++c)
    channels[c] = emission ? Channel{model.emission ? surface.plane[kEmission + c] : nullptr, 0.0f}
                  : own    ? Channel{surface.plane[kSpecular + c], 0.0f}
                  : albedo ? Channel{surface.plane[kAlbedo + c], 0.0f}
                           : Channel{nullptr, model.specular_color[c]};
  channels[3] = emission ? Channel{nullptr, 1.0f}
                : own    ? Channel{surface.plane[kSpecular + 3], 0.0f}
                         : Channel{nullptr, model.shininess};
  store_channels(channels, false, surface, rect, half_round, plane);
}

Format aov_format(std::string_view name, const GBufferState& planes) {
  if (name == "depth") return Format::d32f;
  if (name == "position") return planes.position_from_depth ? Format::rgba32f : planes.position.format;
  if (name == "normal") return planes.normal.format;
  if (name == "albedo") return planes.albedo.format;
  if (name == "uv") return planes.uv.format;
  if (name == "specular") return planes.specular;
  if (name == "emission") return planes.emission;
  return light_of_plane(name) ? Format::rgb32f : Format::r32ui;
}

}  // namespace trueshade
#endif  // HWY_ONCE
