#pragma once
#include <cstdint>
#include <span>

namespace trueshade {

/// What a task of share_tasks() cost where it was measured.
struct TaskCost {
  double draw_s;   ///< by the machine that draws it: also encoding
  uint64_t bytes;  ///< of its result, as it is sent
  double take_s;   ///< by rank 0: unpacking, hashing, writing
};

struct Network {
  double bytes_per_s = 100e9 / 8;  ///< of each machine's link, and of that of rank 0
  double latency_s = 2e-6;         ///< of a message
  double look_s = 1e-3;            ///< until a rank looks for messages, which it does at least every 2 ms
};

/// What a run by many machines would take.
struct FarmEstimate {
  double seconds = 0;      ///< from the first task that is handed out to the last result that is taken
  double taking_s = 0;     ///< rank 0's work on results, one after the other; the serial part
  double receiving_s = 0;  ///< of rank 0's link
  double busiest_s = 0;    ///< drawing of the machine that draws longest
};

/// Goes through a run of share_tasks(): HandOut says who does what, and time is counted instead of passing. Machines
/// are alike; rank 0 draws too, and what it takes meanwhile makes its drawing later by 1 / `cores` of the time. Results
/// are taken in order.
FarmEstimate farm_estimate(std::span<const TaskCost> tasks, int machines, int cores, const Network& network);

}  // namespace trueshade
