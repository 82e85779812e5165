#pragma once
// Picture files that are written from the top down while the picture is drawn, so that neither the picture nor the file
// is ever in memory. image_io.h writes files of pictures that are.
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/image_files/image_io.h"

namespace trueshade {

/// Rows that a streamed file keeps together. All but the last of what is encoded at once holds a multiple of these.
inline constexpr int kStripRows = 64;

/// What is known of a picture before its first pixel is.
struct StreamedPicture {
  int width = 0, height = 0;  ///< pixels
  Format color = Format::rgba8;
  std::vector<std::pair<std::string, Format>> planes{};  ///< of an EXR
  Metadata metadata{};                                   ///< without the picture's hash, which comes last
  ImageFileOptions options{};
};

/// Rows of a picture as a file holds them. They depend on the rows alone, so they can be made in any order, anywhere.
struct EncodedRows {
  std::vector<std::vector<uint8_t>> pieces;  ///< in the file's order
  uint32_t checksum = 1;                     ///< PNG: Adler-32 of the rows before compression
  uint64_t bytes = 0;                        ///< of these
};

/// Encodes rows for a file of this name, as image_io.h says of values and codes:
///   PNG: the picture's hash stands behind the pixels, and a strip's first row refers to no row above it.
///   EXR: single part, tiles of 64 x 64 pixels from the top left, ZIP.
/// `first_row` is a multiple of kStripRows. On all threads that the options name. Error(usage) as write_image().
EncodedRows encoded_rows(const std::string& name, const StreamedPicture& picture, int first_row, const Image& color,
                         std::span<const NamedImage> planes);

/// How far a file has been written.
struct StreamedState {
  uint64_t end = 0;         ///< bytes that are in place
  uint64_t pieces = 0;      ///< EXR: tiles
  uint32_t checksum = 1;    ///< PNG: Adler-32 of the rows so far
  uint32_t pieces_crc = 0;  ///< CRC-32 of all pieces as the file holds them
  uint32_t table_crc = 0;   ///< EXR: CRC-32 of the offsets of these tiles
};

/// A file that grows as `PATH.part` beside its place, and takes its name when it is whole; or, for PNG alone, standard
/// output or another stream.
class StreamedFile {
 public:
  /// Begins the file, or goes on with one that was left in the state `from`; what was written after that is dropped.
  /// Error(io) where it cannot be, Error(usage) as write_image(), and for an EXR that is no file.
  StreamedFile(const std::string& path, const StreamedPicture& picture, const StreamedState* from = nullptr);
  ~StreamedFile();  ///< leaves PATH.part where it is
  StreamedFile(const StreamedFile&) = delete;
  StreamedFile& operator=(const StreamedFile&) = delete;

  void append(const EncodedRows& rows);  ///< the picture's next rows. Error(io).
  void sync();                           ///< puts what was appended on disk. Error(io).
  const StreamedState& state() const;
  void finish(
      const std::string& image_hash);  ///< 64 hex digits. The file is whole, on disk and under its name. Error(io).

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

/// The file that grows in the place of `path`; empty for a stream.
std::string part_name(const std::string& path);

/// Whether that file holds what the state says: so many bytes, and their sums. All that a StreamedFile does not write
/// anew counts. Error(io) where it cannot be read.
bool part_is_sound(const std::string& path, const StreamedPicture& picture, const StreamedState& state);

}  // namespace trueshade
