#include "farm/mpi/mpi_module.h"

#include "farm/mpi/mpi_ranks.h"

extern "C" __attribute__((visibility("default"))) trueshade::Ranks* trueshade_join_mpi_ranks() {
  return new trueshade::MpiRanks;
}
