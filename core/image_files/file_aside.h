#pragma once
#include <sys/types.h>

#include <cstdint>
#include <span>
#include <string>

namespace trueshade {

/// A file in the making, in the folder of `path`, without a name where the file system can do that, so that not even a
/// killed process leaves it behind; else under a name of its own. It takes the name of `path` when it is whole; until
/// then what had that name stays. Removed on destruction unless it took the name. Every function throws Error(io).
class FileAside {
 public:
  explicit FileAside(const std::string& path);
  ~FileAside();
  FileAside(const FileAside&) = delete;
  FileAside& operator=(const FileAside&) = delete;

  void write(std::span<const uint8_t> bytes);
  void take_mode(mode_t mode);  ///< permissions, where the system allows
  void take_name();             ///< on disk under the final name: a crash leaves the old file or the new one

 private:
  void give_name();
  std::string path_, name_;
  int descriptor_ = -1;
};

/// Brings the content of an open file to disk. Error(io) naming `path`.
void put_on_disk(int descriptor, const std::string& path);

/// Gives the file at `from`, whose content is on disk, the name `to`: a crash leaves the file that was there or this one.
/// Error(io).
void take_place(const std::string& from, const std::string& to);

/// Writes all of the bytes. `path` stands in errors.
void write_bytes(int descriptor, const std::string& path, std::span<const uint8_t> bytes);

/// Throws Error(io): `PATH: cannot STEP: REASON` for an errno, with what helps.
[[noreturn]] void fail_to(const std::string& path, const char* step, int error);

/// The folder that a path is in; `.` where it names none.
std::string folder_of_path(const std::string& path);

}  // namespace trueshade
