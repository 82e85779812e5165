#pragma once
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "bands/drawn_band.h"
#include "bands/large_picture.h"
#include "bands/progress_note.h"
#include "core/image_hash.h"

namespace trueshade {

/// Whether a picture goes on where an earlier process has stopped.
enum class Resume : uint8_t {
  no,
  yes,
  with_plane_hashes,  ///< only where that process has kept the hashes of planes, so that finish() has them
};

/// Takes the bands of a picture from the top down: its hash, its counts, its files. Beside the first file stays a note
/// (progress_note.h) of how far the files on disk have come, renewed every second; it goes when the files are
/// whole.
class PictureWriter {
 public:
  /// `identity`: all that may change a byte of the files, as text. Unless Resume::no is given, the picture goes
  /// on after rows_done(), if there is a note of the same identity. Error(io); Error(usage) as StreamedFile.
  PictureWriter(const LargePicture& picture, const std::string& identity, Resume resume,
                std::chrono::seconds between_notes = std::chrono::seconds(1));
  ~PictureWriter();  ///< leaves parts and note, so that the picture can be gone on with

  int rows_done() const { return rows_done_; }  ///< from the top
  /// Why the picture begins anew although there is a note, as the end of a sentence; else empty.
  const std::string& why_anew() const { return why_anew_; }
  void take(const DrawnBand& band);  ///< Error(io)

  /// What is known once all bands are taken.
  struct Finished {
    std::string hash;                       ///< of the picture, 64 hex digits
    std::vector<std::string> plane_hashes;  ///< empty where a band came without planes
    FrameStats counts;
  };
  Finished finish();  ///< Error(io)

 private:
  bool go_on(Resume resume);
  std::string take_over(const ProgressNote& note, Resume resume);
  void keep_note();

  const LargePicture& picture_;
  std::string note_path_, identity_, why_anew_;  // the path is empty where no file can be gone on with
  std::vector<std::unique_ptr<StreamedFile>> files_;
  ImageHash hash_;
  std::vector<ImageHash> plane_hashes_;
  FrameStats counts_;
  int rows_done_ = 0;
  const std::chrono::seconds between_notes_;
  std::chrono::steady_clock::time_point noted_;
};

}  // namespace trueshade
