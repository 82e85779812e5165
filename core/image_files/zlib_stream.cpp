#include "core/image_files/zlib_stream.h"

#include <libdeflate.h>

#include <memory>
#include <new>

namespace trueshade {

std::vector<uint8_t> zlib_stream(std::span<const uint8_t> bytes) {
  constexpr int kLevel = 6;  // of 12; level 9 makes planes of city 1 % smaller in twice the time
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(kLevel), libdeflate_free_compressor);
  if (!compressor) throw std::bad_alloc();
  std::vector<uint8_t> stream(libdeflate_zlib_compress_bound(compressor.get(), bytes.size()));
  stream.resize(libdeflate_zlib_compress(compressor.get(), bytes.data(), bytes.size(), stream.data(), stream.size()));
  return stream;
}

}  // namespace trueshade
