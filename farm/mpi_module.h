#pragma once
// What the module trueshade_mpi.so exports. It alone links MPI, and is loaded by a command that MPI has started.
#include "farm/ranks.h"

namespace trueshade {

/// The module's only function: joins the other processes of the run, waiting up to two minutes for all of them. Returns
/// nullptr where some did not come. The caller owns the ranks. Called once in a process.
using JoinRanks = Ranks* (*)();
inline constexpr const char* kMpiModuleSymbol = "trueshade_join_mpi_ranks";  ///< the name of that function
inline constexpr const char* kMpiModule = "trueshade_mpi.so";                ///< the name of the module's file

}  // namespace trueshade
