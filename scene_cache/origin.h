#pragma once
#include <string>
#include <vector>

#include "scenes/scene_limits.h"

namespace trueshade {

/// A file as it was when a scene was made of it. A change of its content changes one of these.
struct FileState {
  std::string path;  ///< absolute
  bool is_there = false;
  uint64_t bytes = 0, inode = 0;
  int64_t changed_ns = 0, modified_ns = 0;  ///< ctime and mtime: nanoseconds since 1970

  bool operator==(const FileState&) const = default;
};

FileState file_state(const std::string& path);

/// What a scene was made of.
struct SceneOrigin {
  std::string spec;                ///< absolute, if it names a file
  SceneLimits limits;              ///< which it kept
  std::vector<FileState> files;    ///< all that were read, or looked for
  std::vector<FileState> program;  ///< the program's file and those of its libraries
};

/// Of a scene file's name or `builtin:...`: the same for the same file from every folder.
std::string absolute_spec(const std::string& spec);

/// The program's file and those of the libraries that it has loaded.
std::vector<std::string> program_files();

/// Whether none of its files has changed since.
bool is_unchanged(const SceneOrigin& origin);

/// Whether no limit is above the one of `other`. How a scene is read beside these is in SceneOrigin::spec.
bool within(const SceneLimits& limits, const SceneLimits& other);

}  // namespace trueshade
