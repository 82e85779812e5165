#include "tests/judge/diagnosis/plants.h"

namespace trueshade::testing {

std::span<const Plant> plants() {
  static const std::vector<Plant> all = [] {
    std::vector<Plant> every = plants_of_pictures();
    for (const auto& more : {plants_of_planes(), plants_of_scenes(), plants_of_lights(), plants_of_materials(),
                             plants_of_filters(), plants_of_gloss()})
      every.insert(every.end(), more.begin(), more.end());
    return every;
  }();
  return all;
}

}  // namespace trueshade::testing
