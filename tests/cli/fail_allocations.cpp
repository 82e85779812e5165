// Preloaded: malloc() and its kin fail for good after as many calls as TRUESHADE_ALLOCATIONS says.
#include <dlfcn.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdlib>

extern "C" {
void* __libc_malloc(size_t bytes);
void* __libc_calloc(size_t count, size_t bytes);
void* __libc_realloc(void* old, size_t bytes);
void* __libc_memalign(size_t alignment, size_t bytes);
}

namespace {

long left = -1;  // -1: not known yet, or endless
bool known = false;

bool fails() {
  if (!known && environ != nullptr) {  // handlers are installed before there is an environment
    known = true;
    if (const char* text = std::getenv("TRUESHADE_ALLOCATIONS")) left = std::atol(text);
  }
  if (left < 0 || (left > 0 && __atomic_fetch_sub(&left, 1, __ATOMIC_RELAXED) > 0)) return false;
  left = 0;  // several threads may have counted below it
  errno = ENOMEM;
  return true;
}

/// A dlopen() that fails keeps a record of why. Where there is no memory for the first record of a thread, glibc 2.36
/// writes through a null pointer (dlfcn/dlerror.c), which says nothing of the command: the first thread, in which
/// oneTBB looks for libraries, has its record before the first call is counted.
__attribute__((constructor)) void have_a_record_of_dlopen() {
  known = true, left = -1;
  dlopen("/dev/null/none", RTLD_LAZY);
  known = false;
}

}  // namespace

extern "C" {
void* malloc(size_t bytes) { return fails() ? nullptr : __libc_malloc(bytes); }
void* calloc(size_t count, size_t bytes) { return fails() ? nullptr : __libc_calloc(count, bytes); }
void* realloc(void* old, size_t bytes) { return fails() ? nullptr : __libc_realloc(old, bytes); }
void* aligned_alloc(size_t alignment, size_t bytes) { return fails() ? nullptr : __libc_memalign(alignment, bytes); }
int posix_memalign(void** out, size_t alignment, size_t bytes) {
  *out = fails() ? nullptr : __libc_memalign(alignment, bytes);
  return *out == nullptr ? ENOMEM : 0;
}
}
