// core/image_files/image_io.h for programs that load OpenImageIO only when they need it: the module is looked for beside the
// program, then where `cmake --install` puts it.
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

void write_image(const std::string& path, const Image& color, std::span<const NamedImage> aovs,
                 const Metadata& metadata) {
  table().write_image(path, color, aovs, metadata);
}

std::vector<uint8_t> encode_png(const Image& color, const Metadata& metadata) {
  return table().encode_png(color, metadata);
}

Image decode_image(std::span<const uint8_t> content, const std::string& where, uint64_t most_bytes) {
  return table().decode_image(content, where, most_bytes);
}

ImageFileInfo read_image_info(const std::string& path) { return table().read_image_info(path); }

std::vector<NamedImage> read_planes(const std::string& path) { return table().read_planes(path); }

}  // namespace trueshade
