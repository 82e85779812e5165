#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace trueshade::programs {

/// Code that the machine may run. Its pages are written first and executable afterwards, never both at once.
class ExecutableMemory {
 public:
  ExecutableMemory() = default;
  /// A copy of the code, or empty where the system refuses.
  explicit ExecutableMemory(std::span<const uint8_t> code);
  ~ExecutableMemory();
  ExecutableMemory(ExecutableMemory&& other) noexcept { *this = std::move(other); }
  ExecutableMemory& operator=(ExecutableMemory&& other) noexcept {
    std::swap(data_, other.data_), std::swap(size_, other.size_);
    return *this;
  }

  const void* data() const { return data_; }  ///< nullptr: empty

 private:
  void* data_ = nullptr;
  size_t size_ = 0;
};

}  // namespace trueshade::programs
