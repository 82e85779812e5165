#pragma once
#include <atomic>
#include <cstdint>
#include <string>

#include "core/memory_cap.h"

namespace trueshade {

/// Counts the bytes of a file that is made in memory. What a file will take is predicted before a frame is drawn, but
/// how much compression helps depends on the picture: from 64 MiB on, what is made is held to the memory cap. Threads
/// may count at once.
class FileBudget {
 public:
  explicit FileBudget(const std::string& where) : where_(where) {}

  /// Error(limit) over the cap.
  void take(uint64_t bytes) {
    constexpr uint64_t kUnasked = uint64_t(64) << 20;
    if (taken_.fetch_add(bytes) + bytes > kUnasked) require_memory(bytes, where_, "the file");
  }

 private:
  const std::string& where_;
  std::atomic<uint64_t> taken_{0};
};

}  // namespace trueshade
