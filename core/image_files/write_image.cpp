#include "core/error.h"
#include "core/file_ending.h"
#include "core/fp_env.h"
#include "core/image_files/exr_file.h"
#include "core/image_files/image_io.h"
#include "core/image_files/png_file.h"

namespace trueshade {

std::vector<std::vector<uint8_t>> encoded_image(const std::string& name, const Image& color,
                                                std::span<const NamedImage> aovs, const Metadata& metadata,
                                                const ImageFileOptions& options) {
  const FpScope ieee;
  if (has_ending(name, ".png")) return png_file(name, color, metadata, options);
  if (has_ending(name, ".exr")) return exr_file(name, color, aovs, metadata, options);
  throw Error(ErrorKind::usage, name, "no image format has this ending", "end the name in .png or .exr");
}

void write_image(const std::string& path, const Image& color, std::span<const NamedImage> aovs,
                 const Metadata& metadata, const ImageFileOptions& options) {
  const std::vector<std::vector<uint8_t>> pieces = encoded_image(path, color, aovs, metadata, options);
  write_file(path, FilePieces(pieces.begin(), pieces.end()));
}

std::vector<uint8_t> encode_png(const Image& color, const Metadata& metadata, const ImageFileOptions& options) {
  const FpScope ieee;
  std::vector<uint8_t> file;
  for (const std::vector<uint8_t>& piece : png_file("PNG", color, metadata, options))
    file.insert(file.end(), piece.begin(), piece.end());
  return file;
}

}  // namespace trueshade
