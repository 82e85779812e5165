#pragma once
#include "tests/judge/diagnosis/planted.h"

namespace trueshade::testing {

const std::vector<Plant>& plants_of_pictures();
const std::vector<Plant>& plants_of_planes();
const std::vector<Plant>& plants_of_scenes();
const std::vector<Plant>& plants_of_lights();
const std::vector<Plant>& plants_of_materials();
const std::vector<Plant>& plants_of_filters();
const std::vector<Plant>& plants_of_gloss();

}  // namespace trueshade::testing
