#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/image_files/image_io.h"
#include "core/image_files/streamed_file.h"
#include "shading/frame.h"

namespace trueshade {

/// Whether files of the picture, or of the region of it that is drawn, are streamed: over 16,384 pixels a side or 2^26
/// pixels. This depends on the size alone, so that equal pictures are equal files whatever memory there is.
bool is_large(const Pipeline& pipeline, const PictureRegion& region);

/// A picture that is drawn some rows at a time.
struct LargePicture {
  const PreparedScene& scene;
  Pipeline pipeline;
  Execution execution;  ///< its region, or the whole picture, is what the files show
  std::vector<std::string> aovs;
  std::vector<std::string> files;  ///< .png and .exr; planes go into the latter
  Metadata metadata;               ///< of the files, without the picture's hash
  ImageFileOptions file_options;
  PictureConstants constants;  ///< of the picture, where has_constants()
  int rows = kStripRows;       ///< of a band; a multiple of kStripRows
  int rows_done = 0;           ///< that an earlier process has drawn; a multiple of kStripRows

  PictureRegion drawn() const { return drawn_region(pipeline, execution.region); }
  int bands() const { return (drawn().height - rows_done + rows - 1) / rows; }  ///< that are to be drawn
  int first_row(int band) const { return rows_done + band * rows; }             ///< of the files
  PictureRegion band(int index) const;  ///< the index-th from the top, in the picture's pixels
  Format color() const;                 ///< of the image: the target's, a view's, or that of the post chain
  std::vector<Format> planes() const;   ///< of the aovs
  StreamedPicture streamed(const std::string& file) const;
};

/// The rows of a band for which drawing and encoding stay within the memory cap, and that are worth the work that is
/// done once a band. Error(limit) where not even kStripRows do.
int band_rows(const LargePicture& picture);

}  // namespace trueshade
