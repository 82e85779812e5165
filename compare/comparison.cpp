#include "compare/comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/threads/parallel_for.h"

namespace trueshade::compare {
namespace {

const char* words_of(ColorSpace space) { return space == ColorSpace::srgb ? "sRGB" : "linear light"; }

bool has_color(const PictureFile& picture) {
  const std::vector<Channel>& channels = picture.parts.front().channels;
  return std::any_of(channels.begin(), channels.end(), is_color);
}

/// Where one picture's colours are sRGB values and the other's are linear light, the former are decoded.
void choose_decoding(const PictureFile& reference, const PictureFile& test, const CompareRules& rules, Comparison& c) {
  if (!has_color(reference) || !has_color(test)) {
    c.colors = "there are none: values are compared as they are stored";
  } else if (rules.color_space) {
    c.colors = std::string("both taken as ") + words_of(*rules.color_space) + ", compared as they are stored";
  } else if (reference.color_space == test.color_space) {
    c.colors = std::string("both ") + words_of(test.color_space) + " (reference: " + reference.color_source +
               "; test: " + test.color_source + "), compared as they are stored";
  } else {
    c.decoding.reference = reference.color_space == ColorSpace::srgb;
    c.decoding.test = !c.decoding.reference;
    c.colors = std::string("the ") + (c.decoding.reference ? "reference" : "test") +
               " is sRGB and was decoded, as the other is linear light (reference: " + reference.color_source +
               "; test: " + test.color_source + ")";
  }
}

PixelValues values_at(const Comparison& c, Place place) {
  const PartPair& part = c.pairing.parts[place.part];
  PixelValues pixel{part.name, place.x, place.y, {}};
  const size_t at = size_t(place.y) * size_t(part.width) + size_t(place.x);
  for (const ChannelPair& pair : part.channels) {
    const bool color = is_color(*pair.reference) && is_color(*pair.test);
    const bool decode_reference = c.decoding.reference && color, decode_test = c.decoding.test && color;
    pixel.values.push_back({pair.name, stored_text(*pair.reference, at, decode_reference),
                            stored_text(*pair.test, at, decode_test),
                            PairReader(pair, decode_reference, decode_test).at(at)});
  }
  return pixel;
}

bool holds_floats(const ChannelFile& part) {
  return std::any_of(part.channels.begin(), part.channels.end(),
                     [](const Channel& channel) { return is_color(channel) && channel.kind == ChannelKind::floating; });
}

/// FLIP has no error for a color that is not finite. A pixel that has one, and that differs between the pictures,
/// counts as the largest error.
void count_not_finite(const Pairing& pairing, const PixelMask& mask, FlipResult& result) {
  bool any = false;
  for (const ChannelPair& pair : pairing.parts.empty() ? std::vector<ChannelPair>{} : pairing.parts.front().channels) {
    if (!is_color(*pair.reference) || pair.reference->words.size() != result.map.size()) continue;
    for (size_t i = 0; i < result.map.size(); ++i) {
      if (mask.has(i)) continue;
      const double a = pair.reference->value(i), b = pair.test->value(i);
      const bool same = a == b || (std::isnan(a) && std::isnan(b));
      if (!same && !(std::isfinite(a) && std::isfinite(b))) result.map[i] = 1.0f, any = true;
    }
  }
  if (any) measure(result, &mask);
}

void blacken(const PixelMask& mask, LinearPicture& picture) {
  for (std::vector<float>& plane : picture.rgb)
    for (size_t i = 0; i < mask.left_out.size(); ++i)
      if (mask.has(i)) plane[i] = 0.0f;
}

void measure_flip(const PictureFile& reference, const PictureFile& test, const CompareRules& rules, Comparison& c) {
  const ChannelFile &r = reference.parts.front(), &t = test.parts.front();
  if (r.width != t.width || r.height != t.height) {
    c.no_flip = "the sizes differ";
    return;
  }
  const auto is_srgb = [&rules](const PictureFile& picture) {
    return rules.color_space.value_or(picture.color_space) == ColorSpace::srgb;
  };
  auto of_r = linear_picture(r, is_srgb(reference)), of_t = linear_picture(t, is_srgb(test));
  if (!of_r || !of_t) {
    c.no_flip = "a picture has no channels R, G and B";
    return;
  }
  blacken(rules.mask, *of_r), blacken(rules.mask, *of_t);
  const bool light = holds_floats(r) && holds_floats(t) && !is_srgb(reference) && !is_srgb(test);
  const bool high = rules.range == CompareRules::Range::by_storage ? light : rules.range == CompareRules::Range::high;
  FlipOptions options = rules.flip;
  options.threads = rules.threads, options.mask = &rules.mask;
  FlipResult result = high ? hdr_flip(*of_r, *of_t, options) : flip(*of_r, *of_t, options);
  if (result.map.empty())
    c.no_flip = "the reference is black, so there is no exposure to see it at";
  else
    count_not_finite(c.pairing, rules.mask, result), c.flip = std::move(result);
}

double measured(const Criterion& criterion, const Comparison& c) {
  const Differences& d = c.differences;
  double worst = criterion.measure == Measure::psnr ? std::numeric_limits<double>::infinity() : 0.0;
  switch (criterion.measure) {
    case Measure::unequal_pixels:
      return double(d.unequal_pixels);
    case Measure::pixels_beyond:
      return double(d.pixels_beyond);
    case Measure::window_share:
      for (const WorstWindow& w : d.windows)
        if (w.window.side == criterion.side) worst = w.share;
      return worst;
    case Measure::largest_difference:
      for (const ChannelDifferences& channel : d.channels) worst = std::max(worst, channel.largest);
      return worst;
    case Measure::largest_ulp:
      for (const ChannelDifferences& channel : d.channels) worst = std::max(worst, channel.largest_ulp);
      return worst;
    case Measure::psnr:
      for (const ChannelDifferences& channel : d.channels) {
        if (std::isnan(channel.psnr())) return channel.psnr();
        worst = std::min(worst, channel.psnr());
      }
      return worst;
    case Measure::flip_mean:
      return c.flip ? c.flip->mean : std::numeric_limits<double>::quiet_NaN();
    case Measure::flip_weighted_median:
      return c.flip ? c.flip->weighted_median : std::numeric_limits<double>::quiet_NaN();
  }
  return 0.0;  // unreachable: every enumerator returns above
}

/// Rows to judge by. FLIP sees R, G and B alone, so where nothing else is asked the other channels have to be equal.
void judge(const CompareRules& rules, Comparison& c) {
  std::vector<Criterion> criteria = rules.criteria;
  if (criteria.empty()) criteria.push_back({});
  const bool flip_alone =
      std::all_of(criteria.begin(), criteria.end(), [](const Criterion& row) { return is_flip(row.measure); });
  for (const Criterion& criterion : criteria) {
    c.criteria.push_back(judged(criterion, measured(criterion, c)));
    if (c.criteria.back().holds) continue;
    const bool unmeasured = is_flip(criterion.measure) && !c.flip;
    c.failures.push_back(unmeasured ? "FLIP cannot be measured: " + c.no_flip : text_of(c.criteria.back()));
  }
  if (flip_alone && c.differences.unequal_other_pixels > 0)
    c.failures.push_back("channels that FLIP does not see differ in " +
                         std::to_string(c.differences.unequal_other_pixels) +
                         " pixels, and no other criterion is given for them");
}

void check_finite(const CompareRules& rules, Comparison& c) {
  const Differences& d = c.differences;
  if (d.apart_pixels > 0)
    c.failures.push_back(std::to_string(d.apart_pixels) + (d.apart_pixels == 1 ? " pixel has" : " pixels have") +
                         " an infinity or NaN that is another value in the other picture");
  else if (d.not_finite_pixels > 0 && !rules.allow_not_finite)
    c.failures.push_back(std::to_string(d.not_finite_pixels) +
                         (d.not_finite_pixels == 1 ? " pixel has" : " pixels have") +
                         " an infinity or NaN, the same in both pictures (--allow-nonfinite lets it pass)");
}

double delta_of(const CompareRules& rules) {
  for (const Criterion& criterion : rules.criteria)
    if (has_delta(criterion.measure)) return criterion.delta;
  return 0.0;
}

/// Those that are told, and those that a criterion is of.
std::vector<int> window_sides(const CompareRules& rules) {
  std::vector<int> sides(kWindowSides.begin(), kWindowSides.end());
  for (const Criterion& criterion : rules.criteria)
    if (criterion.measure == Measure::window_share &&
        std::find(sides.begin(), sides.end(), criterion.side) == sides.end())
      sides.push_back(criterion.side);
  std::sort(sides.begin(), sides.end());
  return sides;
}

/// Floats of 64 bits are read as 32; what that loses is told, and is a failure where equality is asked for. Returns
/// whether something was lost.
bool add_rounded(const PictureFile& picture, const char* which, const CompareRules& rules, Comparison& c) {
  for (const ChannelFile& part : picture.parts)
    for (const Channel& channel : part.channels)
      if (channel.is_rounded) {
        const std::string rounded =
            std::string("the ") + which + " has floats of 64 bits that no float of 32 bits holds";
        if (rules.criteria.empty() || rules.allow_not_finite)
          c.failures.push_back(rounded + ", so that equality cannot be told: convert them, or give a criterion");
        else
          c.notes.push_back(rounded + "; they were rounded to 32 before they were compared");
        return true;
      }
  return false;
}

float light_of(double value, bool decode) {
  return !std::isfinite(value) ? 0.0f : float(decode ? linear_of_srgb(value) : value);
}

/// The light of each code of a channel, where these are few.
std::vector<float> light_of_codes(const Channel& channel, bool decode) {
  constexpr int kMostBits = 16;
  std::vector<float> light;
  if (!channel.is_code() || channel.bits > kMostBits) return light;
  for (uint32_t code = 0; code <= channel.largest_code(); ++code)
    light.push_back(light_of(double(code) / channel.largest_code(), decode));
  return light;
}

}  // namespace

std::optional<LinearPicture> linear_picture(const ChannelFile& part, bool decode) {
  const Channel* channels[3] = {};
  for (const Channel& channel : part.channels) {
    const size_t c = std::string_view("RGB").find(channel.name);
    if (channel.name.size() == 1 && c != std::string_view::npos) channels[c] = &channel;
    if (channel.name == "Y" && channels[0] == nullptr) channels[0] = channels[1] = channels[2] = &channel;
  }
  // A grey picture of a format without names has R alone.
  if (part.channels.size() == 1 && channels[0] != nullptr) channels[1] = channels[2] = channels[0];
  if (channels[0] == nullptr || channels[1] == nullptr || channels[2] == nullptr) return std::nullopt;
  LinearPicture picture{part.width, part.height, {}};
  for (std::vector<float>& plane : picture.rgb) plane.resize(size_t(part.width) * size_t(part.height));
  const std::vector<float> light = light_of_codes(*channels[0], decode);
  parallel_for(part.height, 0, [&](int y) {
    for (size_t c = 0; c < 3; ++c)
      for (size_t i = size_t(y) * size_t(part.width), end = i + size_t(part.width); i < end; ++i) {
        const bool listed =
            channels[c]->is_code() && channels[c]->words[i] < light.size() && channels[c]->bits == channels[0]->bits;
        picture.rgb[c][i] = listed ? light[channels[c]->words[i]] : light_of(channels[c]->value(i), decode);
      }
  });
  return picture;
}

Comparison compared(const PictureFile& reference, const PictureFile& test, const CompareRules& rules) {
  Comparison c;
  c.pairing = paired(reference, test);
  choose_decoding(reference, test, rules, c);
  c.differences =
      differences(c.pairing, c.decoding, {delta_of(rules), rules.threads, window_sides(rules), &rules.mask});
  const Differences& d = c.differences;
  if (d.first) c.first = values_at(c, *d.first);
  if (d.worst) c.worst = values_at(c, *d.worst);
  if (d.first_not_finite) c.first_not_finite = values_at(c, *d.first_not_finite);
  const bool wants_flip = rules.wants_flip || std::any_of(rules.criteria.begin(), rules.criteria.end(),
                                                          [](const Criterion& row) { return is_flip(row.measure); });
  if (wants_flip) measure_flip(reference, test, rules, c);
  c.failures = c.pairing.mismatches;
  const bool rounds_reference = add_rounded(reference, "reference", rules, c);
  const bool is_rounded = add_rounded(test, "test", rules, c) || rounds_reference;
  check_finite(rules, c);
  judge(rules, c);
  c.outcome = !c.pairing.mismatches.empty()        ? Outcome::mismatched
              : !c.failures.empty()                ? Outcome::different
              : d.unequal_pixels > 0 || is_rounded ? Outcome::within
                                                   : Outcome::same;
  return c;
}

}  // namespace trueshade::compare
