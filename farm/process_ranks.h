#pragma once
#include "farm/ranks.h"

namespace trueshade {

/// How this process was started, as its environment variables tell.
struct MpiStart {
  bool by_mpi = false;  ///< by mpirun or the like, with more than one process
  int rank = 0;         ///< 0 where no variable tells
};

/// Reads OMPI_COMM_WORLD_RANK, PMI_RANK or PMIX_RANK, each with the variable of the number of processes. The first pair
/// of which both are set counts; without any, the process was not started by MPI. Needs no MPI.
MpiStart mpi_start();

/// The ranks of the run that this process belongs to; nullptr where MPI did not start it, or where it is alone. The
/// first call joins the others: it undoes mpirun's usual binding to cores, and loads the module trueshade_mpi.so, which
/// links MPI. Error(io) where that cannot be loaded, or where others have not come within two minutes.
Ranks* process_ranks();

/// Leaves the ranks, if they were joined, by Ranks::leave(), which waits for the others for some seconds, and ends the
/// process here where one is lost. Returns `exit_code`. Call it last before the process ends.
int leave_process_ranks(int exit_code);

}  // namespace trueshade
