#pragma once
#include <array>
#include <cstdint>
#include <mutex>
#include <string>
#include <unordered_map>

#include "cli/batch/job_result.h"

namespace trueshade::batch {

/// Hashes of files as they are now. A file that many jobs read is hashed again only where its size or its times have
/// changed. Any thread may ask.
class FileHashes {
 public:
  /// SHA-256 of a regular file's bytes; kAbsent where it is none, or cannot be read.
  std::string of_file(const std::string& path);

  /// Whether all that a job read and wrote is as it was. Paths are those of `folder`.
  bool are_those_of(const JobResult& result, const std::string& folder);

 private:
  struct Known {
    std::array<int64_t, 7> stamp;  // device, file, size, times
    std::string hash;
  };
  bool is_as_noted(const FileNote& note, const std::string& path);

  std::mutex mutex_;
  std::unordered_map<std::string, Known> known_;
};

}  // namespace trueshade::batch
