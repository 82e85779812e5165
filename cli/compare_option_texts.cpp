#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>

#include "cli/mask_options.h"
#include "cli/option_texts.h"
#include "cli/option_values.h"
#include "core/error.h"
#include "core/file_ending.h"

namespace trueshade {
namespace {

std::optional<double> decimal(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// A number of at least 0, or a fraction of two of them.
double bound_from_text(const std::string& option, const std::string& text) {
  const size_t slash = text.find('/');
  const auto above = decimal(std::string_view(text).substr(0, slash));
  const auto below =
      slash == std::string::npos ? std::optional(1.0) : decimal(std::string_view(text).substr(slash + 1));
  if (!above || !below || !(*above >= 0.0) || !(*below > 0.0))
    throw usage(option, "'" + text + "' is neither a number of at least 0 nor a fraction",
                "give one, like 0.01 or 2/255");
  return *above / *below;
}

double count_from_text(const std::string& option, const std::string& text) {
  const auto value = decimal(text);
  constexpr double kMost = 1e15;
  if (!value || *value < 0.0 || *value > kMost || *value != std::floor(*value))
    throw usage(option, "'" + text + "' is not a whole number of at least 0", "give one");
  return *value;
}

compare::Exposures exposures_from_text(const std::string& text) {
  constexpr double kFarthest = 64, kMostExposures = 100;
  const size_t first = text.find(','), second = first == std::string::npos ? first : text.find(',', first + 1);
  const auto fail = [&text] {
    return usage("--exposures", "'" + text + "' is not two exposures within 64, the lesser first, and perhaps a count",
                 "give START,STOP[,COUNT], like -1,3.5 or -1,3.5,6");
  };
  if (first == std::string::npos) throw fail();
  const std::string_view whole(text);
  const auto start = decimal(whole.substr(0, first)), stop = decimal(whole.substr(first + 1, second - first - 1));
  if (!start || !stop || !(*start <= *stop) || std::fabs(*start) > kFarthest || std::fabs(*stop) > kFarthest)
    throw fail();
  auto count = std::optional(std::max(2.0, std::ceil(*stop - *start)));
  if (second != std::string::npos) count = decimal(whole.substr(second + 1));
  if (!count || *count < 1 || *count > kMostExposures || *count != std::floor(*count)) throw fail();
  return {*start, *stop, int(*count)};
}

/// `16:0.05`.
compare::Criterion window_from_text(const std::string& text, double delta) {
  const size_t colon = std::min(text.find(':'), text.size());
  const double side = decimal(std::string_view(text).substr(0, colon)).value_or(0),
               share = decimal(std::string_view(text).substr(std::min(colon + 1, text.size()))).value_or(-1);
  const bool is_side = side >= kLeastWindowSide && side <= kMostWindowSide && side == std::floor(side) &&
                       std::has_single_bit(unsigned(side));
  if (!is_side || !(share >= 0 && share <= 1))
    throw usage("--window",
                "'" + text + "' is not SIDE:SHARE, a side of 8, 16, 32, 64 or 128 pixels and a share from 0 to 1",
                "give one, like 16:0.05");
  return {compare::Measure::window_share, share, delta, int(side)};
}

/// `RGB` is R, G and B; with commas, and where there is a dot, they are names.
std::vector<std::string> channels_from_text(const std::string& text) {
  std::vector<std::string> names;
  if (text.find_first_of(",.") == std::string::npos && text.find_first_not_of("RGBAXYZWUV") == std::string::npos)
    for (const char letter : text) names.emplace_back(1, letter);
  else
    for (size_t at = 0; at <= text.size();) {
      const size_t comma = std::min(text.find(',', at), text.size());
      names.push_back(text.substr(at, comma - at));
      at = comma + 1;
    }
  for (const std::string& name : names)
    if (name.empty() || std::count(names.begin(), names.end(), name) > 1)
      throw usage("--channels", name.empty() ? "a name is empty" : "'" + name + "' is named twice",
                  "give letters like RGB, or names with commas between, like R,G,depth.Z");
  if (names.empty()) throw usage("--channels", "it names none", "give letters like RGB");
  return names;
}

void add_criteria(const CompareTexts& texts, compare::CompareRules& rules) {
  using compare::Measure;
  const auto add = [&rules](Measure measure, double bound, double delta = 0.0) {
    rules.criteria.push_back({measure, bound, delta});
  };
  if (texts.difference) add(Measure::largest_difference, bound_from_text("--max-difference", *texts.difference));
  if (texts.ulp) add(Measure::largest_ulp, count_from_text("--max-ulp", *texts.ulp));
  if (texts.delta && !texts.pixels && texts.windows.empty())
    throw usage("--delta", "it is what --pixels and --window let pass",
                "add --pixels COUNT, or give --max-difference instead");
  const double delta = texts.delta ? bound_from_text("--delta", *texts.delta) : 0.0;
  if (texts.pixels) add(Measure::pixels_beyond, count_from_text("--pixels", *texts.pixels), delta);
  for (const std::string& text : texts.windows) rules.criteria.push_back(window_from_text(text, delta));
  if (texts.psnr) add(Measure::psnr, bound_from_text("--psnr", *texts.psnr));
  if (texts.flip) add(Measure::flip_mean, bound_from_text("--flip", *texts.flip));
  if (texts.flip_median) add(Measure::flip_weighted_median, bound_from_text("--flip-median", *texts.flip_median));
}

void set_flip(const CompareTexts& texts, compare::CompareRules& rules) {
  constexpr double kLeastPpd = 1, kMostPpd = 1000;
  using Range = compare::CompareRules::Range;
  if (texts.low && texts.high) throw usage("--hdr", "--ldr and --hdr exclude each other", "give one of them");
  if (texts.low || texts.high) rules.range = texts.low ? Range::low : Range::high;
  if (texts.ppd) {
    const auto ppd = decimal(*texts.ppd);
    if (!ppd || *ppd < kLeastPpd || *ppd > kMostPpd)
      throw usage("--ppd", "'" + *texts.ppd + "' is no number of pixels per degree from 1 to 1000",
                  "give one, like 67");
    rules.flip.pixels_per_degree = *ppd;
  }
  if (texts.mapper) {
    const auto& names = compare::kToneMapperNames;
    const auto found = std::find(names.begin(), names.end(), *texts.mapper);
    if (found == names.end()) throw unknown_name("--tone-mapper", "there is no", *texts.mapper, names);
    rules.flip.tone_mapper = compare::ToneMapper(found - names.begin());
  }
  if (texts.exposures) rules.flip.exposures = exposures_from_text(*texts.exposures);
}

}  // namespace

CompareOptions finished(CompareOptions options, const CompareTexts& texts) {
  add_criteria(texts, options.rules);
  set_flip(texts, options.rules);
  if (texts.color_space) {
    if (*texts.color_space != "srgb" && *texts.color_space != "linear")
      throw unknown_name("--color-space", "there is no", *texts.color_space, kColorSpaceNames);
    options.rules.color_space = *texts.color_space == "srgb" ? ColorSpace::srgb : ColorSpace::linear;
  }
  if (texts.threads) options.rules.threads = integer_in("--threads", *texts.threads, 0, 1024);
  options.mask = mask_rules_of(texts.mask);
  if (texts.channels) options.channels = channels_from_text(*texts.channels);
  if (texts.rows) {
    if (std::find(std::begin(kRowOrders), std::end(kRowOrders), *texts.rows) == std::end(kRowOrders))
      throw unknown_name("--rows", "rows do not run", *texts.rows, kRowOrders);
    options.bottom_up = *texts.rows == "bottom_up";
  }
  if (options.bottom_up && options.accept)
    throw usage("--accept", "the test's file would be the reference, and its rows run the other way",
                "save it from the top down, or leave out one of --rows and --accept");
  options.judges = !texts.no_judge && options.rules.criteria.empty() && options.channels.empty() && !options.bottom_up;
  if (options.reference.empty() || options.test.empty())
    throw usage("compare", "a name is empty", "name two pictures, or two folders");
  if (options.junit && !has_ending(*options.junit, ".xml"))
    throw usage("--junit", "'" + *options.junit + "' does not end like XML", "end the name in .xml");
  for (const std::string& path : options.outputs)
    options.rules.wants_flip = options.rules.wants_flip || has_ending(path, ".png");
  check_named_once("-o", options.outputs);
  return options;
}

}  // namespace trueshade
