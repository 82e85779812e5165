#include "core/image_files/deflate.h"

#include <libdeflate.h>

#include <new>

namespace trueshade {
namespace {

constexpr int kLevel = 1;

}  // namespace

Deflater::Deflater() : compressor_(libdeflate_alloc_compressor(kLevel)) {
  if (compressor_ == nullptr) throw std::bad_alloc();
}

Deflater::~Deflater() { libdeflate_free_compressor(compressor_); }

size_t Deflater::compress(std::span<const uint8_t> in, std::span<uint8_t> out) {
  return libdeflate_zlib_compress(compressor_, in.data(), in.size(), out.data(), out.size());
}

size_t Deflater::most(size_t bytes) { return libdeflate_zlib_compress_bound(nullptr, bytes); }

}  // namespace trueshade
