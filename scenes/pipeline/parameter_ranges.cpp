#include "scenes/pipeline/parameter_ranges.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

#include "scenes/json/json_value.h"
#include "scenes/pipeline/program_inputs.h"

namespace trueshade {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

void skip_blanks(std::string_view& text) { text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size())); }

bool take(std::string_view& text, std::string_view word) {
  skip_blanks(text);
  if (!text.starts_with(word)) return false;
  text.remove_prefix(word.size());
  return true;
}

std::optional<double> taken_number(std::string_view& text) {
  skip_blanks(text);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
  text.remove_prefix(size_t(end - text.data()));
  return value;
}

std::optional<ParameterRange> range_in(std::string_view comment) {
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  const bool open = take(comment, "from ");
  const std::optional<double> least = taken_number(comment);
  if (!least) return std::nullopt;
  ParameterRange range{*least, kEndless};
  if (!open) {
    if (!take(comment, "to ")) return std::nullopt;
    const std::optional<double> most = taken_number(comment);
    if (!most || *most < *least) return std::nullopt;
    range.most = *most;
  }
  if (take(comment, ", usually "))
    if (const std::optional<double> usual = taken_number(comment); usual && range.holds(float(*usual)))
      range.usual = float(*usual);
  return range;
}

/// Whether a place of a text is in a comment.
bool is_in_comment(std::string_view text, size_t place) {
  for (size_t at = 0; (at = text.find('/', at)) < place;) {
    const std::string_view opening = text.substr(at, 2);
    if (opening != "//" && opening != "/*") {
      ++at;
      continue;
    }
    const size_t end = text.find(opening == "//" ? "\n" : "*/", at + 2);
    if (end == std::string_view::npos || end > place) return true;
    at = end + 1;
  }
  return false;
}

/// Whether a declaration is of integers or bools.
bool is_whole(std::string_view declaration) {
  skip_blanks(declaration);
  return declaration.starts_with('i') || declaration.starts_with('u') || declaration.starts_with('b');
}
bool holds_whole(float value) { return value == std::floor(value) && std::fabs(value) <= kLargestWholeParameter; }

/// What stands behind the brace of the block of parameters; empty where there is no such block.
std::string_view block_of(std::string_view text) {
  constexpr std::string_view kUniform = "uniform";
  for (size_t at = text.find(kUniform); at != std::string_view::npos; at = text.find(kUniform, at + 1)) {
    std::string_view rest = text.substr(at + kUniform.size());
    if (take(rest, "Parameters") && take(rest, "{") && !is_in_comment(text, at)) return rest;
  }
  return {};
}

/// The name that a declaration ends in, "vec2 size[2]": size; empty where there is none.
std::string_view name_in(std::string_view declaration) {
  declaration = declaration.substr(0, declaration.find('['));
  while (!declaration.empty() && !is_letter(declaration.back())) declaration.remove_suffix(1);
  size_t first = declaration.size();
  while (first > 0 && is_letter(declaration[first - 1])) --first;
  return declaration.substr(first);
}

}  // namespace

std::string ParameterRange::text() const {
  const bool open = std::isinf(most);
  return open ? "from " + json::number_text(least) : json::number_text(least) + " to " + json::number_text(most);
}

std::vector<DeclaredParameter> declared_parameters(std::string_view text) {
  std::vector<DeclaredParameter> declared;
  std::string_view block = block_of(text);
  for (bool ends = block.empty(); !ends && !block.empty();) {
    const std::string_view line = block.substr(0, block.find('\n'));
    block.remove_prefix(std::min(line.size() + 1, block.size()));
    const size_t comment = std::min(line.find("//"), line.size());
    std::string_view members = line.substr(0, comment);
    ends = members.find('}') != std::string_view::npos;
    std::optional<ParameterRange> range = range_in(line.substr(std::min(comment + 2, line.size())));
    if (range && range->usual && is_whole(members) && !holds_whole(*range->usual)) range->usual.reset();
    while (!members.empty()) {
      const std::string_view one = members.substr(0, members.find_first_of(",;}"));
      members.remove_prefix(std::min(one.size() + 1, members.size()));
      if (const std::string_view name = name_in(one); !name.empty()) declared.push_back({std::string(name), range});
    }
  }
  return declared;
}

const ParameterRange* range_of(const std::vector<DeclaredParameter>& declared, std::string_view name) {
  const auto found =
      std::find_if(declared.begin(), declared.end(), [name](const auto& one) { return one.name == name; });
  return found == declared.end() || !found->range ? nullptr : &*found->range;
}

}  // namespace trueshade
