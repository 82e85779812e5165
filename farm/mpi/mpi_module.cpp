#include "farm/mpi_module.h"

#include "farm/mpi/mpi_ranks.h"

extern "C" __attribute__((visibility("default"))) trueshade::Ranks* trueshade_join_mpi_ranks() {
  auto* const ranks = new trueshade::MpiRanks;  // if it waits for others, its thread goes on
  return ranks->has_joined() ? ranks : nullptr;
}
