#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec4.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/array.h"

// Textures as OpenGL knows them (GL 4.6 core, chapter 8): texels in levels, and how a lookup reads them.
// docs/arithmetic.md section 13.
namespace trueshade {

/// Storage of a texel, R, G, B, A. srgb8_a8: RGB are sRGB codes (IEC 61966-2-1), decoded before any filter; alpha is
/// linear.
enum class TextureFormat : uint8_t { rgba8, srgb8_a8, rgba16f, rgba32f };

enum class Wrap : uint8_t { repeat, mirrored_repeat, clamp_to_edge, clamp_to_border, mirror_clamp_to_edge };
enum class Filter : uint8_t { nearest, linear };
enum class MipFilter : uint8_t { none, nearest, linear };

inline constexpr std::string_view kTextureFormatNames[] = {"rgba8", "srgb8_a8", "rgba16f", "rgba32f"};
inline constexpr std::string_view kWrapNames[] = {"repeat", "mirrored_repeat", "clamp_to_edge", "clamp_to_border",
                                                  "mirror_clamp_to_edge"};
inline constexpr std::string_view kFilterNames[] = {"nearest", "linear"};
inline constexpr std::string_view kMipFilterNames[] = {"none", "nearest", "linear"};

/// Bytes of one texel.
constexpr int bytes_per_texel(TextureFormat format) {
  return format == TextureFormat::rgba32f ? 16 : format == TextureFormat::rgba16f ? 8 : 4;
}

inline constexpr int kMaxTextureSide = 16384;                     ///< texels
inline constexpr uint64_t kMaxTextureTexels = uint64_t(1) << 28;  ///< of one level
inline constexpr int kMaxTextureLevels = 15;                      ///< floor(log2(16384)) + 1

/// One level: rows without padding, the first at v = 0, each from u = 0 on; channels little-endian.
struct TextureLevel {
  int width = 0, height = 0;
  Array<uint8_t> bytes;  ///< may lie in a cache file (scene_cache/)
};

/// Level k measures max(1, floor(side / 2^k)); a chain may stop early, and lookups then stay in its last level.
struct Texture {
  std::string name;
  TextureFormat format = TextureFormat::srgb8_a8;
  std::vector<TextureLevel> levels;
};

/// State of a lookup. lod = clamp(log2(rho) + lod_bias, lod_min, lod_max); lod <= 0 magnifies.
struct Sampler {
  std::array<Wrap, 2> wrap{Wrap::repeat, Wrap::repeat};  ///< along u, along v
  Filter mag_filter = Filter::linear, min_filter = Filter::linear;
  MipFilter mip_filter = MipFilter::linear;  ///< none: level 0 alone
  float lod_bias = 0.0f;                     ///< in [-16, 16]
  float lod_min = -1000.0f, lod_max = 1000.0f;
  glm::vec4 border{0.0f};  ///< linear RGBA, what clamp_to_border reads outside
  bool operator==(const Sampler&) const = default;
};

/// Whether a lookup may read the border.
constexpr bool reads_border(const Sampler& s) {
  return s.wrap[0] == Wrap::clamp_to_border || s.wrap[1] == Wrap::clamp_to_border;
}

inline constexpr size_t kMaxUvSets = 6;  ///< of a mesh: one for each map of a material (kMaterialMaps)

/// A texture as a material uses it.
struct TextureSlot {
  int32_t texture = -1;  ///< index into Scene::textures; below 0: none
  Sampler sampler;
  uint8_t uv_set = 0;  ///< of the mesh, below kMaxUvSets: where the map is read, see Mesh::uv_set()
  bool used() const { return texture >= 0; }
};

/// The value of a texel as a lookup reads it: unorm as RN(k / 255), sRGB codes decoded and rounded to float once.
std::array<float, 4> texel_value(const Texture& texture, size_t level, int x, int y);

/// Appends a texel stored as `format` keeps it: unorm RNE(255 clamp(x)), sRGB the nearest code, half to nearest even.
void append_texel(TextureFormat format, const std::array<float, 4>& value, Array<uint8_t>& bytes);
/// The same for a vector.
void append_texel(TextureFormat format, const std::array<float, 4>& value, std::vector<uint8_t>& bytes);

/// What codes stand for.
enum class CodeEncoding : uint8_t { linear, srgb };
/// Texels of rgba32f from codes of 16 bits a channel, little-endian: RN(k / 65535), or of sRGB the linear value rounded
/// once (IEC 61966-2-1); alpha is linear. No bit of the codes is lost: no two have the same float.
std::vector<uint8_t> float_texels_of_16_bits(std::span<const uint8_t> codes, CodeEncoding encoding);

/// Whether a texture has levels below its first.
enum class MipChain : uint8_t { none, whole };
/// Bytes of all levels of a texture down to 1x1, of the first alone without `chain`.
uint64_t texture_bytes(int width, int height, TextureFormat format, MipChain chain);

/// Adds the levels below the first down to 1x1, each a box filter of the stored one above it.
void build_mip_chain(Texture& texture);

}  // namespace trueshade
