#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace trueshade {

/// CRC-32 (ISO 3309) of bytes behind others whose CRC-32 is `before`.
uint32_t crc_of(std::span<const uint8_t> bytes, uint32_t before = 0);

/// A file that is written over a long time. It grows as `PATH.part`, stays there if the process ends, and takes the
/// place of PATH when it is finished; PATH is never a part of a file. Of a device or a pipe (`-` is standard output)
/// the bytes go into it as they come, from the first to the last.
class GrowingFile {
 public:
  /// Creates the part, or opens the one that is there. One process at a time holds it. Error(io).
  GrowingFile(const std::string& path, bool goes_on);
  ~GrowingFile();
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;

  bool is_stream() const { return stream_; }
  void put(uint64_t at, std::span<const uint8_t> bytes);  ///< Error(io)
  void cut(uint64_t size);  ///< drops what lies behind. Error(io), also where the part is shorter.
  std::optional<uint32_t> crc(uint64_t from, uint64_t end) const;  ///< of its bytes; nothing where it is shorter
  void sync();                                                     ///< Error(io)
  void finish();            ///< on disk, under its name. Error(io)

 private:
  std::string path_, part_;
  uint64_t end_ = 0;  // of a stream
  int descriptor_ = -1;
  bool stream_ = false;
};

}  // namespace trueshade
