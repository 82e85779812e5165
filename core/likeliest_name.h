#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace trueshade {

/// The only known name that begins so, of five letters or more; or the one that takes the fewest slips to turn into `name`, if these are few enough for its length; otherwise
/// empty. A slip is a letter too many, too few, or another, or two neighbours in the wrong order; capitals count as
/// small letters.
std::string likeliest_name(std::string_view name, std::span<const std::string_view> known);

/// `did you mean NAME? ` for the remedy of an error, or nothing where no known name is near.
template <typename Names>
std::string did_you_mean(std::string_view name, const Names& known) {
  const std::vector<std::string_view> names(std::begin(known), std::end(known));
  const std::string meant = likeliest_name(name, names);
  return meant.empty() ? std::string() : "did you mean " + meant + "? ";
}

}  // namespace trueshade
