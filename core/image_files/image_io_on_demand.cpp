// The reading of EXR and JPEG files for programs that load OpenImageIO only when they need it. The module is looked for
// beside the program or the shared library that this code is linked into, then in the folder image_io there, where a
// wheel has one for another release of OpenImageIO, then where `cmake --install` puts it.
#include <dlfcn.h>
#include <link.h>
#include <sys/mman.h>

#include <filesystem>
#include <system_error>

#include "core/error.h"
#include "core/image_files/image_io_table.h"
#include "core/threads/startable_threads.h"

namespace trueshade {
namespace {

/// The folder of what holds this code: of a shared library, as Python loads one, or else of the program.
std::filesystem::path own_folder() {
  std::error_code error;
  Dl_info symbol;
  void* loaded = nullptr;
  const auto here = reinterpret_cast<void*>(&own_folder);
  if (dladdr1(here, &symbol, &loaded, RTLD_DL_LINKMAP) != 0 && loaded != nullptr) {
    const std::string name = static_cast<const link_map*>(loaded)->l_name;  // empty for the program itself
    if (!name.empty()) return std::filesystem::canonical(name, error).parent_path();
  }
  return std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
}

Error out_of_memory(const char* where, const char* reason, const char* remedy) {
  return {ErrorKind::out_of_memory, where, reason, remedy};
}

/// Whether the process may have as much address space as loading takes.
bool has_address_space() {
  constexpr size_t kBytes = size_t(320) << 20;
  void* const probe = mmap(nullptr, kBytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (probe == MAP_FAILED) return false;
  munmap(probe, kBytes);
  return true;
}

const ImageIoTable& loaded_table() {
  require_threads_of_library("OpenImageIO, which reads this picture,");
  if (!has_address_space())
    throw out_of_memory("memory", "there is not enough to load OpenImageIO", "raise the limit on it (ulimit -v)");
  std::string reason = "it is not there";
  for (const char* folder : {".", "image_io", "../lib/trueshade", "../" TRUESHADE_LIBDIR "/trueshade"}) {
    const std::filesystem::path path = own_folder() / folder / kImageIoModule;
    std::error_code absent;
    if (!std::filesystem::exists(path, absent)) continue;
    void* const module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    const auto table =
        module == nullptr ? nullptr : reinterpret_cast<ImageIoTableFunction>(dlsym(module, kImageIoTableSymbol));
    if (table != nullptr) return *table();
    reason = dlerror();
    if (reason.find("failed to map") != std::string::npos || reason.find("cannot allocate") != std::string::npos)
      throw out_of_memory("memory", "there is not enough to load OpenImageIO", "raise the limit on it (ulimit -v)");
  }
  throw Error(ErrorKind::io, kImageIoModule, "cannot be loaded: " + reason,
              "it reads EXR and JPEG: install the package trueshade-image-io, or build with OpenImageIO");
}

const ImageIoTable& table() {
  static const ImageIoTable& loaded = loaded_table();
  return loaded;
}

}  // namespace

ImageFileInfo exr_header(const std::string& path, std::span<const uint8_t> bytes) {
  return table().exr_header(path, bytes);
}

std::vector<NamedImage> exr_planes(const std::string& path, std::span<const uint8_t> bytes) {
  return table().exr_planes(path, bytes);
}

std::vector<ChannelFile> exr_part_channels(const std::string& path, std::span<const uint8_t> bytes) {
  return table().exr_part_channels(path, bytes);
}

Image jpeg_pixels(const std::string& where, std::span<const uint8_t> bytes) {
  return table().jpeg_pixels(where, bytes);
}

}  // namespace trueshade
