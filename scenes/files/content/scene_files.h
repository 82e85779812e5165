#pragma once
#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/scene_limits.h"

// Files a scene is made of. A scene file comes from anywhere; what it names may lie in its own folder only, unless the
// user trusts it.
namespace trueshade {

using Bytes = std::vector<uint8_t>;

/// What the remedy says where the folder of a scene ends, and the user may let it name files anywhere.
inline constexpr std::string_view kTrustRemedy = "--trust-paths where you trust the file";

/// Whole content of the regular file at `path`, which the user gave. Never waits for a pipe or device.
/// Error(io) if it cannot be read, Error(bad_input) if it is no regular file, Error(limit) over `limit` bytes, which
/// `option` sets, if any does, or over the memory cap.
Bytes read_user_file(const std::string& path, uint64_t limit, std::string_view option = "--max-file");

/// Path that a URI in a scene file stands for, from the file's folder: percent-decoded. Error(bad_input) behind `where`
/// for a scheme, a backslash, NUL or other control character, or a bad escape; and unless any path may be named, for an
/// absolute one, or more `..` than folders before it.
std::string path_from_uri(std::string_view uri, std::string_view where, NamedPaths paths = NamedPaths::inside);

/// A path that is seen from a folder, of which `folder_path` ends in a slash or is empty.
std::string path_below(const std::string& folder_path, const std::string& path);

/// The folder of a scene file, held open: what is read lies beneath it, symbolic links followed, unless any path may be
/// named.
class SceneFolder {
 public:
  explicit SceneFolder(const std::string& scene_path, NamedPaths paths = NamedPaths::inside);
  ~SceneFolder();
  SceneFolder(const SceneFolder&) = delete;
  SceneFolder& operator=(const SceneFolder&) = delete;

  /// As read_user_file(), of a path (from path_from_uri) as it is seen from the folder; also Error(bad_input) if a link
  /// leads out. `portable`: by resolved names instead of openat2(2), as on kernels before 5.6.
  Bytes read(const std::string& path, uint64_t limit, std::string_view where, bool portable = false) const;

  /// Throws what read() would throw, without reading the content.
  void check(const std::string& path, uint64_t limit, std::string_view where) const;

 private:
  int open_named(const std::string& path, bool portable) const;
  int open_beneath(const std::string& relative, bool portable) const;
  std::string path_of(const std::string& path) const { return path_below(name_ + "/", path); }
  std::string name_;
  NamedPaths paths_;
  int folder_ = -1;
};

/// For its lifetime notes the paths that read_user_file() and SceneFolder open, or fail to, on any thread.
class FilesRead {
 public:
  FilesRead();
  ~FilesRead();
  FilesRead(const FilesRead&) = delete;
  FilesRead& operator=(const FilesRead&) = delete;
  std::vector<std::string> paths() const;  ///< sorted, each once

  /// Notes a path that was read when the file was made that is read instead.
  static void note(const std::string& path);

 private:
  std::set<std::string> paths_;
};

/// Content of a .gz file, all its members. Error(bad_input) for a broken stream; Error(limit) over limits.file_bytes,
/// over limits.expansion, over the memory cap.
Bytes gunzipped(std::span<const uint8_t> compressed, const SceneLimits& limits, std::string_view where);

}  // namespace trueshade
