#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/image_files/streamed_file.h"

namespace trueshade {

/// How far a picture has come: what `PATH.progress` beside its first file says while the file grows.
struct ProgressNote {
  std::string identity;              ///< SHA-256 of all that may change a byte of the files
  int rows = 0;                      ///< done, from the top
  std::string hash;                  ///< ImageHash::progress() of the picture
  std::vector<std::string> planes;   ///< of each plane, or empty: a band came without its planes
  std::vector<StreamedState> files;  ///< of each file
  std::vector<uint64_t> counts;      ///< of FrameStats, see counts_of()
};

/// The note's text. Its last line is a checksum of the others.
std::string text_of(const ProgressNote& note);

/// Nothing for a text that is no note, or that is not whole.
std::optional<ProgressNote> note_of(const std::string& text);

/// The name of the note beside a file.
std::string note_name(const std::string& file);

}  // namespace trueshade
