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

/// Runs `work` on another thread while the interpreter's lock is released. The calling thread looks for signals
/// meanwhile, so that Ctrl-C ends a long call. `work` receives a function to call now and then. This function throws
/// after an interrupt. Work that never calls the function runs to its end before the interrupt is raised.
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
