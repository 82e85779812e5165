#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/image_files/file_aside.h"

// A file of arrays that is mapped. It is cut into segments of 64 KiB, each with a CRC-32, so that what is read of it
// can be checked without the rest. From its beginning: arrays, each at a multiple of 64 bytes; tables that say where
// they are; the checksums of the segments that hold these; the footer.
namespace trueshade {

inline constexpr size_t kSegmentBytes = size_t(1) << 16;

/// Writes such a file aside, one array after the other. Functions throw Error(io).
class CheckedFileWriter {
 public:
  explicit CheckedFileWriter(const std::string& path) : file_(path) {}

  uint64_t add(std::span<const uint8_t> array);  ///< returns where it begins
  void finish(std::span<const uint8_t> tables);  ///< the file takes its name

 private:
  void append(std::span<const uint8_t> bytes);
  void pad(size_t alignment);

  FileAside file_;
  std::vector<uint32_t> checksums_;  ///< of the segments that are full
  uint32_t checksum_ = 0;            ///< of the segment that is not
  uint64_t size_ = 0;
};

/// Such a file, mapped read-only for the object's lifetime.
class CheckedFile {
 public:
  /// Nothing for a file that is not there or cannot be read, that another user could have written, that has another
  /// format or is torn, and whose tables are damaged. The tables are checked, and nothing else is.
  static std::shared_ptr<const CheckedFile> open(const std::string& path);
  ~CheckedFile();
  CheckedFile(const CheckedFile&) = delete;
  CheckedFile& operator=(const CheckedFile&) = delete;

  std::span<const uint8_t> tables() const { return tables_; }

  /// The bytes [offset, offset + bytes), not checked. Nothing where the file does not have them.
  std::optional<std::span<const uint8_t>> bytes_at(uint64_t offset, uint64_t bytes) const;

  /// Checks the segments of these bytes of the file, each once as long as it stays in memory: Error(io) for a damaged
  /// one. May be called on any thread. Where the process takes more than memory_cap(), what is mapped is given back to
  /// the system, and comes back where it is read again.
  void check(const void* first, size_t bytes) const {
    if (bytes == 0) return;
    const auto begin = size_t(static_cast<const uint8_t*>(first) - map_), end = begin + bytes - 1;
    for (size_t segment = begin / kSegmentBytes; segment <= end / kSegmentBytes; ++segment)
      if ((checked_[segment / 64].load(std::memory_order_acquire) >> (segment % 64) & 1) == 0) check_segment(segment);
  }
  void check_all() const;

  /// Asks the system to read these bytes of the file soon.
  void fetch(const void* first, size_t bytes) const;

 private:
  CheckedFile(std::string path, const uint8_t* map, size_t size);
  bool read_footer();
  bool is_intact(size_t segment) const;
  void check_segment(size_t segment) const;
  void stay_below_cap() const;

  std::string path_;
  const uint8_t* map_;
  size_t size_, content_ = 0;  ///< bytes in all; those that have checksums
  std::span<const uint8_t> tables_;
  const uint32_t* checksums_ = nullptr;
  mutable std::vector<std::atomic<uint64_t>> checked_;  ///< a bit a segment
  mutable std::atomic<size_t> checks_{0};               ///< how many segments have been checked
};

}  // namespace trueshade
