// Preloaded, ends a process by SIGSEGV when it is about to give a file the name c.png, and a job of a batch that is
// told of MPI.
#include <dlfcn.h>
#include <signal.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <initializer_list>

extern "C" int rename(const char* from, const char* to) {
  const size_t length = std::strlen(to);
  if (length >= 5 && std::strcmp(to + length - 5, "c.png") == 0) raise(SIGSEGV);
  static const auto real = reinterpret_cast<int (*)(const char*, const char*)>(dlsym(RTLD_NEXT, "rename"));
  return real(from, to);
}

namespace {
__attribute__((constructor)) void see_environment() {
  if (std::getenv("TRUESHADE_JOB") == nullptr) return;
  for (const char* variable : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_SIZE", "PRTE_X"})
    if (std::getenv(variable) != nullptr) raise(SIGSEGV);
}
}  // namespace
