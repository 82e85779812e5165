#include "tests/judge/diagnosis/plants.h"

namespace trueshade::testing {

std::span<const Plant> plants() {
  static const std::vector<Plant> all = [] {
    std::vector<Plant> both = plants_of_pictures();
    both.insert(both.end(), plants_of_planes().begin(), plants_of_planes().end());
    return both;
  }();
  return all;
}

}  // namespace trueshade::testing
