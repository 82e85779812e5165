#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace trueshade {

/// What the header of an EXR says of its size.
struct ExrLayout {
  int width = 0, height = 0;  ///< of the data window
  size_t pixel_bytes = 0;     ///< of all channels
};

/// Reads the header of an EXR before OpenEXR does, which takes each length in it for memory that it needs.
/// Error(bad_input) naming `where` and the byte: no EXR of version 2; a length beyond the file; several parts; deep
/// pixels; subsampled channels; an offset table beyond the file. Error(limit): over 65536 pixels a side or 1024
/// channels.
ExrLayout exr_layout(const std::string& where, std::span<const uint8_t> bytes);

}  // namespace trueshade
