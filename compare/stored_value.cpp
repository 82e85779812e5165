#include "compare/stored_value.h"

#include <bit>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/half.h"

namespace trueshade::compare {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Floats in the order of their values as whole numbers, one step each; both zeros are 0.
int64_t float_order(uint32_t bits) {
  const auto magnitude = int64_t(bits & 0x7fffffffu);
  return (bits >> 31) != 0 ? -magnitude : magnitude;
}
int64_t half_order(uint32_t float_bits) {
  const uint16_t half = half_from_float(std::bit_cast<float>(float_bits), HalfRound::toward_zero);  // exact
  const auto magnitude = int64_t(half & 0x7fffu);
  return (half >> 15) != 0 ? -magnitude : magnitude;
}

}  // namespace

double linear_of_srgb(double srgb) {
  const double magnitude = std::fabs(srgb);
  const double light = magnitude <= 0.04045 ? magnitude / 12.92 : std::pow((magnitude + 0.055) / 1.055, 2.4);
  return std::copysign(light, srgb);
}

PairReader::PairReader(const ChannelPair& pair, bool decode_reference, bool decode_test)
    : pair_(&pair), decode_reference_(decode_reference), decode_test_(decode_test) {
  const Channel &r = *pair.reference, &t = *pair.test;
  const bool alike = r.kind == t.kind || (r.is_code() && t.is_code());
  same_storage_ = alike && r.bits == t.bits && decode_reference == decode_test;
  to_float_ = (r.kind == ChannelKind::floating) != (t.kind == ChannelKind::floating);
}

double PairReader::value_of(const Channel& channel, size_t pixel, bool decode) const {
  double value = channel.value(pixel);
  if (decode) value = linear_of_srgb(value);
  return to_float_ && channel.kind != ChannelKind::integer ? double(float(value)) : value;
}

double PairReader::steps(uint32_t reference, uint32_t test) const {
  const Channel& channel = *pair_->reference;
  if (channel.kind != ChannelKind::floating) {
    const bool with_sign = channel.kind == ChannelKind::snorm;
    const int64_t r = with_sign ? int64_t(int32_t(reference)) : int64_t(reference),
                  t = with_sign ? int64_t(int32_t(test)) : int64_t(test);
    return double(std::abs(r - t));
  }
  const bool halves = channel.bits == 16;
  return double(std::abs((halves ? half_order(reference) : float_order(reference)) -
                         (halves ? half_order(test) : float_order(test))));
}

NumberPair PairReader::at(size_t pixel) const {
  const Channel &r = *pair_->reference, &t = *pair_->test;
  const uint32_t r_word = r.words[pixel], t_word = t.words[pixel];
  NumberPair n{};
  n.reference = value_of(r, pixel, decode_reference_), n.test = value_of(t, pixel, decode_test_);
  n.reference_finite = std::isfinite(n.reference), n.test_finite = std::isfinite(n.test);
  n.equal = same_storage_ ? r_word == t_word : n.reference == n.test;
  if (!n.reference_finite || !n.test_finite) {
    const bool both_nan = std::isnan(n.reference) && std::isnan(n.test);
    n.difference = n.ulp = both_nan || n.reference == n.test ? 0.0 : kInfinite;
    return n;
  }
  if (!same_storage_) {
    n.difference = std::fabs(n.reference - n.test);
    n.ulp = double(std::abs(float_order(std::bit_cast<uint32_t>(float(n.reference))) -
                            float_order(std::bit_cast<uint32_t>(float(n.test)))));
    return n;
  }
  n.ulp = steps(r_word, t_word);
  if (r.kind == ChannelKind::integer)
    n.difference = n.ulp;
  else if (r.is_code())
    n.difference = n.ulp / double(r.largest_code());  // exactly the fraction that a bound like 2/255 is
  else
    n.difference = std::fabs(n.reference - n.test);
  return n;
}

std::string stored_text(const Channel& channel, size_t pixel, bool decode) {
  char text[96];
  const uint32_t word = channel.words[pixel];
  if (channel.kind == ChannelKind::integer)
    std::snprintf(text, sizeof text, "%u", word);
  else if (channel.kind == ChannelKind::floating)
    std::snprintf(text, sizeof text, "%.9g", channel.value(pixel));
  else if (channel.kind == ChannelKind::snorm)
    std::snprintf(text, sizeof text, "%d (%.6g)", int(int32_t(word)), channel.value(pixel));
  else
    std::snprintf(text, sizeof text, "%u (%.6g)", word, channel.value(pixel));
  if (!decode) return text;
  const std::string stored = text;
  std::snprintf(text, sizeof text, " = light %.9g", linear_of_srgb(channel.value(pixel)));
  return stored + text;
}

std::string storage_text(const Channel& channel) {
  switch (channel.kind) {
    case ChannelKind::floating:
      return channel.bits == 16 ? "half" : channel.bits == 32 ? "float" : "float " + std::to_string(channel.bits);
    case ChannelKind::unorm:
      return "unorm " + std::to_string(channel.bits);
    case ChannelKind::srgb:
      return "sRGB " + std::to_string(channel.bits);
    case ChannelKind::snorm:
      return "snorm " + std::to_string(channel.bits);
    case ChannelKind::integer:
      return "uint " + std::to_string(channel.bits);
  }
  return {};  // unreachable: every enumerator returns above
}

}  // namespace trueshade::compare
