#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace trueshade {

/// One way to draw the frame, ready to be timed: warm caches, programs linked, scene uploaded.
struct Contender {
  std::string name;              ///< who draws: trueshade, gl, embree
  std::string strategy;          ///< how, as `trueshade list` or the peer names it
  std::function<double()> draw;  ///< draws one frame and returns the time it took, ms
};

/// Times of one contender, sorted. The first frame, which pays for caches and compilers, counts only where it was the
/// only one.
struct Timing {
  std::vector<double> ms;
  double least() const { return ms.front(); }
  double median() const { return ms[ms.size() / 2]; }
  double lower_quartile() const { return ms[ms.size() / 4]; }
  double upper_quartile() const { return ms[ms.size() * 3 / 4]; }
  double spread() const { return (upper_quartile() - lower_quartile()) / median(); }
};

struct ContestRules {
  int rounds = 100;           ///< at most
  double budget_ms = 2500.0;  ///< of one contender: who has used it up sits out the rounds that are left
};

/// Every contender draws once to warm up, then all draw in turn, round after round, so that what else the machine does
/// falls on all of them alike. Timings in the contenders' order. `step` is called after each frame with frames drawn.
std::vector<Timing> contest(std::span<const Contender> contenders, const ContestRules& rules,
                            const std::function<void(int done, int most)>& step = {});

}  // namespace trueshade
