#include "compare/stored_value.h"

#include <cmath>
#include <cstdio>
#include <limits>

namespace trueshade::compare {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Where a finite value lies among the numbers of a storage, in its steps from 0; between two of them a fraction.
/// Floats of 64 bits are read as 32. Of sRGB codes `value` is light where it was decoded.
double position(double value, const Channel& storage, bool is_light) {
  if (storage.kind == ChannelKind::integer) return value;
  if (storage.kind != ChannelKind::floating)
    return double(storage.largest_code()) * (is_light ? srgb_of_linear(value) : value);
  const int mantissa = storage.bits >= 32 ? 23 : storage.bits == 16 ? 10 : storage.bits - 5;
  const int least = storage.bits >= 32 ? -126 : -14;
  const double magnitude = std::fabs(value);
  const int exponent = magnitude == 0.0 ? least : std::max(std::ilogb(magnitude), least);
  return std::copysign(std::ldexp(double(exponent - least), mantissa) + std::ldexp(magnitude, mantissa - exponent),
                       value);
}

/// Of two storages the one whose steps are counted: that of codes, else the one of fewer bits.
bool is_coarser(const Channel& a, const Channel& b) {
  const bool is_float = a.kind == ChannelKind::floating;
  return is_float == (b.kind == ChannelKind::floating) ? a.bits < b.bits : !is_float;
}

}  // namespace

double linear_of_srgb(double srgb) {
  const double magnitude = std::fabs(srgb);
  const double light = magnitude <= 0.04045 ? magnitude / 12.92 : std::pow((magnitude + 0.055) / 1.055, 2.4);
  return std::copysign(light, srgb);
}

double srgb_of_linear(double light) {
  const double magnitude = std::fabs(light);
  const double srgb = magnitude <= 0.0031308 ? 12.92 * magnitude : 1.055 * std::pow(magnitude, 1 / 2.4) - 0.055;
  return std::copysign(srgb, light);
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

double PairReader::steps(size_t pixel, double reference, double test) const {
  const Channel &r = *pair_->reference, &t = *pair_->test;
  if (same_storage_ && r.is_code()) return std::fabs(double(r.words[pixel]) - double(t.words[pixel]));
  if (same_storage_ && r.kind == ChannelKind::snorm)
    return std::fabs(double(int32_t(r.words[pixel])) - double(int32_t(t.words[pixel])));
  const bool is_light = decode_reference_ || decode_test_;
  const Channel& counted = is_coarser(t, r) ? t : r;
  return std::fabs(position(reference, counted, is_light) - position(test, counted, is_light));
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
  n.ulp = steps(pixel, n.reference, n.test);
  if (!same_storage_)
    n.difference = std::fabs(n.reference - n.test);
  else if (r.kind == ChannelKind::integer)
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
