// The module is looked for beside the program, then where `cmake --install` puts it.
#include "farm/process_ranks.h"

#include <dlfcn.h>
#include <sched.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

#include "core/error.h"
#include "farm/mpi_module.h"

namespace trueshade {
namespace {

struct Variables {
  const char *rank, *size;
};
// Open MPI's mpirun, MPICH's, and Slurm with PMIx.
constexpr std::array<Variables, 3> kVariables = {{{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
                                                  {"PMI_RANK", "PMI_SIZE"},
                                                  {"PMIX_RANK", "SLURM_STEP_NUM_TASKS"}}};

/// Lets this process run on every core that the system grants it. mpirun binds each of one or two processes to a core
/// of its own, which is for programs of one thread. A binding that was asked for stays.
void undo_usual_binding() {
  if (std::getenv("OMPI_MCA_orte_bound_at_launch") == nullptr || std::getenv("OMPI_MCA_hwloc_base_binding_policy"))
    return;
  cpu_set_t all;
  std::memset(&all, 0xff, sizeof all);
  sched_setaffinity(0, sizeof all, &all);
}

/// Loads the module and joins the other processes; the caller owns the ranks. Error(io) where no module can be loaded,
/// or where some processes did not come within two minutes.
Ranks* loaded_ranks() {
  namespace fs = std::filesystem;
  std::error_code absent;
  const fs::path here = fs::read_symlink("/proc/self/exe", absent).parent_path();
  std::string reason = "it is not there";
  for (const char* folder : {".", "../lib/trueshade", "../" TRUESHADE_LIBDIR "/trueshade"}) {
    const fs::path path = here / folder / kMpiModule;
    if (!fs::exists(path, absent)) continue;
    void* const module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    const auto join = module == nullptr ? nullptr : reinterpret_cast<JoinRanks>(dlsym(module, kMpiModuleSymbol));
    if (join != nullptr) {
      if (Ranks* const joined = join()) return joined;
      throw Error(ErrorKind::io, "MPI", "some processes of this run did not come within two minutes",
                  "see what mpirun says of them");
    }
    reason = dlerror();
  }
  throw Error(ErrorKind::io, kMpiModule, "this run was started by MPI, and the module cannot be loaded: " + reason,
              "install the package trueshade-mpi, build with libopenmpi-dev, or start without mpirun");
}

/// The ranks of this process; null until they are joined.
std::unique_ptr<Ranks>& joined_ranks() {
  static std::unique_ptr<Ranks> ranks;
  return ranks;
}

}  // namespace

MpiStart mpi_start() {
  for (const auto& [rank, size] : kVariables) {
    const char* const own = std::getenv(rank);
    const char* const all = std::getenv(size);
    if (own != nullptr && all != nullptr) return {std::atoi(all) > 1, std::atoi(own)};
  }
  return {};
}

Ranks* process_ranks() {
  std::unique_ptr<Ranks>& ranks = joined_ranks();
  if (!ranks && mpi_start().by_mpi) {
    undo_usual_binding();
    ranks.reset(loaded_ranks());
  }
  return ranks.get();
}

int leave_process_ranks(int exit_code) {
  if (Ranks* const ranks = joined_ranks().get()) ranks->leave(exit_code);
  return exit_code;
}

}  // namespace trueshade
