#pragma once
#include <sys/stat.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace trueshade {

/// Error(io) of a step that failed with this errno, and what to do about it.
[[noreturn]] void fail_to_write(const std::string& path, const char* step, int error);

std::string folder_of(const std::string& path);  ///< of the file; `.` where the path names none

/// What a path that may be written stands for.
struct Destination {
  bool stream;                   ///< a device or a pipe: bytes go into it, and nothing takes its place
  std::string path;              ///< with no link at its end
  std::optional<mode_t> mode{};  ///< permissions of the file that is there
};

/// Error(io) for what is neither a file, nor a stream, nor a name that a file could have.
Destination destination_of(const std::string& path);

/// All of the bytes, to where the descriptor stands. Error(io) naming `path`.
void write_bytes(int descriptor, const std::string& path, std::span<const uint8_t> bytes);

/// Gives the file at `from`, whose bytes are written, the name `to`, and puts both on disk. Error(io).
void move_to_place(int descriptor, const std::string& from, const std::string& to);

}  // namespace trueshade
