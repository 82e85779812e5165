#pragma once
#include "farm/ranks.h"

namespace trueshade {

/// What the environment says of how this process was started.
struct MpiStart {
  bool by_mpi = false;  ///< by mpirun or the like, with more than one process
  int rank = 0;         ///< 0 where no variable tells
};

/// Reads OMPI_COMM_WORLD_RANK, PMI_RANK or PMIX_RANK, and the variable of the number of processes. The first pair of
/// which both are set counts; without any the process was not started by MPI. Needs no MPI.
MpiStart mpi_start();

/// The ranks of this process; nullptr where it was not started by MPI or is alone. The first call joins them: it undoes
/// mpirun's usual binding to cores, and loads the module trueshade_mpi.so, which links MPI. Error(io) where that cannot
/// be loaded, or where others have not come within two minutes.
Ranks* process_ranks();

/// The last call before the process ends. It is Ranks::leave() if the ranks were joined, which waits for the others for
/// some seconds, and ends the process here where one is lost. Otherwise it returns `exit_code` at once.
int leave_process_ranks(int exit_code);

}  // namespace trueshade
