// Academy Software Foundation, "The OpenEXR File Layout" and "Technical Introduction to OpenEXR".
#include "core/image_files/exr_file.h"

#include <algorithm>
#include <atomic>

#include "core/error.h"
#include "core/image_files/exr_block.h"
#include "core/image_files/exr_header.h"
#include "core/image_files/exr_rows.h"
#include "core/image_files/file_budget.h"
#include "core/threads/parallel_for.h"

namespace trueshade {
namespace {

constexpr int kRowsOfBlock = 16;  // rows that ZIP compresses together

/// Where each block begins in the file.
std::vector<uint8_t> offset_table(size_t header_bytes, std::span<const std::vector<uint8_t>> blocks) {
  std::vector<uint8_t> table;
  uint64_t at = header_bytes + 8 * blocks.size();
  for (const std::vector<uint8_t>& block : blocks) {
    for (int shift = 0; shift < 64; shift += 8) table.push_back(uint8_t(at >> shift));
    at += block.size();
  }
  return table;
}

ExrPicture picture_of(const Image& color, std::span<const ExrChannel> channels) {
  ExrPicture picture{color.width, color.height, color.format, {}};
  for (const ExrChannel& channel : channels) picture.channels.emplace_back(channel.name, channel.type);
  return picture;
}

}  // namespace

std::vector<std::vector<uint8_t>> exr_file(const std::string& where, const Image& color,
                                           std::span<const NamedImage> aovs, const Metadata& metadata,
                                           const ImageFileOptions& options) {
  if (color.width < 1 || color.height < 1)
    throw Error(ErrorKind::usage, where, "an EXR has pixels", "write another image");
  const std::vector<ExrChannel> channels = exr_channels(where, color, aovs);
  const int blocks = (color.height + kRowsOfBlock - 1) / kRowsOfBlock;
  std::vector<std::vector<uint8_t>> pieces(2 + size_t(blocks));
  pieces[0] = exr_header_bytes(where, picture_of(color, channels), metadata, options);
  FileBudget budget(where);
  std::atomic<int> next{0};
  const int writers = std::min(thread_count(options.threads), blocks);
  parallel_for(writers, writers, [&](int) {
    ExrBlockWriter writer(channels, kRowsOfBlock);
    for (int i = next++; i < blocks; i = next++) {
      const uint32_t first = uint32_t(i * kRowsOfBlock);
      pieces[2 + size_t(i)] = writer.block({&first, 1}, int(first), std::min(int(first) + kRowsOfBlock, color.height));
      budget.take(pieces[2 + size_t(i)].size());
    }
  });
  pieces[1] = offset_table(pieces[0].size(), std::span(pieces).subspan(2));
  return pieces;
}

}  // namespace trueshade
