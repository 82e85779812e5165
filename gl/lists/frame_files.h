#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "gl/lists/frame_list.h"

namespace trueshade::oracle {

/// A frame as files: members of a JSON object, without its braces, and the bytes of buffers and textures, which the
/// members name by their places in `file`.
struct FrameFiles {
  std::string members;
  std::vector<uint8_t> bytes;
};

/// The frame as files, with `file` the name of the file of bytes. Error(usage) where the API has no name for what the
/// scene needs.
FrameFiles frame_files(const FrameList& list, ShaderApi api, const std::string& file);

}  // namespace trueshade::oracle
