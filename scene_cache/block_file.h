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

// A file of arrays that is mapped. It is cut into blocks of 64 KiB, each with a CRC-32, so that what is read of it can
// be checked without the rest. From its beginning: arrays, each at a multiple of 64 bytes; tables that say where they
// are; the checksums of the blocks that hold these; the footer.
namespace trueshade {

inline constexpr size_t kBlockBytes = size_t(1) << 16;

/// Writes such a file aside, one array after the other. Functions throw Error(io).
class BlockFileWriter {
 public:
  explicit BlockFileWriter(const std::string& path) : file_(path) {}

  uint64_t add(std::span<const uint8_t> array);  ///< returns where it begins
  void finish(std::span<const uint8_t> tables);  ///< the file takes its name

 private:
  void append(std::span<const uint8_t> bytes);
  void pad(size_t alignment);

  FileAside file_;
  std::vector<uint32_t> checksums_;  ///< of the blocks that are full
  uint32_t checksum_ = 0;            ///< of the block that is not
  uint64_t size_ = 0;
};

/// Such a file, mapped read-only for the object's lifetime.
class BlockFile {
 public:
  /// Nothing for a file that is not there or cannot be read, that another user could have written, that has another
  /// format or is torn, and whose tables are damaged. The tables are checked, and nothing else is.
  static std::shared_ptr<const BlockFile> open(const std::string& path);
  ~BlockFile();
  BlockFile(const BlockFile&) = delete;
  BlockFile& operator=(const BlockFile&) = delete;

  std::span<const uint8_t> tables() const { return tables_; }

  /// The bytes [offset, offset + bytes), not checked. Nothing where the file does not have them.
  std::optional<std::span<const uint8_t>> bytes_at(uint64_t offset, uint64_t bytes) const;

  /// Checks the blocks of these bytes of the file, each once in the object's lifetime: Error(io) for a damaged one. May
  /// be called on any thread.
  void check(const void* first, size_t bytes) const {
    if (bytes == 0) return;
    const auto begin = size_t(static_cast<const uint8_t*>(first) - map_), end = begin + bytes - 1;
    for (size_t block = begin / kBlockBytes; block <= end / kBlockBytes; ++block)
      if ((checked_[block / 64].load(std::memory_order_acquire) >> (block % 64) & 1) == 0) check_block(block);
  }
  void check_all() const;

  /// Asks the system to read these bytes of the file soon.
  void fetch(const void* first, size_t bytes) const;

 private:
  BlockFile(std::string path, const uint8_t* map, size_t size);
  bool read_footer();
  bool is_intact(size_t block) const;
  void check_block(size_t block) const;

  std::string path_;
  const uint8_t* map_;
  size_t size_, content_ = 0;  ///< bytes in all; those that have checksums
  std::span<const uint8_t> tables_;
  const uint32_t* checksums_ = nullptr;
  mutable std::vector<std::atomic<uint64_t>> checked_;  ///< a bit a block
};

}  // namespace trueshade
