#pragma once
#include <string_view>

namespace trueshade {

/// Whether a file's name ends with `ending`, which is in small letters; the name may have capitals there.
constexpr bool has_ending(std::string_view name, std::string_view ending) {
  if (name.size() < ending.size()) return false;
  name.remove_prefix(name.size() - ending.size());
  for (size_t i = 0; i < ending.size(); ++i)
    if (name[i] != ending[i] && !(name[i] >= 'A' && name[i] <= 'Z' && name[i] + 32 == ending[i])) return false;
  return true;
}

}  // namespace trueshade
