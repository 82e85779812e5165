#pragma once
#include <string>
#include <vector>

#include "cli/capture/capture_map.h"
#include "core/image_files/channel_file.h"

namespace trueshade {

/// The channels of one plane, and the file that they are in. Borrows both.
struct PlaneChannelList {
  MappedPlane mapped;
  const ChannelFile* file;
  std::vector<const Channel*> channels;
};

/// The files of a capture, and the planes found in them, which point into the files.
struct CaptureFiles {
  std::vector<ChannelFile> files;
  std::vector<PlaneChannelList> planes;  ///< the picture as `color`, if there is one
  std::string name;                      ///< what errors call the capture: its first file

  CaptureFiles() = default;
  CaptureFiles(CaptureFiles&&) = default;
  CaptureFiles& operator=(CaptureFiles&&) = default;
  /// The width in pixels of all files. There must be at least one.
  int width() const { return files.front().width; }
  /// The height in pixels of all files. There must be at least one.
  int height() const { return files.front().height; }
};

/// Reads the files of a capture and finds the channels of its planes: the planes that the map names or, if it names
/// none, every plane whose usual channels are there (docs/captures.md). Error(bad_input) for a channel that is missing,
/// that has another type than the plane's others, or that is in two files; for files of two sizes; and where there is
/// no plane but the picture. Else it throws as read_channel_file().
///   gbuffer: the files of the planes; those that only the map names are read too
///   image: the file of the picture, or empty
///   most_expansion: as read_channel_file() takes it
CaptureFiles read_capture_files(const std::vector<std::string>& gbuffer, const std::string& image,
                                const CaptureMap& map, uint64_t most_expansion);

/// Reads a picture alone: the channels R, G, B, and A if there is one. Error(bad_input) where fewer than three of these
/// are there. Else it throws as read_channel_file().
CaptureFiles read_picture_file(const std::string& path, uint64_t most_expansion);

}  // namespace trueshade
