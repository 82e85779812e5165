#include <zlib.h>

#include <algorithm>
#include <climits>

#include "core/error.h"
#include "scenes/files/scene_files.h"

namespace trueshade {
namespace {

/// A zlib stream that reads gzip headers.
class Inflater {
 public:
  explicit Inflater(std::string_view where) : where_(where) {
    if (inflateInit2(&stream_, 16 + MAX_WBITS) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  Bytes all(const Bytes& compressed, uint64_t limit) {
    Bytes out;
    size_t read = 0, written = 0;
    for (;;) {
      if (written == out.size()) {
        // The size a gzip file claims is not trusted; the buffer doubles as data really comes.
        if (written > limit)
          throw Error(ErrorKind::limit, where_, "the content is over the limit",
                      "at most " + std::to_string(limit) + " bytes");
        out.resize(size_t(std::min<uint64_t>(std::max<uint64_t>(2 * written, 1 << 16), limit + 1)));
      }
      stream_.next_in = const_cast<Bytef*>(compressed.data() + read);  // zlib's type; it does not write there
      stream_.avail_in = uInt(std::min<size_t>(compressed.size() - read, INT_MAX));
      stream_.next_out = out.data() + written;
      stream_.avail_out = uInt(std::min<size_t>(out.size() - written, INT_MAX));
      const size_t in = stream_.avail_in, room = stream_.avail_out;
      const int code = inflate(&stream_, Z_NO_FLUSH);
      read += in - stream_.avail_in;
      written += room - stream_.avail_out;
      if (code == Z_STREAM_END) {
        if (read == compressed.size()) break;
        inflateReset(&stream_);  // another member follows
      } else if (code != Z_OK && !(code == Z_BUF_ERROR && read < compressed.size())) {
        const bool short_of_data = code == Z_BUF_ERROR || read == compressed.size();
        throw Error(ErrorKind::bad_input, std::string(where_) + ": byte " + std::to_string(read),
                    short_of_data ? "the gzip stream ends early" : "the gzip stream is broken", "a whole .gz file");
      }
    }
    if (written > limit)
      throw Error(ErrorKind::limit, where_, "the content is over the limit",
                  "at most " + std::to_string(limit) + " bytes");
    out.resize(written);
    return out;
  }

 private:
  z_stream stream_{};
  std::string_view where_;
};

}  // namespace

Bytes gunzipped(const Bytes& compressed, uint64_t limit, std::string_view where) {
  return Inflater(where).all(compressed, limit);
}

}  // namespace trueshade
