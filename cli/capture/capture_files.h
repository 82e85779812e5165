#pragma once
#include <string>
#include <vector>

#include "cli/capture/capture_map.h"
#include "core/image_files/channel_file.h"

namespace trueshade {

/// One plane's channels, in the files that hold them.
struct PlaneChannelList {
  MappedPlane mapped;
  const ChannelFile* file;
  std::vector<const Channel*> channels;
};

/// The files of a capture, and what planes they hold. Planes point into the files.
struct CaptureFiles {
  std::vector<ChannelFile> files;
  std::vector<PlaneChannelList> planes;  ///< the picture as `color`, if there is one
  std::string name;                      ///< what errors call the capture: its first file

  CaptureFiles() = default;
  CaptureFiles(CaptureFiles&&) = default;
  CaptureFiles& operator=(CaptureFiles&&) = default;
  /// Pixels; there is at least one file.
  int width() const { return files.front().width; }
  /// Pixels; there is at least one file.
  int height() const { return files.front().height; }
};

/// Reads `gbuffer` and the files that the map names, and finds the channels of the planes: those of the map, or without
/// one all whose usual channels are there (docs/captures.md). `image`: the file of the picture, or empty.
/// Error(bad_input) for a channel that is missing, that has another type than the plane's others, or that is in two
/// files; for files of two sizes; and where there is no plane but the picture. Else it throws as read_channel_file().
///   most_expansion: as read_channel_file() has it
CaptureFiles read_capture_files(const std::vector<std::string>& gbuffer, const std::string& image,
                                const CaptureMap& map, uint64_t most_expansion);

/// Reads a picture alone: the channels R G B, and A if there is one, of a file. Error(bad_input) where it has fewer
/// than three of these. Else it throws as read_channel_file().
CaptureFiles read_picture_file(const std::string& path, uint64_t most_expansion);

}  // namespace trueshade
