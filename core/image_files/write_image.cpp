#include "core/error.h"
#include "core/file_ending.h"
#include "core/fp_env.h"
#include "core/image_files/exr_file.h"
#include "core/image_files/image_io.h"
#include "core/image_files/png_file.h"

namespace trueshade {

void write_image(const std::string& path, const Image& color, std::span<const NamedImage> aovs,
                 const Metadata& metadata, const ImageFileOptions& options) {
  const FpScope ieee;
  std::vector<std::vector<uint8_t>> pieces;
  if (has_ending(path, ".png"))
    pieces = png_file(path, color, metadata, options);
  else if (has_ending(path, ".exr"))
    pieces = exr_file(path, color, aovs, metadata, options);
  else
    throw Error(ErrorKind::usage, path, "no image format has this ending", "end the name in .png or .exr");
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
