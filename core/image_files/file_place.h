#pragma once
#include <sys/stat.h>

#include <optional>
#include <string>

namespace trueshade {

/// What a path that may be written stands for.
struct Destination {
  bool stream;                   ///< a device, or a pipe that is open: bytes go into it, and nothing takes its place
  std::string path;              ///< with no link at its end
  std::optional<mode_t> mode{};  ///< permissions of the file that is there
};

/// Error(io) for what is neither a file, nor a stream, nor a name that a file could have.
Destination destination_of(const std::string& path);

}  // namespace trueshade
