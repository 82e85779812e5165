#include "bench/contest.h"

#include <algorithm>
#include <numeric>

namespace trueshade {

std::vector<Timing> contest(std::span<const Contender> contenders, const ContestRules& rules,
                            const std::function<void(int done, int most)>& step) {
  const int most = int(contenders.size()) * (rules.rounds + 1);
  std::vector<Timing> timings(contenders.size());
  std::vector<double> used(contenders.size());
  int done = 0;
  for (int round = 0; round <= rules.rounds; ++round) {
    for (size_t i = 0; i < contenders.size(); ++i) {
      if (used[i] < rules.budget_ms) {
        const double ms = contenders[i].draw();
        used[i] += ms;
        if (round == 1) timings[i].ms.clear();  // the warm-up
        timings[i].ms.push_back(ms);
      }
      if (step) step(++done, most);
    }
  }
  for (Timing& timing : timings) std::sort(timing.ms.begin(), timing.ms.end());
  return timings;
}

}  // namespace trueshade
