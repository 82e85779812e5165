#include "cli/unknown_option.h"

#include <algorithm>

namespace trueshade {
namespace {

/// How many letters have to be inserted, removed or replaced (V. Levenshtein, 1966).
size_t changes_between(const std::string& a, const std::string& b) {
  std::vector<size_t> row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

}  // namespace

std::string first_unknown_option(std::span<const std::string> arguments, std::span<const std::string> known) {
  for (const std::string& argument : arguments) {
    const std::string name = argument.substr(0, argument.find('='));
    if (name.size() > 1 && name[0] == '-' && std::find(known.begin(), known.end(), name) == known.end()) return name;
  }
  return {};
}

std::string likeliest_name(const std::string& name, std::span<const std::string> known) {
  std::string likeliest;
  size_t least = std::min(std::max<size_t>(2, name.size() / 3) + 1, name.size() / 2);
  for (const std::string& other : known)
    if (const size_t changes = changes_between(name, other); changes < least) likeliest = other, least = changes;
  return likeliest;
}

}  // namespace trueshade
