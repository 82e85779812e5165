// The table of the command compare, and what its options say together.
#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>

#include "cli/command_tables.h"
#include "cli/mask_options.h"
#include "cli/option_values.h"
#include "cli/picture_rows.h"
#include "core/error.h"
#include "core/file_ending.h"
#include "scenes/files/content/scene_files.h"

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
compare::Criterion window_from_text(const std::string& text) {
  const size_t colon = std::min(text.find(':'), text.size());
  const double side = decimal(std::string_view(text).substr(0, colon)).value_or(0),
               share = decimal(std::string_view(text).substr(std::min(colon + 1, text.size()))).value_or(-1);
  const bool is_side = side >= kLeastWindowSide && side <= kMostWindowSide && side == std::floor(side) &&
                       std::has_single_bit(unsigned(side));
  if (!is_side || !(share >= 0 && share <= 1))
    throw usage("--window",
                "'" + text + "' is not SIDE:SHARE, a side of 8, 16, 32, 64 or 128 pixels and a share from 0 to 1",
                "give one, like 16:0.05");
  return {compare::Measure::window_share, share, 0.0, int(side), text.substr(colon + 1), {}};
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

double ppd_from_text(const std::string& text) {
  constexpr double kLeastPpd = 1, kMostPpd = 1000;
  const auto ppd = decimal(text);
  if (!ppd || *ppd < kLeastPpd || *ppd > kMostPpd)
    throw usage("--ppd", "'" + text + "' is no number of pixels per degree from 1 to 1000", "give one, like 67");
  return *ppd;
}

compare::ToneMapper mapper_from_text(const std::string& text) {
  const auto& names = compare::kToneMapperNames;
  const auto found = std::find(names.begin(), names.end(), text);
  if (found == names.end()) throw unknown_name("--tone-mapper", "there is no", text, names);
  return compare::ToneMapper(found - names.begin());
}

ColorSpace color_space_from_text(const std::string& text) {
  if (text != "srgb" && text != "linear") throw unknown_name("--color-space", "there is no", text, kColorSpaceNames);
  return text == "srgb" ? ColorSpace::srgb : ColorSpace::linear;
}

bool is_bottom_up(const std::string& text) {
  if (std::find(std::begin(kRowOrders), std::end(kRowOrders), text) == std::end(kRowOrders))
    throw unknown_name("--rows", "rows do not run", text, kRowOrders);
  return text == "bottom_up";
}

void add_criteria(CommandTable& table, CompareOptions& options) {
  using compare::Measure;
  // A row whose value is the bound of a measure.
  const auto add = [&](const char* name, const char* value_name, Measure measure, const auto& read, std::string help) {
    OptionRow row{.names = name, .value_name = value_name, .help = std::move(help)};
    row.take = [&options, name, measure, read](const std::vector<std::string>& given) {
      options.rules.criteria.push_back(
          {.measure = measure, .bound = read(name, given.back()), .bound_text = given.back()});
    };
    table.add(std::move(row));
  };
  table.open_group = "Criteria";
  add("--max-difference", "D", Measure::largest_difference, bound_from_text,
      "No value differs by more than D: a number, or a fraction like 2/255");
  add("--max-ulp", "COUNT", Measure::largest_ulp, count_from_text,
      "No value differs by more steps of its storage, of two the coarser: floats, halves, codes");
  add("--pixels", "COUNT", Measure::pixels_beyond, count_from_text,
      "At most so many pixels differ by more than --delta");
  const auto read_delta = [](const std::string& text) { return GivenNumber{bound_from_text("--delta", text), text}; };
  add_read(table, "--delta", "D", options.delta, read_delta, "What --pixels and --window let pass; without it 0");
  OptionRow windows{
      .names = "--window",
      .value_name = "SIDE:SHARE",
      .help =
          "At most this share of the pixels of any SIDExSIDE window differ by more than --delta, like 16:0.05; SIDE "
          "is 8, 16, 32, 64 or 128; may be repeated",
      .is_repeated = true};
  windows.take = [&options](const std::vector<std::string>& given) {
    for (const std::string& text : given) options.rules.criteria.push_back(window_from_text(text));
  };
  table.add(std::move(windows));
  add("--psnr", "DB", Measure::psnr, bound_from_text,
      "Each channel's peak signal-to-noise ratio is at least so many dB");
  add("--flip", "MEAN", Measure::flip_mean, bound_from_text, "The mean of FLIP's map is at most MEAN; 1 never fails");
  add("--flip-median", "BOUND", Measure::flip_weighted_median, bound_from_text,
      "The weighted median of FLIP's map is at most BOUND");
  add_switch(table, "--allow-nonfinite", options.rules.allow_not_finite,
             "Infinities and NaN pass where both pictures have the same");
  add_switch(table, "--no-judge", options.no_judge,
             "Compare values although the reference carries its scene, by which pixels can be judged");
  of_names(add_read(table, "--color-space", "NAME", options.rules.color_space, color_space_from_text,
                    "What both pictures' R, G and B are, whatever the files say: srgb or linear"),
           kColorSpaceNames);
}

/// Gives criteria their delta, and their order.
void settle_criteria(CompareOptions& options) {
  std::vector<compare::Criterion>& criteria = options.rules.criteria;
  std::stable_sort(criteria.begin(), criteria.end(),
                   [](const auto& a, const auto& b) { return a.measure < b.measure; });
  bool any_delta = false;
  for (compare::Criterion& criterion : criteria)
    if (compare::has_delta(criterion.measure)) {
      const GivenNumber delta = options.delta.value_or(GivenNumber());
      criterion.delta = delta.value, criterion.delta_text = delta.text, any_delta = true;
    }
  if (options.delta && !any_delta)
    throw usage("--delta", "it is what --pixels and --window let pass",
                "add --pixels COUNT, or give --max-difference instead");
}

/// Words with spaces between; one in double quotes may hold some.
std::vector<std::string> words_of_line(std::string_view line) {
  std::vector<std::string> words;
  for (size_t at = 0; (at = line.find_first_not_of(" \t\r", at)) != std::string_view::npos;) {
    const bool is_quoted = line[at] == '"';
    const size_t begin = at + (is_quoted ? 1 : 0), found = line.find_first_of(is_quoted ? "\"" : " \t\r", begin),
                 end = std::min(found, line.size());
    if (is_quoted && found == std::string_view::npos) throw usage("quote", "it is not closed", "add another");
    words.emplace_back(line.substr(begin, end - begin));
    at = std::min(end + (is_quoted ? 1 : 0), line.size());
  }
  return words;
}

NamedCriteria criteria_of_line(const std::vector<std::string>& words, const CompareOptions& others) {
  NamedCriteria named{words.front(), others};
  named.options.rules.criteria.clear();
  named.options.delta.reset();
  CommandTable table{"compare", {}};
  compare::MaskRules mask;
  add_criteria(table, named.options);
  add_mask(table, mask);
  take_options(table, std::span(words).subspan(1));
  settle_criteria(named.options);
  check_mask(mask);
  if (mask.any()) named.options.mask = mask;
  return named;
}

/// What of two pictures is compared.
void add_parts(CommandTable& table, CompareOptions& options) {
  table.open_group = "What is compared";
  add_read(table, "--channels", "LIST", options.channels, channels_from_text,
           "These channels alone: letters like RGB, or names with commas between, like R,G,depth.Z");
  of_names(add_read(table, "--rows", "ORDER", options.bottom_up, is_bottom_up,
                    "How the test's rows run: top_down, or bottom_up as glReadPixels gives them"),
           kRowOrders);
  add_mask(table, options.mask);
}

/// Error(usage) of an option of FLIP that does nothing, whatever the pictures are.
void check_flip(const CompareOptions& options) {
  const auto& criteria = options.rules.criteria;
  const bool is_measured =
      std::any_of(criteria.begin(), criteria.end(), [](const auto& c) { return compare::is_flip(c.measure); }) ||
      std::any_of(options.outputs.begin(), options.outputs.end(), [](const std::string& path) {
        return !has_ending(path, ".html") && !has_ending(path, ".exr");  // a map, or a folder of maps
      });
  for (const std::string& name : options.of_flip) {
    if (!is_measured) throw usage(name, "nothing here measures FLIP", "add --flip MEAN or -o map.png, or leave it out");
    if (options.rules.range == compare::CompareRules::Range::low && (name == "--tone-mapper" || name == "--exposures"))
      throw usage(name, "with --ldr nothing is exposed", "leave out one of them");
  }
}

void add_flip(CommandTable& table, CompareOptions& options) {
  using Range = compare::CompareRules::Range;
  table.open_group = "FLIP";
  const size_t first = table.rows.size();
  const auto add_range = [&](const char* name, Range range, std::string help) {
    OptionRow row{.names = name, .value_name = "", .help = std::move(help)};
    row.take = [&rules = options.rules, range](const std::vector<std::string>&) {
      if (rules.range != Range::by_storage)
        throw usage("--hdr", "--ldr and --hdr exclude each other", "give one of them");
      rules.range = range;
    };
    table.add(std::move(row));
  };
  add_read(table, "--ppd", "COUNT", options.rules.flip.pixels_per_degree, ppd_from_text,
           "Pixels per degree of the visual field (67.02)");
  add_range("--ldr", Range::low, "Colours are what a screen shows; the default for codes");
  add_range("--hdr", Range::high, "Colours are light of any strength; the default for floats");
  of_names(add_read(table, "--tone-mapper", "NAME", options.rules.flip.tone_mapper, mapper_from_text, "With --hdr:"),
           compare::kToneMapperNames);
  add_read(table, "--exposures", "START,STOP[,COUNT]", options.rules.flip.exposures, exposures_from_text,
           "With --hdr: factors of light as powers of 2, instead of those found from the reference");
  for (size_t i = first; i < table.rows.size(); ++i) {
    OptionRow& row = table.rows[i];
    row.take = [&options, name = row.names, take = row.take](const std::vector<std::string>& given) {
      options.of_flip.push_back(name);
      take(given);
    };
  }
}

}  // namespace

CommandTable compare_table(CompareOptions& options) {
  CommandTable table{"compare", "Compare two pictures, or two folders of pictures"};
  add_value(table, "REFERENCE", "FILE", options.reference,
            "Picture that is right, or a folder of them: .exr, .png, .hdr, .tif, .dds, .npy, .jpg; or - for one from "
            "standard input")
      .is_required = true;
  add_value(table, "TEST", "FILE", options.test, "Picture that is in question, or a folder, or -").is_required = true;
  table.open_group = "Output";
  add_values(
      table, "-o,--output", "FILE", options.outputs,
      "Differences to write: .png as FLIP's map, .exr as numbers, .html as a page to look into; of folders "
      ".html as a gallery, and a folder for maps, and for each picture's page beside a gallery; may be repeated");
  add_value(table, "--junit", "FILE", options.junit, "JUnit XML to write, .xml, for CI services");
  add_switch(table, "--accept", options.accept,
             "Copy test pictures that do not pass over their references, but none that is not finite");
  add_switch(table, "--json", options.json, "Print all of it as one JSON document");
  add_quiet(table, options, "Print the verdict alone; say neither notes nor progress nor which files were written");
  add_criteria(table, options);
  add_value(
      table, "--criteria", "FILE", options.criteria_file,
      "Criteria of single pictures of two folders: lines of a pattern of names and the options above, or a mask, of "
      "which the first that fits a name goes before those of the command");
  add_parts(table, options);
  add_flip(table, options);
  add_threads(table, options.rules.threads, "Threads, 0 for one a core; never changes a figure");
  add_limits(table, options.limits);
  table.details =
      "Without a criterion every stored value has to be equal. Values that are not finite, and sizes, parts or "
      "channels "
      "that do not fit together, fail under every criterion.\n"
      "Exit codes: 0 they pass, 1 they do not; others as for trueshade.";
  table.examples = {{"trueshade compare golden.png now.png --max-difference 1/255", "Equal but for one code."},
                    {"trueshade compare golden now --junit result.xml", "Two folders of pictures, for a CI service."},
                    {"trueshade compare golden now -o report.html -o maps",
                     "A gallery of both, the worst first, with a page of each that differs."}};
  table.see_also = {"render", "validate"};
  table.finished = [&options]() -> Command { return finished(std::move(options)); };
  return table;
}

std::vector<NamedCriteria> named_criteria(const CompareOptions& options) {
  constexpr uint64_t kMostBytes = uint64_t(1) << 20;
  std::vector<NamedCriteria> all;
  if (!options.criteria_file) return all;
  const Bytes bytes = read_user_file(*options.criteria_file, kMostBytes, {});
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // as some editors begin UTF-8
  size_t number = 0;
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = text.substr(at, end - at);
    at = end + 1, ++number;
    try {
      const std::vector<std::string> words = line.starts_with('#') ? std::vector<std::string>() : words_of_line(line);
      if (words.empty()) continue;
      all.push_back(criteria_of_line(words, options));
    } catch (const Error& error) {
      const std::string what = error.what();  // REASON (REMEDY)
      const size_t open = what.rfind(" (");
      throw Error(ErrorKind::bad_input, *options.criteria_file + ": line " + std::to_string(number),
                  what.substr(0, open), what.substr(open + 2, what.size() - open - 3));
    }
  }
  return all;
}

CompareOptions finished(CompareOptions options) {
  settle_criteria(options);
  check_mask(options.mask);
  if (options.bottom_up && options.accept)
    throw usage("--accept", "the test's file would be the reference, and its rows run the other way",
                "save it from the top down, or leave out one of --rows and --accept");
  if (options.reference.empty() || options.test.empty())
    throw usage("compare", "a name is empty", "name two pictures, or two folders");
  if (options.junit && !has_ending(*options.junit, ".xml"))
    throw usage("--junit", "'" + *options.junit + "' does not end like XML", "end the name in .xml");
  for (const std::string& path : options.outputs)
    if (path.empty()) throw usage("-o", "'' is no name of a file or a folder", "name one");
  for (const std::string& path : options.outputs)
    options.rules.wants_flip = options.rules.wants_flip || has_ending(path, ".png");
  check_named_once("-o", options.outputs);
  check_flip(options);
  return options;
}

}  // namespace trueshade
