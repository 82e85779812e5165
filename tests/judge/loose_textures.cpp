#include <algorithm>
#include <cmath>

#include "tests/judge/loose_renderer.h"
#include "tests/judge/srgb_in_double.h"

namespace trueshade::testing {

namespace {

/// Linear steps of a lookup: along u and v, between levels.
int steps_of(const Sampler& s, long double lod) {
  if (!(lod > 0)) return s.mag_filter == Filter::linear ? 2 : 0;
  return (s.min_filter == Filter::linear ? 2 : 0) + (s.mip_filter == MipFilter::linear ? 1 : 0);
}

/// Lookups of one way, in floats or in codes of 8 bits.
class OneWay {
 public:
  OneWay(const Texture& texture, const Sampler& sampler, const TextureWay& way, bool in_codes)
      : texture_(texture), sampler_(sampler), way_(way), in_codes_(in_codes && way.step_threshold) {}

  oracle::TexelValue at(double u, double v, double lod) const {
    const double last = double(texture_.levels.size() - 1);
    const bool small = lod > 0, levels = small && sampler_.mip_filter != MipFilter::none;
    const Filter filter = small ? sampler_.min_filter : sampler_.mag_filter;
    if (!levels) return at_level(0, filter, u, v);
    if (sampler_.mip_filter == MipFilter::nearest)
      return at_level(size_t(lod <= 0.5 ? 0 : std::min(std::ceil(lod + 0.5) - 1, last)), filter, u, v);
    const double low = std::min(std::floor(lod), last);
    if (low == last) return at_level(size_t(last), filter, u, v);
    return step(at_level(size_t(low), filter, u, v), at_level(size_t(low) + 1, filter, u, v), weight(lod - low));
  }

 private:
  double weight(double w) const {
    if (way_.weight_bits == 0) return w;
    const double scaled = std::ldexp(w, way_.weight_bits);
    return std::ldexp(way_.cuts_weights ? std::floor(scaled) : std::nearbyint(scaled), -way_.weight_bits);
  }

  oracle::TexelValue step(const oracle::TexelValue& a, const oracle::TexelValue& b, double w) const {
    oracle::TexelValue out;
    for (size_t c = 0; c < 4; ++c) {
      out[c] = a[c] + w * (b[c] - a[c]);
      if (!in_codes_) continue;
      const double code = 255 * double(out[c]), below = std::floor(code + 1e-6);  // a code is itself
      out[c] = (code - below < *way_.step_threshold ? below : below + 1) / 255;
    }
    return out;
  }

  oracle::TexelValue at_level(size_t level, Filter filter, double u, double v) const {
    const TextureLevel& l = texture_.levels[level];
    if (filter == Filter::nearest)
      return oracle::wrapped_texel(texture_, sampler_, level, (long long)(std::floor(u * l.width)),
                                   (long long)(std::floor(v * l.height)));
    const double x = u * l.width - 0.5, y = v * l.height - 0.5;
    const auto i = (long long)(std::floor(x)), j = (long long)(std::floor(y));
    const auto row = [&](long long at) {
      return step(oracle::wrapped_texel(texture_, sampler_, level, i, at),
                  oracle::wrapped_texel(texture_, sampler_, level, i + 1, at), weight(x - double(i)));
    };
    return step(row(j), row(j + 1), weight(y - double(j)));
  }

  const Texture& texture_;
  const Sampler& sampler_;
  const TextureWay& way_;
  const bool in_codes_;
};

/// Between the limits of 8.14.1: by powers of the largest derivative, of equation 8.11's, and of the sum.
double rho_of(const Texture& texture, const oracle::TexturePlace& p, double way) {
  const double w = texture.levels[0].width, h = texture.levels[0].height;
  const double ux = std::fabs(double(p.u_x)) * w, uy = std::fabs(double(p.u_y)) * w, vx = std::fabs(double(p.v_x)) * h,
               vy = std::fabs(double(p.v_y)) * h;
  const double exact = std::max(std::hypot(ux, vx), std::hypot(uy, vy)), least = std::max({ux, uy, vx, vy}),
               most = std::max(ux, uy) + std::max(vx, vy);
  return exact * std::pow((way < 0 ? least : most) / exact, std::fabs(way));
}

/// Mesa 22.3's polynomial for sRGB (gallivm, lp_bld_format_srgb.c).
double mesa_decoded(double s) { return s * 255 <= 15 ? s / 12.6 : 0.0023 + s * (0.0030 + s * (0.6935 + s * 0.3012)); }

}  // namespace

std::array<float, 4> LooseTextures::one_way(LooseFloat& f, const TextureSlot& slot,
                                            const oracle::TexturePlace& place) const {
  const auto index = size_t(slot.texture);
  const Texture& texture = scene_.textures[index];
  const TextureWay& way = *free_.way;
  const Sampler& s = slot.sampler;
  const double lod =
      std::clamp<double>(std::log2(rho_of(texture, place, way.rho)) + way.levels_off + double(s.lod_bias),
                         double(s.lod_min), double(s.lod_max));
  const bool srgb = texture.format == TextureFormat::srgb8_a8, late = srgb && free_.decode_late;
  const Texture& read = late ? encoded_[index] : srgb && way.mesa_decode ? by_mesa_[index] : texture;
  const oracle::TexelValue value =
      OneWay(read, s, way, late || texture.format == TextureFormat::rgba8).at(double(place.u), double(place.v), lod);
  std::array<float, 4> out{};
  for (size_t c = 0; c < 4; ++c) {
    const auto v = double(value[c]);
    out[c] = f.mul(float(!late || c == 3 ? v : way.mesa_decode ? mesa_decoded(v) : srgb_decoded(v)), 1.0f);
  }
  return out;
}

LooseTextures::LooseTextures(const Scene& scene, const Liberties& liberties)
    : scene_(scene), free_(liberties), encoded_(scene.textures) {
  for (Texture& t : encoded_)
    if (t.format == TextureFormat::srgb8_a8) t.format = TextureFormat::rgba8;
  if (free_.way && free_.way->mesa_decode) decode_by_mesa();
}

/// Textures of floats in place of those of sRGB.
void LooseTextures::decode_by_mesa() {
  by_mesa_ = scene_.textures;
  for (Texture& t : by_mesa_) {
    if (t.format != TextureFormat::srgb8_a8) continue;
    t.format = TextureFormat::rgba32f;
    for (TextureLevel& level : t.levels) {
      Array<uint8_t> floats;
      for (size_t k = 0; k < level.bytes.size(); k += 4) {
        std::array<float, 4> texel{};
        for (size_t c = 0; c < 4; ++c) {
          const double code = double(level.bytes[k + c]) / 255;
          texel[c] = float(c < 3 ? mesa_decoded(code) : code);
        }
        append_texel(TextureFormat::rgba32f, texel, floats);
      }
      level.bytes = std::move(floats);
    }
  }
}

std::array<float, 4> LooseTextures::texel(LooseFloat& f, const TextureSlot& slot,
                                          const oracle::TexturePlace& place) const {
  if (free_.way) return one_way(f, slot, place);
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
        free_.any_neighbour) {  // a fifth of a code: each texel may be half a one off, their mean by less
      const double s8 = (late ? value : srgb_encoded(value)) + 0.2 / 255 * f.random().between(-1, 1);
      value = srgb_decoded(std::min(s8, 1.0));
    } else if (late && c < 3) {
      value = srgb_decoded(value);
    }
    out[c] = f.mul(float(value), 1.0f);
  }
  return out;
}

}  // namespace trueshade::testing
