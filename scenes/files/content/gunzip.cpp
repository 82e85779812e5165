#include <zlib.h>

#include <algorithm>
#include <climits>
#include <new>
#include <span>

#include "core/error.h"
#include "core/memory_cap.h"
#include "scenes/files/content/scene_files.h"

namespace trueshade {
namespace {

/// The content of a .gz file, given out piece by piece.
class Inflater {
 public:
  Inflater(std::span<const uint8_t> compressed, const SceneLimits& limits, std::string_view where)
      : compressed_(compressed), limits_(limits), where_(where) {
    if (inflateInit2(&stream_, 16 + MAX_WBITS) != Z_OK) throw std::bad_alloc();  // reads gzip headers
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  /// Asks `room(written)` for where the next bytes go, until all is written. Returns how much that is.
  template <typename Room>
  uint64_t run(Room room) {
    size_t read = 0;
    uint64_t written = 0;
    for (bool ended = false; !ended;) {
      const std::span<uint8_t> out = room(written);
      stream_.next_in = const_cast<Bytef*>(compressed_.data() + read);  // zlib's type; it does not write there
      stream_.avail_in = uInt(std::min<size_t>(compressed_.size() - read, INT_MAX));
      stream_.next_out = out.data();
      stream_.avail_out = uInt(std::min<size_t>(out.size(), INT_MAX));
      const size_t in = stream_.avail_in, space = stream_.avail_out;
      const int code = inflate(&stream_, Z_NO_FLUSH);
      read += in - stream_.avail_in;
      written += space - stream_.avail_out;
      check_size(written);
      if (code == Z_STREAM_END) {
        ended = read == compressed_.size();
        inflateReset(&stream_);  // another member may follow
      } else if (code != Z_OK && !(code == Z_BUF_ERROR && read < compressed_.size())) {
        const bool short_of_data = code == Z_BUF_ERROR || read == compressed_.size();
        throw Error(ErrorKind::bad_input, std::string(where_) + ": byte " + std::to_string(read),
                    short_of_data ? "the gzip stream ends early" : "the gzip stream is broken", "a whole .gz file");
      }
    }
    return written;
  }

  void check_size(uint64_t content) const {
    if (content > limits_.file_bytes)
      throw Error(ErrorKind::limit, where_, "the content is over the limit",
                  within_limit(limits_.file_bytes, "bytes", "--max-file"));
    if (is_expanded(content, compressed_.size(), limits_.expansion))
      throw Error(ErrorKind::limit, where_,
                  std::to_string(compressed_.size()) + " bytes hold " + std::to_string(content) + " or more",
                  within_limit(limits_.expansion, "times as many", "--max-expansion"));
  }

 private:
  std::span<const uint8_t> compressed_;
  const SceneLimits& limits_;
  std::string_view where_;
  z_stream stream_{};
};

/// What the last member says of its size, modulo 2^32 (RFC 1952, section 2.3.1). Nobody has checked it.
uint64_t claimed_size(std::span<const uint8_t> compressed) {
  uint64_t size = 0;
  for (size_t i = 0; i < 4 && compressed.size() >= 4; ++i)
    size |= uint64_t(compressed[compressed.size() - 4 + i]) << (8 * i);
  return size;
}

/// Throws what unpacking throws, and takes no memory.
void check_whole(std::span<const uint8_t> compressed, const SceneLimits& limits, std::string_view where) {
  Bytes piece(size_t(1) << 16);
  Inflater(compressed, limits, where).run([&piece](uint64_t) { return std::span(piece); });
}

}  // namespace

Bytes gunzipped(std::span<const uint8_t> compressed, const SceneLimits& limits, std::string_view where) {
  constexpr uint64_t kMuch = uint64_t(64) << 20;
  if (claimed_size(compressed) > std::min(kMuch, limits.file_bytes)) check_whole(compressed, limits, where);
  Bytes out;
  const uint64_t size = Inflater(compressed, limits, where).run([&](uint64_t written) {
    if (written == out.size()) {  // the buffer doubles as data really comes
      const auto room = std::min<uint64_t>(std::max<uint64_t>(2 * written, 1 << 16), limits.file_bytes + 1);
      require_memory(room, where, "its content");
      out.resize(size_t{room});
    }
    return std::span(out).subspan(size_t(written));
  });
  out.resize(size_t{size});
  return out;
}

}  // namespace trueshade
