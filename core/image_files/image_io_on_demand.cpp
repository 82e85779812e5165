// The reading of EXR and JPEG files for programs that load OpenImageIO only when they need it. The module is looked for
// beside the program, then where `cmake --install` puts it.
#include <dlfcn.h>

#include <filesystem>
#include <system_error>

#include "core/error.h"
#include "core/image_files/image_io_table.h"

namespace trueshade {
namespace {

std::filesystem::path program_folder() {
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
}

const ImageIoTable& loaded_table() {
  std::string reason = "it is not there";
  for (const char* folder : {".", "../lib/trueshade", "../" TRUESHADE_LIBDIR "/trueshade"}) {
    const std::filesystem::path path = program_folder() / folder / kImageIoModule;
    std::error_code absent;
    if (!std::filesystem::exists(path, absent)) continue;
    void* const module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    const auto table =
        module == nullptr ? nullptr : reinterpret_cast<ImageIoTableFunction>(dlsym(module, kImageIoTableSymbol));
    if (table != nullptr) return *table();
    reason = dlerror();
  }
  throw Error(ErrorKind::io, kImageIoModule, "cannot be loaded: " + reason,
              "install Trueshade whole, with OpenImageIO");
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

Image jpeg_pixels(const std::string& where, std::span<const uint8_t> bytes) {
  return table().jpeg_pixels(where, bytes);
}

}  // namespace trueshade
