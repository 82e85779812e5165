#include <algorithm>
#include <cmath>

#include "tests/judge/loose_renderer.h"

namespace trueshade::testing {

namespace {

double encoded(double x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055; }
double decoded(double s) { return s <= 0.04045 ? std::max(s, 0.0) / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); }

/// Linear steps of a lookup: along u and v, between levels.
int steps_of(const Sampler& s, long double lod) {
  if (!(lod > 0)) return s.mag_filter == Filter::linear ? 2 : 0;
  return (s.min_filter == Filter::linear ? 2 : 0) + (s.mip_filter == MipFilter::linear ? 1 : 0);
}

}  // namespace

LooseTextures::LooseTextures(const Scene& scene, const Liberties& liberties)
    : scene_(scene), free_(liberties), encoded_(scene.textures) {
  for (Texture& t : encoded_)
    if (t.format == TextureFormat::srgb8_a8) t.format = TextureFormat::rgba8;
}

std::array<float, 4> LooseTextures::texel(LooseFloat& f, const TextureSlot& slot,
                                          const oracle::TexturePlace& place) const {
  const auto index = size_t(slot.texture);
  const Texture& texture = scene_.textures[index];
  const Sampler& s = slot.sampler;
  long double lod = oracle::level_of_detail(texture, s, place);
  if (free_.any_level) {
    const oracle::LodRange legal = oracle::legal_lod(texture, place);
    const long double chosen = legal.low + (legal.high - legal.low) * f.random().real();
    lod = std::clamp<long double>(chosen + s.lod_bias, s.lod_min, s.lod_max);
  }
  const bool srgb = texture.format == TextureFormat::srgb8_a8, late = srgb && free_.decode_late;
  const oracle::TexelValue exact =
      oracle::filtered(late ? encoded_[index] : texture, s, place.u, place.v, lod, free_.weight_bits);
  const double off = free_.weight_bits > 0 ? 0.95 * steps_of(s, lod) / 255 : 0;  // as if filtered in 8 bits
  std::array<float, 4> out{};
  for (size_t c = 0; c < 4; ++c) {
    auto value = double(exact[c]);
    if (late || texture.format == TextureFormat::rgba8)
      value = std::clamp(value + off * f.random().between(-1, 1), 0.0, 1.0);
    if (srgb && c < 3 &&
        free_.any_neighbour) {  // half a code: OpenGL gives a whole one to each texel, not to their mean
      const double s8 = (late ? value : encoded(value)) + 0.5 / 255 * f.random().between(-1, 1);
      value = decoded(std::min(s8, 1.0));
    } else if (late && c < 3) {
      value = decoded(value);
    }
    out[c] = f.mul(float(value), 1.0f);
  }
  return out;
}

}  // namespace trueshade::testing
