#include "shading/output/post.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/half.h"
#include "core/threads/parallel_for.h"
#include "shading/light/power.h"
#include "shading/output/derived_planes.h"

namespace trueshade {
namespace {

constexpr float kMost = 0x1p60f;

/// NaN and what is below 0 as 0, what is huge as 2^60: so that no quotient below is of infinities.
float tame(float x) { return x > 0.0f ? (x < kMost ? x : kMost) : 0.0f; }

/// Binomial weights C(2r, r + k) / 4^r, k from -r: multiples of 4^-r whose sum is 1 exactly.
std::vector<double> binomial_weights(int radius) {
  std::vector<double> weight(size_t(2 * radius + 1), 0.0);
  weight[0] = 1.0;
  for (int row = 1; row <= 2 * radius; ++row)
    for (int k = row; k > 0; --k) weight[size_t(k)] += weight[size_t(k) - 1];
  for (double& w : weight) w = w / double(uint64_t(1) << (2 * radius));
  return weight;
}

enum class BlurAxis : uint8_t { x, y };

/// One blur along an axis: f64 sums from the left or the top, rounded once. Past the border its last pixel goes on.
Picture blurred(const Picture& from, const std::vector<double>& weight, BlurAxis axis, int threads) {
  Picture to(from.width, from.height);
  const int radius = int(weight.size()) / 2;
  parallel_for(from.height, threads, [&](int y) {
    for (int x = 0; x < from.width; ++x) {
      double sum[3] = {0.0, 0.0, 0.0};
      for (int k = -radius; k <= radius; ++k) {
        const float* tap = axis == BlurAxis::x ? from.at(std::clamp(x + k, 0, from.width - 1), y)
                                   : from.at(x, std::clamp(y + k, 0, from.height - 1));
        for (int c = 0; c < 3; ++c) sum[c] = sum[c] + weight[size_t(k + radius)] * double(tap[c]);
      }
      for (int c = 0; c < 3; ++c) to.at(x, y)[c] = float(sum[c]);
    }
  });
  return to;
}

}  // namespace

Picture picture_of(const Image& image) {
  Picture out(image.width, image.height);
  const int channels = info(image.format).channels;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 4; ++c) out.at(x, y)[c] = c < channels ? float(image.value(x, y, c)) : 1.0f;
  return out;
}

Picture box_average(const Picture& picture, int samples, int threads) {
  Picture out(picture.width / samples, picture.height / samples);
  const float count = float(samples * samples);
  parallel_for(out.height, threads, [&](int y) {
    for (int x = 0; x < out.width; ++x)
      for (int c = 0; c < 4; ++c) {
        float sum = 0.0f;
        for (int j = 0; j < samples; ++j) {
          float row = 0.0f;
          for (int i = 0; i < samples; ++i) row = row + picture.at(samples * x + i, samples * y + j)[c];
          sum = sum + row;
        }
        out.at(x, y)[c] = sum / count;
      }
  });
  return out;
}

void add_bloom(const PostChain::Bloom& bloom, int threads, Picture& picture) {
  Picture light(picture.width, picture.height);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      for (int c = 0; c < 3; ++c) light.at(x, y)[c] = tame(picture.at(x, y)[c] - bloom.threshold);
  const std::vector<double> weight = binomial_weights(bloom.radius);
  for (int pass = 0; pass < bloom.passes; ++pass) {
    light = blurred(light, weight, BlurAxis::x, threads);
    light = blurred(light, weight, BlurAxis::y, threads);
  }
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      for (int c = 0; c < 3; ++c) picture.at(x, y)[c] = picture.at(x, y)[c] + bloom.strength * light.at(x, y)[c];
}

void LogarithmicMean::add_to_rows(const Picture& picture, std::span<double> rows) const {
  for (int y = 0; y < picture.height; ++y) {
    double& row = rows[size_t(y)];
    for (int x = 0; x < picture.width; ++x) {
      const float* p = picture.at(x, y);
      row = row + log2_of(double(offset_) + double(luminance(tame(p[0]), tame(p[1]), tame(p[2]))));
    }
  }
}

void LogarithmicMean::add(std::span<const double> rows) {
  for (const double row : rows) sum_ = sum_ + row;
}

double LogarithmicMean::of(uint64_t pixels) const { return exp2_of(sum_ / double(pixels)); }

double logarithmic_mean(const Picture& picture, float offset) {
  LogarithmicMean mean(offset);
  std::vector<double> rows(size_t(picture.height), 0.0);
  mean.add_to_rows(picture, rows);
  mean.add(rows);
  return mean.of(uint64_t(picture.width) * uint64_t(picture.height));
}

void map_tones(const PostChain& chain, double logarithmic_mean, Picture& picture) {
  const float scale = float(double(chain.key) / logarithmic_mean);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      float* p = picture.at(x, y);
      for (int c = 0; c < 3; ++c) p[c] = tame(p[c]);
      const float l = luminance(p[0], p[1], p[2]), scaled = tame(scale * l);
      float mapped = scaled / (1.0f + scaled);
      if (chain.white > 0.0f) mapped = mapped * (1.0f + scaled / (chain.white * chain.white));
      const float ratio = l > 0.0f ? mapped / l : 0.0f;
      for (int c = 0; c < 3; ++c) p[c] = p[c] * ratio;
    }
}

void map_tones(const PostChain& chain, Picture& picture) {
  map_tones(chain, logarithmic_mean(picture, chain.log_offset), picture);
}

void encode_srgb(int threads, Picture& picture) {
  parallel_for(picture.height, threads, [&](int y) {
    for (int x = 0; x < picture.width; ++x)
      for (int c = 0; c < 3; ++c) {
        const double linear = double(tame(picture.at(x, y)[c]));
        const double code = linear <= 0.0031308 ? 12.92 * linear : 1.055 * power(linear, 1.0 / 2.4) - 0.055;
        picture.at(x, y)[c] = linear >= 1.0 ? 1.0f : float(code);
      }
  });
}

Image stored(const Picture& picture, Format format, HalfRound half_round) {
  Image out(picture.width, picture.height, format);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x)
      for (int c = 0; c < 4; ++c) {
        const float value = picture.at(x, y)[c];
        uint8_t* texel = out.texel(x, y);
        if (format == Format::rgba32f) {
          std::memcpy(texel + 4 * c, &value, 4);
        } else if (format == Format::rgba16f) {
          const uint16_t half = half_from_float(value, half_round);
          std::memcpy(texel + 2 * c, &half, 2);
        } else {
          const float clamped = value > 0.0f ? std::min(value, 1.0f) : 0.0f;
          texel[c] = uint8_t(std::nearbyint(255.0f * clamped));
        }
      }
  return out;
}

}  // namespace trueshade
