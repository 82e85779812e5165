// Plants every fault in captures of three scenes, and writes what the diagnosis says: a line a try, tab-separated.
//
//   diagnosis_rows FILE [PART-OF-A-NAME [VIEWS [STEP [PART PARTS]]]]
//   diagnosis_rows FILE --pairs COUNT
//
// STEP: of the tries one in so many, of each fault from another one on; a number that shares no factor with 24 meets
// all scenes, targets and strategies. PART of PARTS: of the faults one in so many, for several processes. Pairs: two
// faults at once; the fault is `one + other`, `named first` says whether the first of them is named, `named` whether
// both are.
//
// Fault, scene, preset, strategy, target, variant, view, pixels changed, convicted, named first, named, plane blamed,
// ms, findings, pixels changed beyond what is legal. Made into docs/data/diagnosis.md by scripts/diagnosis_table.sh.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "tests/judge/diagnosis/planted.h"

using namespace trueshade;
using namespace trueshade::testing;

namespace {

void write(FILE* file, const std::string& name, const Ground& ground, int variant, uint64_t changed, bool convicted,
           bool first, bool named, const PlantedTry& t) {
  std::fprintf(file, "%s\t%s\t%s\t%s\t%s\t%d\t%d\t%llu\t%d\t%d\t%d\t%d\t%.0f\t%s\t%llu\n", name.c_str(),
               ground.scene.c_str(), ground.preset.c_str(), std::string(name_of(ground.strategy)).c_str(),
               std::string(info(ground.target).name).c_str(), variant, ground.view,
               static_cast<unsigned long long>(changed), int(convicted), int(first), int(named), int(t.blamed), t.ms,
               t.found.c_str(), static_cast<unsigned long long>(t.beyond));
  std::fflush(file);
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 2) return 2;
  FILE* file = std::fopen(arguments[1], "w");
  if (file == nullptr) return 5;
  if (count > 3 && std::strcmp(arguments[2], "--pairs") == 0) {
    int variant = 0;
    for (const PlantedPair& pair : pairs_of_plants(std::atoi(arguments[3]))) {
      const PlantedTry t = planted_try(pair.ground, *pair.one, variant++, pair.other);
      const std::string name = std::string(pair.one->name) + " + " + std::string(pair.other->name);
      write(file, name, pair.ground, variant - 1, std::min(t.changed, t.both_matter), t.convicted, t.named,
            t.named && t.second, t);
    }
    return std::fclose(file) == 0 ? 0 : 5;
  }
  const char* part = count > 2 ? arguments[2] : "";
  const int views = count > 3 ? std::atoi(arguments[3]) : 2;
  const int step = count > 4 ? std::atoi(arguments[4]) : 1;
  const int share = count > 6 ? std::atoi(arguments[5]) : 0, shares = count > 6 ? std::atoi(arguments[6]) : 1;
  int ordinal = 0;
  for (const Plant& plant : plants()) {
    int tries = ordinal * 5;
    if (ordinal++ % shares != share) continue;
    if (std::string(plant.name).find(part) == std::string::npos) continue;
    for (const std::string_view preset : plant.presets)
      for (const Ground& ground : grounds(plant, preset, views))
        for (int variant = 0; variant < plant.variants; ++variant) {
          if (plant.loops_only && blends_lights(ground.strategy)) continue;
          if (tries++ % step != 0) continue;
          const PlantedTry t = planted_try(ground, plant, variant);
          write(file, std::string(plant.name), ground, variant, t.changed, t.convicted, t.first, t.named, t);
        }
  }
  return std::fclose(file) == 0 ? 0 : 5;
}
