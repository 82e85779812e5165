#include <dlfcn.h>

#include <glm/detail/setup.hpp>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "cli/json_text.h"
#include "cli/libraries.h"
#include "cli/option_values.h"
#include "cli/version.h"
#include "shading/frame.h"

namespace trueshade {
namespace {

using NamedVersions = std::vector<std::pair<std::string, std::string>>;

/// What this program was built with; a library that is absent is left out.
NamedVersions libraries() {
  const std::string glm = std::to_string(GLM_VERSION_MAJOR) + '.' + std::to_string(GLM_VERSION_MINOR) + '.' +
                          std::to_string(GLM_VERSION_PATCH) + '.' + std::to_string(GLM_VERSION_REVISION);
  NamedVersions known;
  for (const auto& [name, version] : NamedVersions{{"OpenImageIO", kOpenImageIoVersion},
                                                   {"oneTBB", kTbbVersion},
                                                   {"Embree", kEmbreeVersion},
                                                   {"GLM", glm},
                                                   {"Highway", kHighwayVersion},
                                                   {"libdeflate", kDeflateVersion},
                                                   {"zlib", kZlibVersion},
                                                   {"meshoptimizer", kMeshoptimizerVersion},
                                                   {"libepoxy", kEpoxyVersion}})
    if (!version.empty()) known.emplace_back(name, version);
  return known;
}

/// Libraries that a driver is opened by, as the loader of this machine finds them now.
std::vector<std::pair<std::string, bool>> driver_libraries() {
  std::vector<std::pair<std::string, bool>> found;
  for (const auto& [name, file] :
       {std::pair{"EGL", "libEGL.so.1"}, {"Mesa", "libEGL_mesa.so.0"}, {"Vulkan", "libvulkan.so.1"}}) {
    void* library = dlopen(file, RTLD_LAZY | RTLD_LOCAL);
    found.emplace_back(name, library != nullptr);
    if (library != nullptr) dlclose(library);
  }
  return found;
}

std::string version_json() {
  JsonArray built, runs;
  for (const std::string_view name : built_simd_targets()) built.add_raw(json_string(name));
  for (const std::string_view name : simd_targets()) runs.add_raw(json_string(name));
  JsonObject versions, drivers;
  for (const auto& [name, version] : libraries()) versions.put(name, version);
  for (const auto& [name, is_there] : driver_libraries()) drivers.put(name, is_there);
  const JsonObject simd = JsonObject()
                              .put_raw("built", built.text())
                              .put_raw("runs_here", runs.text())
                              .put("chosen", simd_targets().front());
  return JsonObject()
             .put("version", kVersion)
             .put("commit", kCommit)
             .put_raw("simd", simd.text())
             .put_raw("libraries", versions.text())
             .put_raw("driver_libraries", drivers.text())
             .text() +
         '\n';
}

std::string version_text() {
  std::string text = std::string("trueshade ") + kVersion + "\ncommit      " + kCommit + "\nSIMD        built for " +
                     joined(built_simd_targets()) + "; chosen here: " + std::string(simd_targets().front()) +
                     "\nbuilt with ";
  std::string between = " ";
  for (const auto& [name, version] : libraries()) text += std::exchange(between, ", ") + name + ' ' + version;
  text += "\ndrivers     ";
  between = "";
  for (const auto& [name, is_there] : driver_libraries())
    text += std::exchange(between, ", ") + name + (is_there ? " is there" : " is absent");
  return text + '\n';
}

}  // namespace

void print_version(const VersionOptions& options) { print(options.json ? version_json() : version_text()); }

}  // namespace trueshade
