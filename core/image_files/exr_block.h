#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/image_files/deflate.h"
#include "core/image_files/exr_rows.h"

namespace trueshade {

/// Compresses rows of a picture and its planes as an EXR stores them: ZIP (Academy Software Foundation, "Technical
/// Introduction to OpenEXR"). Each writer keeps its own buffers; one thread at a time uses a writer.
class ExrBlockWriter {
 public:
  ExrBlockWriter(std::span<const ExrChannel> channels, int most_rows);
  ~ExrBlockWriter();
  ExrBlockWriter(const ExrBlockWriter&) = delete;
  ExrBlockWriter& operator=(const ExrBlockWriter&) = delete;

  /// Rows [first, end), stored as they are where compression does not help. `place` is where the block lies: the words
  /// that stand before its size.
  std::vector<uint8_t> block(std::span<const uint32_t> place, int first, int end);

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace trueshade
