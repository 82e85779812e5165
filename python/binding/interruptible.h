#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "python/binding/arrays.h"

namespace trueshade::python {

struct Cancelled {};

/// Runs work on a thread of its own while the interpreter's lock is released, and looks for signals meanwhile, so that
/// Ctrl-C ends a long call. `work` is given what it calls now and then, which throws once the work is to end. Work that
/// never calls it ends first, and the interrupt follows.
template <class Work>
void run_interruptible(const Work& work) {
  std::atomic<bool> cancelled = false;
  std::exception_ptr failure;
  std::mutex mutex;
  std::condition_variable changed;
  bool is_done = false;
  const auto watch = [&] {
    if (cancelled) throw Cancelled{};
  };
  std::thread worker([&] {
    try {
      work(watch);
    } catch (const Cancelled&) {
    } catch (...) {
      failure = std::current_exception();
    }
    const std::lock_guard lock(mutex);
    is_done = true;
    changed.notify_one();
  });
  bool is_interrupted = false;
  {
    const py::gil_scoped_release release;
    std::unique_lock lock(mutex);
    while (!changed.wait_for(lock, std::chrono::milliseconds(50), [&] { return is_done; })) {
      lock.unlock();
      {
        const py::gil_scoped_acquire acquire;
        is_interrupted = is_interrupted || PyErr_CheckSignals() != 0;
      }
      if (is_interrupted) cancelled = true;
      lock.lock();
    }
    lock.unlock();
    worker.join();
  }
  if (is_interrupted) throw py::error_already_set();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace trueshade::python
