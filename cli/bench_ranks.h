#pragma once
// `bench --ranks`: how drawing scales with processes and machines.
#include <algorithm>
#include <string>
#include <vector>

#include "bench/farm_model.h"
#include "bench/machine.h"

namespace trueshade {

/// All tasks of a picture or a sequence, done by one process one after the other.
struct TaskCosts {
  std::vector<TaskCost> tasks;
  double start_s = 0;   ///< until the first task: reading and preparing the scene
  double finish_s = 0;  ///< after the last one: what is left to do of the file
  std::string hash;     ///< what --hash printed

  double draw_s() const;
  double take_s() const;
};

/// The tasks of fewer and larger bands: `group` bands are one. Their drawing is added up, but for what each band costs
/// by itself, which is paid once.
std::vector<TaskCost> grouped(const std::vector<TaskCost>& bands, int group, double band_s);

/// One scene, measured.
struct RanksTime {
  std::string scene;
  std::string picture;  ///< `65536x65536, deferred-loop, PNG and hash`
  bool by_bands = true;
  TaskCosts coarse, fine;  ///< bands for one rank, and for the most machines of the table; of frames both are the same
  double band_s = 0;       ///< what a band costs by itself, from the difference between the two

  struct Measured {
    int ranks;
    double seconds;  ///< from the first task to the end of the file
    double model_s;
  };
  std::vector<Measured> here;
  int threads_of_rank = 0;  ///< of each of them

  struct Row {
    int machines, tasks;
    FarmEstimate estimate;
    double seconds;   ///< with start and finish
    double serial_s;  ///< rank 0's taking, and finish
  };
  std::vector<Row> table;  ///< of machines like this one

  double start_s() const { return std::min(coarse.start_s, fine.start_s); }
};

struct RanksResult {
  Machine machine;
  int threads = 0;  ///< of a machine of the table
  std::string simd;
  Network network;
  std::vector<RanksTime> scenes;
};

std::string ranks_text(const RanksResult& result);
std::string ranks_json(const RanksResult& result);

}  // namespace trueshade
