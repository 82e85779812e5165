#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace trueshade {

/// The size of an EXR image as the header of the file states it.
struct ExrLayout {
  int width = 0, height = 0;  ///< of the data window
  size_t pixel_bytes = 0;     ///< bytes of a pixel, all channels together
};

/// Reads the header of an EXR and checks its lengths. OpenEXR, which reads the header after that, allocates as much
/// memory as a length says before it finds that the file is shorter.
/// Error(bad_input) naming `where` and the byte: no EXR of version 2; a length beyond the file; several parts; deep
/// pixels; subsampled channels; an offset table beyond the file. Error(limit): over 65536 pixels a side or 1024
/// channels.
ExrLayout exr_layout(const std::string& where, std::span<const uint8_t> bytes);

/// The same of each part of an EXR that may have several, at most 64.
std::vector<ExrLayout> exr_part_layouts(const std::string& where, std::span<const uint8_t> bytes);

}  // namespace trueshade
