#include "cli/mask_options.h"

#include <charconv>

#include "cli/option_values.h"

namespace trueshade {
namespace {

constexpr std::string_view kIdPlanes[] = {"id.object", "id.material"};

std::optional<uint32_t> id_from_text(std::string_view text) {
  uint32_t id = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(id) : std::nullopt;
}

/// `3` or `7-9`.
std::optional<std::pair<uint32_t, uint32_t>> range_from_text(std::string_view text) {
  const size_t dash = text.find('-');
  const auto first = id_from_text(text.substr(0, dash)),
             last = dash == std::string_view::npos ? first : id_from_text(text.substr(dash + 1));
  if (!first || !last || *first > *last) return std::nullopt;
  return std::pair(*first, *last);
}

compare::IgnoredIds ignored_from_text(const std::string& text) {
  const size_t equals = text.find('=');
  if (equals == std::string::npos)
    throw usage("--ignore", "'" + text + "' is not PLANE=NUMBER,...", "give one, like id.object=3,7-9");
  compare::IgnoredIds ignored{text.substr(0, equals), {}};
  if (std::find(std::begin(kIdPlanes), std::end(kIdPlanes), ignored.plane) == std::end(kIdPlanes))
    throw unknown_name("--ignore", "identifiers are in no plane", ignored.plane, kIdPlanes);
  for (size_t at = equals + 1; at <= text.size();) {
    const size_t comma = std::min(text.find(',', at), text.size());
    const auto range = range_from_text(std::string_view(text).substr(at, comma - at));
    if (!range)
      throw usage("--ignore", "'" + text.substr(at, comma - at) + "' is no whole number, nor two with - between",
                  "give numbers as the plane holds them, like id.object=3,7-9");
    ignored.ranges.push_back(*range);
    at = comma + 1;
  }
  return ignored;
}

}  // namespace

void add_mask(CommandTable& table, compare::MaskRules& rules) {
  table.open_group = "Mask";
  const auto read_file = [](const std::string& text) {
    if (text.empty()) throw usage("--mask", "the name is empty", "name a picture");
    return text;
  };
  add_read(table, "--mask", "FILE", rules.file, read_file,
           "Leave out the pixels that are 0, black, in this picture or .npy; 1 or white is looked at, and nothing else "
           "may be in it");
  OptionRow ignored{
      .names = "--ignore",
      .value_name = "PLANE=LIST",
      .help =
          "Leave out where the plane id.object or id.material holds a number of the list, like id.object=3,7-9: the "
          "first object is 1, and 0 where nothing is drawn; may be repeated",
      .is_repeated = true};
  ignored.take = [&rules](const std::vector<std::string>& given) {
    for (const std::string& text : given) rules.ignored.push_back(ignored_from_text(text));
  };
  table.add(std::move(ignored));
  add_switch(table, "--allow-mask", rules.allow, "Let more than 10 % be left out");
}

void check_mask(const compare::MaskRules& rules) {
  if (rules.allow && !rules.any())
    throw usage("--allow-mask", "nothing is left out", "add --mask FILE or --ignore, or leave it out");
}

}  // namespace trueshade
