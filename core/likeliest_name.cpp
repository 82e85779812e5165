#include "core/likeliest_name.h"

#include <algorithm>

namespace trueshade {
namespace {

/// Names longer than this are no slips of ours, and would take long to compare.
constexpr size_t kLongestName = 64;

char small(char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; }

/// The optimal string alignment distance (F. Damerau, "A technique for computer detection and correction of spelling
/// errors", 1964, each letter changed once).
size_t slips_between(std::string_view a, std::string_view b) {
  std::vector<size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const bool same = small(a[i - 1]) == small(b[j - 1]);
      row[j] = std::min({last[j - 1] + (same ? 0 : 1), last[j] + 1, row[j - 1] + 1});
      if (i > 1 && j > 1 && small(a[i - 1]) == small(b[j - 2]) && small(a[i - 2]) == small(b[j - 1]))
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

}  // namespace

std::string likeliest_name(std::string_view name, std::span<const std::string_view> known) {
  if (name.size() > kLongestName) return {};
  std::string_view likeliest;
  const auto begins = [name](std::string_view other) { return name.size() >= 5 && other.starts_with(name); };
  if (std::count_if(known.begin(), known.end(), begins) == 1) return std::string(*std::ranges::find_if(known, begins));
  size_t least = std::min(std::max<size_t>(2, name.size() / 3) + 1, (name.size() + 1) / 2);
  for (const std::string_view other : known)
    if (other.size() <= kLongestName)
      if (const size_t slips = slips_between(name, other); slips < least) likeliest = other, least = slips;
  return std::string(likeliest);
}

}  // namespace trueshade
