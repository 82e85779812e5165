#include "core/threads/startable_threads.h"

#include <atomic>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

#include "core/error.h"

namespace trueshade {

int startable_threads(int wanted) {
  std::vector<std::thread> started;
  std::atomic<bool> over{false};
  try {
    started.reserve(size_t(wanted));
    while (int(started.size()) < wanted) started.emplace_back([&] { over.wait(false); });
  } catch (const std::system_error&) {  // the system's limit on threads, or no memory for a stack
  } catch (const std::bad_alloc&) {
  }
  over = true;
  over.notify_all();
  for (std::thread& thread : started) thread.join();
  return int(started.size());
}

void require_threads_of_library(const std::string& whose) {
  const int wanted = 2 * int(std::thread::hardware_concurrency()) + 4, started = startable_threads(wanted);
  if (started == wanted) return;
  throw Error(ErrorKind::out_of_memory, "threads",
              "the system starts no more than " + std::to_string(started) + ", and " + whose + " needs some",
              "raise the limit on processes (ulimit -u), or end others");
}

}  // namespace trueshade
