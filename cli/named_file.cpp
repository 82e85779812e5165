#include "cli/named_file.h"

#include <cstdint>
#include <filesystem>
#include <system_error>

#include "core/error.h"
#include "scenes/files/content/scene_files.h"

namespace trueshade {
namespace {

namespace fs = std::filesystem;

/// A name as a path from a folder; empty for one that leads out of it.
fs::path path_beneath(const fs::path& folder, const fs::path& name) {
  std::error_code unknown;
  const fs::path path = (name.is_absolute() ? name.lexically_relative(fs::absolute(folder, unknown)) : name);
  const fs::path normal = path.lexically_normal();
  return normal.empty() || *normal.begin() == ".." ? fs::path() : normal;
}

/// Whether the path leads to a regular file without leaving the folder.
bool is_file_beneath(const fs::path& folder, const fs::path& path) try {
  SceneFolder((folder / "x").string()).check(path.string(), UINT64_MAX, "");
  return true;
} catch (const Error&) {
  return false;
}

}  // namespace

std::optional<std::string> file_named_by(const std::string& picture, const std::string& name) {
  const fs::path here = ".", beside = fs::path(picture).parent_path() / ".";
  const std::pair<fs::path, fs::path> places[] = {
      {here, path_beneath(here, name)}, {beside, path_beneath(beside, name)}, {beside, fs::path(name).filename()}};
  for (const auto& [folder, path] : places)
    if (!path.empty() && is_file_beneath(folder, path)) return (folder / path).lexically_normal().string();
  return std::nullopt;
}

}  // namespace trueshade
