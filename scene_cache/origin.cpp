#include "scene_cache/origin.h"

#include <link.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <filesystem>

namespace trueshade {

FileState file_state(const std::string& path) {
  FileState state{.path = path};
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) return state;
  constexpr int64_t kSecond = 1000000000;
  state.is_there = true;
  state.bytes = uint64_t(status.st_size);
  state.inode = status.st_ino;
  state.changed_ns = status.st_ctim.tv_sec * kSecond + status.st_ctim.tv_nsec;
  state.modified_ns = status.st_mtim.tv_sec * kSecond + status.st_mtim.tv_nsec;
  return state;
}

std::string absolute_spec(const std::string& spec) {
  return spec.starts_with("builtin:") ? spec : std::filesystem::absolute(spec).string();
}

std::vector<std::string> program_files() {
  std::vector<std::string> files;
  std::error_code none;
  files.push_back(std::filesystem::read_symlink("/proc/self/exe", none).string());
  const auto add = [](dl_phdr_info* library, size_t, void* list) {
    if (library->dlpi_name != nullptr && library->dlpi_name[0] == '/')
      static_cast<std::vector<std::string>*>(list)->emplace_back(library->dlpi_name);
    return 0;
  };
  dl_iterate_phdr(add, &files);
  return files;
}

bool is_unchanged(const SceneOrigin& origin) {
  const auto stands = [](const FileState& file) { return file_state(file.path) == file; };
  return std::all_of(origin.files.begin(), origin.files.end(), stands) &&
         std::all_of(origin.program.begin(), origin.program.end(), stands);
}

bool within(const SceneLimits& limits, const SceneLimits& other) {
  const auto numbers = [](const SceneLimits& of) {
    const auto& [lights, instances, file, json, texture, buffer, geometry, nodes, depth, expansion, leniency, paths] =
        of;
    return std::array{lights, instances, file, json, texture, buffer, geometry, nodes, depth, expansion};
  };
  const auto a = numbers(limits), b = numbers(other);
  for (size_t i = 0; i < a.size(); ++i)
    if (a[i] > b[i]) return false;
  return true;
}

}  // namespace trueshade
