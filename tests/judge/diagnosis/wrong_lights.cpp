#include "tests/judge/diagnosis/wrong_lights.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/half.h"
#include "tests/judge/diagnosis/view_rows.h"

namespace trueshade::testing {

namespace {

using V = glm::vec3;

float dot3(const V& a, const V& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

struct Lighter {
  const Scene& scene;
  const Pipeline& pipeline;
  LightSlip slip;
  int amount;

  float root(float x) const {
    if (!(x > 0)) return 0;
    if (slip == LightSlip::quake_root) {
      const float y = std::bit_cast<float>(0x5f3759dfu - (std::bit_cast<uint32_t>(x) >> 1));
      return y * (1.5f - 0.5f * x * y * y);
    }
    const float y = 1.0f / std::sqrt(x);
    if (slip == LightSlip::short_root) return std::bit_cast<float>(std::bit_cast<uint32_t>(y) & ~0xfffu);
    return y;
  }
  V unit(const V& v) const { return v * root(dot3(v, v)); }

  float falloff(const Light& l, float d) const {
    const bool once = slip == LightSlip::distance_once, squared = slip == LightSlip::distance_squared;
    const float d2 = once ? d : d * d, d1 = squared ? d * d : d;
    switch (pipeline.light_model.falloff) {
      case Falloff::linear_range:
        return std::max(0.0f, 1 - d1 / (squared ? l.range * l.range : l.range));
      case Falloff::quadratic:
        return 1 / (1 + l.attenuation.y * d1 + l.attenuation.z * d2);
      case Falloff::attenuation:
        return 1 / (l.attenuation.x + l.attenuation.y * d1 + l.attenuation.z * d2);
      case Falloff::inverse_square: {
        const float r = d / l.range, w = 1 - r * r * r * r;
        return d < l.range && w > 0 && d > 0 ? w / d2 : 0;
      }
      default:
        return 1;
    }
  }

  V term(const V& p, V n, const V& albedo, const V& ks, float shininess, const Light& l) const {
    const LightModel& m = pipeline.light_model;
    V to_light = -l.direction;
    float strength = 1;
    if (l.type == LightType::ambient) return albedo * l.color;
    if (l.type != LightType::directional) {
      const V offset = l.position - p;
      const float d2 = dot3(offset, offset), r = root(d2);
      to_light = offset * r;
      strength = falloff(l, d2 * r);
    }
    if (slip == LightSlip::normals_of_8_bits)
      for (int k = 0; k < 3; ++k) n[k] = std::round((n[k] * 0.5f + 0.5f) * 255) / 255 * 2 - 1;
    if (slip == LightSlip::normals_in_view) {
      const std::array<V, 3> rows = view_rows(scene.camera);
      n = {dot3(rows[0], n), dot3(rows[1], n), dot3(rows[2], n)};
    }
    if (m.renormalize != (slip == LightSlip::normals_raw)) n = unit(n);
    const float nl = dot3(n, to_light);
    float diffuse = std::max(0.0f, nl);
    if (slip == LightSlip::two_sided) diffuse = std::fabs(nl);
    float s = 0;
    if (m.specular != Specular::none && !(m.specular_masked != (slip == LightSlip::highlight_mask) && nl <= 0)) {
      const V v = unit(scene.camera.eye - p);
      V h = to_light + v;
      if (slip == LightSlip::half_without_viewer) h = to_light - v;
      if (slip == LightSlip::half_without_light) h = v - to_light;
      float x = std::max(0.0f, dot3(n, h)) * root(dot3(h, h));
      if (slip == LightSlip::reflection) x = std::max(0.0f, dot3(n * (2 * std::max(nl, 0.0f)) - to_light, v));
      if (m.renormalize) x = std::min(x, 1.0f);
      s = float(std::pow(double(x), double(shininess)));
    }
    return (albedo * diffuse + ks * s) * (l.color * m.damping * strength);
  }
};

float to_half(float x, HalfRound round) { return float_from_half(half_from_float(x, round)); }

float bayer(int x, int y) {
  constexpr int kRank[4][4] = {{0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}};
  return (float(kRank[y % 4][x % 4]) + 0.5f) / 16 - 0.5f;
}

struct Texel {
  std::array<float, 4> v{};  ///< codes, or floats
};

class Target {
 public:
  Target(const Pipeline& pipeline, LightSlip slip) : pipeline_(pipeline), slip_(slip) {
    codes_ = pipeline.target == Format::rgba8;
  }
  float stored(float x, int px, int py) const {
    if (!codes_) return to_half(x, pipeline_.gbuffer.half_round);
    const float steps = std::clamp(x, 0.0f, 1.0f) * 255;
    if (slip_ == LightSlip::truncated_stores) return std::floor(steps);
    if (slip_ == LightSlip::dithered) return std::clamp(std::nearbyint(steps + bayer(px, py)), 0.0f, 255.0f);
    return std::nearbyint(steps);
  }
  float added(float to, float x, int px, int py) const {
    return codes_ ? std::min(255.0f, to + stored(x, px, py)) : to_half(to + x, pipeline_.gbuffer.half_round);
  }
  void write(Image& image, int x, int y, const Texel& t) const {
    for (int k = 0; k < 4; ++k)
      image.set_code(x, y, k, codes_ ? uint32_t(t.v[size_t(k)]) : half_from_float(t.v[size_t(k)], HalfRound::nearest));
  }

 private:
  const Pipeline& pipeline_;
  LightSlip slip_;
  bool codes_;
};

/// Lights that reach the box about a tile's surfaces.
std::vector<std::vector<bool>> tile_lists(const Scene& scene, const oracle::Capture& c, int side) {
  const Image &ids = *c.plane("id.object"), &positions = *c.plane("position");
  const int across = (ids.width + side - 1) / side, down = (ids.height + side - 1) / side;
  std::vector<std::vector<bool>> lists;
  for (int ty = 0; ty < down; ++ty)
    for (int tx = 0; tx < across; ++tx) {
      V low(1e30f), high(-1e30f);
      for (int y = ty * side; y < std::min(ids.height, (ty + 1) * side); ++y)
        for (int x = tx * side; x < std::min(ids.width, (tx + 1) * side); ++x)
          for (int k = 0; k < 3 && ids.code(x, y, 0) != 0; ++k) {
            low[k] = std::min(low[k], float(positions.value(x, y, k)));
            high[k] = std::max(high[k], float(positions.value(x, y, k)));
          }
      std::vector<bool>& list = lists.emplace_back();
      for (const Light& l : scene.lights) {
        float d2 = 0;
        for (int k = 0; k < 3; ++k) {
          const float out = std::max({0.0f, low[k] - l.position[k], l.position[k] - high[k]});
          d2 += out * out;
        }
        list.push_back(l.type == LightType::ambient || l.type == LightType::directional || d2 < l.range * l.range);
      }
    }
  return lists;
}

}  // namespace

Image slipped_picture(const Scene& scene, const Pipeline& pipeline, const oracle::Capture& c, LightSlip slip,
                      int amount) {
  const Lighter lighter{scene, pipeline, slip, amount};
  const Target target(pipeline, slip);
  const Image &ids = *c.plane("id.object"), &positions = *c.plane("position"), &normals = *c.plane("normal"),
              &albedos = *c.plane("albedo"), *specular = c.plane("specular"), *emission = c.plane("emission");
  Image out = c.color;
  const LightModel& m = pipeline.light_model;
  const bool loop = pipeline.strategy == Strategy::deferred_loop;
  constexpr int kSide = 16;
  const int across = (ids.width + kSide - 1) / kSide, down = (ids.height + kSide - 1) / kSide;
  const bool tiled = slip == LightSlip::shifted_tiles || slip == LightSlip::full_lists;
  const auto lists = tiled ? tile_lists(scene, c, kSide) : std::vector<std::vector<bool>>{};
  const auto at = [](const Image& i, int x, int y) {
    return V{float(i.value(x, y, 0)), float(i.value(x, y, 1)), float(i.value(x, y, 2))};
  };
  for (int y = 0; y < ids.height; ++y)
    for (int x = 0; x < ids.width; ++x) {
      if (ids.code(x, y, 0) == 0) continue;
      const V p = at(positions, x, y), n = at(normals, x, y), albedo = at(albedos, x, y);
      const bool own = reads_specular_plane(m);
      const V ks = own && specular != nullptr                    ? at(*specular, x, y)
                   : m.specular_source == SpecularSource::albedo ? albedo
                                                                 : m.specular_color;
      const float shininess = own && specular != nullptr ? float(specular->value(x, y, 3)) : m.shininess;
      const float alpha = m.alpha_from_albedo ? float(albedos.value(x, y, 3)) : 1.0f;
      V sum = m.emission && emission != nullptr ? at(*emission, x, y) : V(0.0f);
      Texel t;
      for (int k = 0; k < 4; ++k) t.v[size_t(k)] = target.stored(k < 3 ? sum[k] : alpha, x, y);
      int reached = 0;
      const int beside = slip == LightSlip::shifted_tiles ? 1 : 0;
      const int tile = y / kSide * across + std::min(x / kSide + beside, across - 1);
      const bool stale = x / kSide == across / 2 && y / kSide == down / 2;
      for (size_t i = 0; i < scene.lights.size(); ++i) {
        const Light& l = scene.lights[i];
        if (!lists.empty() && !lists[size_t(tile)][i]) continue;
        if (slip == LightSlip::full_lists && ++reached > amount) break;
        if (slip == LightSlip::stale_tile && stale && i % 2 == 1) continue;
        const V offset = l.position - p;
        if (slip == LightSlip::most_at_pixel && dot3(offset, offset) < l.range * l.range && ++reached > amount)
          continue;
        const V term = lighter.term(p, n, albedo, ks, shininess, l);
        for (int k = 0; k < 3; ++k) {
          sum[k] += term[k];
          if (slip == LightSlip::half_sums) sum[k] = to_half(sum[k], HalfRound::nearest);
          if (!loop) t.v[size_t(k)] = target.added(t.v[size_t(k)], term[k], x, y);
        }
      }
      if (slip == LightSlip::premultiplied) sum *= alpha;
      for (int k = 0; k < 3 && loop; ++k) t.v[size_t(k)] = target.stored(sum[k], x, y);
      target.write(out, x, y, t);
    }
  return out;
}

}  // namespace trueshade::testing
