// Plants every fault in captures of three scenes, and writes what the diagnosis says: a line a try, tab-separated.
//
//   diagnosis_rows FILE [PART-OF-A-NAME [VIEWS [STEP]]]
//
// STEP: of the tries one in so many.
//
// Fault, scene, preset, strategy, target, variant, view, pixels changed, convicted, named first, named, plane blamed,
// ms, findings. Made into docs/data/diagnosis.md by scripts/diagnosis_table.sh.
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "tests/judge/diagnosis/planted.h"

using namespace trueshade;
using namespace trueshade::testing;

int main(int count, char** arguments) {
  if (count < 2) return 2;
  FILE* file = std::fopen(arguments[1], "w");
  if (file == nullptr) return 5;
  const char* part = count > 2 ? arguments[2] : "";
  const int views = count > 3 ? std::atoi(arguments[3]) : 2;
  const int step = count > 4 ? std::atoi(arguments[4]) : 1;
  for (const Plant& plant : plants()) {
    int tries = 0;
    if (std::string(plant.name).find(part) == std::string::npos) continue;
    for (const std::string_view preset : plant.presets)
      for (const Ground& ground : grounds(preset, views))
        for (int variant = 0; variant < plant.variants; ++variant) {
          if (plant.loops_only && blends_lights(ground.strategy)) continue;
          if (tries++ % step != 0) continue;
          const PlantedTry t = planted_try(ground, plant, variant);
          std::fprintf(file, "%s\t%s\t%s\t%s\t%s\t%d\t%d\t%llu\t%d\t%d\t%d\t%d\t%.0f\t%s\n",
                       std::string(plant.name).c_str(), ground.scene.c_str(), ground.preset.c_str(),
                       std::string(name_of(ground.strategy)).c_str(), std::string(info(ground.target).name).c_str(),
                       variant, ground.view, static_cast<unsigned long long>(t.changed), int(t.convicted), int(t.first),
                       int(t.named), int(t.blamed), t.ms, t.found.c_str());
          std::fflush(file);
        }
  }
  return std::fclose(file) == 0 ? 0 : 5;
}
