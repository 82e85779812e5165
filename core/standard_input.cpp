#include "core/standard_input.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <memory>
#include <span>
#include <utility>

#include "core/error.h"
#include "core/memory_cap.h"

namespace trueshade {

namespace {

/// Bytes that come one after the other, in chunks that are let go one by one while they are put together: so they take
/// their own size and a chunk's, never twice their size. Pages of a chunk that nothing came into are not resident.
class Chunks {
 public:
  /// Room for more bytes: at least one.
  std::span<uint8_t> room() {
    if (used_ == size_) {
      constexpr size_t kLeast = size_t(1) << 16, kMost = size_t(1) << 26;
      size_ = std::clamp(bytes_, kLeast, kMost), used_ = 0;
      require_memory(size_, kStandardInput, "what comes from it");
      chunks_.emplace_back(new uint8_t[size_]);
      sizes_.push_back(0);
    }
    return {chunks_.back().get() + used_, size_ - used_};
  }
  void add(size_t bytes) { used_ += bytes, bytes_ += bytes, sizes_.back() += bytes; }
  size_t bytes() const { return bytes_; }

  std::vector<uint8_t> together() && {
    require_memory(size_, kStandardInput, "what comes from it");
    std::vector<uint8_t> all;
    all.reserve(bytes_);
    for (size_t i = 0; i < chunks_.size(); chunks_[i++].reset())
      all.insert(all.end(), chunks_[i].get(), chunks_[i].get() + sizes_[i]);
    return all;
  }

 private:
  std::vector<std::unique_ptr<uint8_t[]>> chunks_;
  std::vector<size_t> sizes_;               // bytes in each
  size_t size_ = 0, used_ = 0, bytes_ = 0;  // of the last chunk, in it, and in all
};

}  // namespace

std::vector<uint8_t> read_standard_input(uint64_t limit, std::string_view option) {
  static std::atomic<bool> is_read{false};
  if (is_read.exchange(true))
    throw Error(ErrorKind::usage, kStandardInput, "it is read already, and comes once",
                "name a file for one of the two");
  if (isatty(STDIN_FILENO) != 0)
    throw Error(ErrorKind::usage, kStandardInput, "it is a terminal", "send a file into it: trueshade ... - <FILE");
  for (Chunks chunks;;) {
    const std::span<uint8_t> room = chunks.room();
    const ssize_t got = ::read(STDIN_FILENO, room.data(), room.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0)
      throw Error(ErrorKind::io, kStandardInput, std::string("cannot read: ") + std::strerror(errno),
                  "check what is sent into it");
    if (got == 0) return std::move(chunks).together();
    chunks.add(size_t(got));
    if (chunks.bytes() > limit)
      throw Error(ErrorKind::limit, kStandardInput, "more bytes come than the limit",
                  "at most " + std::to_string(limit) + " bytes" +
                      (option.empty() ? std::string() : ", or a higher " + std::string(option)));
  }
}

}  // namespace trueshade
