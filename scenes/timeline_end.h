#pragma once
#include "scenes/timeline.h"

namespace trueshade {

/// When all that moves has come to its last step.
struct TimelineEnd {
  double last = 0.0;        ///< seconds: of steps that repeat the end of their first run, of an orbit its period
  bool is_endless = false;  ///< something repeats or goes round
};
TimelineEnd end_of(const Timeline& timeline);

}  // namespace trueshade
