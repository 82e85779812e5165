#pragma once
#include "farm/ranks.h"

namespace trueshade {

/// What the environment says of how this process was started.
struct MpiStart {
  bool by_mpi = false;  ///< by mpirun or the like, with more than one process
  int rank = 0;
};
/// Reads OMPI_COMM_WORLD_RANK, PMI_RANK or PMIX_RANK, and the variable of the number of processes. Needs no MPI.
MpiStart mpi_start();

/// The ranks of this process, joined at the first call; nullptr where it was not started by MPI or is alone. Loads the
/// module trueshade_mpi.so, which links MPI. Error(io) where it is not there, or where
/// others have not come within two minutes.
Ranks* process_ranks();

/// The last call before the process ends: leaves the ranks, if they were joined. Returns `exit_code`.
int leave_process_ranks(int exit_code);

}  // namespace trueshade
