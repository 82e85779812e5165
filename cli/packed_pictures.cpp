// Items of PackedPictures: number in the order, kind, two texts, bytes. Those whose content holds times stand apart
// from the others, which are the same wherever a picture is drawn.
#include <cstring>

#include "cli/picture_sink.h"

namespace trueshade {
namespace {

enum class Kind : uint8_t { file, timed_file, written, video, text, timed_text, document, note };

void put_number(std::vector<uint8_t>& to, uint64_t number) {
  const auto* const bytes = reinterpret_cast<const uint8_t*>(&number);
  to.insert(to.end(), bytes, bytes + sizeof number);
}

void put_text(std::vector<uint8_t>& to, const std::string& text) {
  put_number(to, text.size());
  to.insert(to.end(), text.begin(), text.end());
}

/// Of bytes that PackedPictures has made.
class Taking {
 public:
  explicit Taking(std::span<const uint8_t> rest) : rest_(rest) {}
  bool any() const { return !rest_.empty(); }
  uint64_t number() {
    uint64_t value = 0;
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_ = rest_.subspan(sizeof value);
    return value;
  }
  uint64_t next_number() const { return Taking(rest_).number(); }
  std::span<const uint8_t> bytes() {
    const size_t size = number();
    const std::span<const uint8_t> taken = rest_.first(size);
    rest_ = rest_.subspan(size);
    return taken;
  }
  std::string text() {
    const std::span<const uint8_t> taken = bytes();
    return {taken.begin(), taken.end()};
  }

 private:
  std::span<const uint8_t> rest_;
};

void replay_item(Taking& from, PictureSink& sink) {
  from.number();
  const auto kind = Kind(from.number());
  const std::string first = from.text(), second = from.text();
  const std::span<const uint8_t> bytes = from.bytes();
  switch (kind) {
    case Kind::file:
    case Kind::timed_file:
      return sink.file(first, {{bytes.begin(), bytes.end()}}, second, kind == Kind::timed_file);
    case Kind::written:
      return sink.written(first, second);
    case Kind::video:
      return sink.video({bytes.begin(), bytes.end()});
    case Kind::text:
      return sink.text(first);
    case Kind::timed_text:
      return sink.timed_text(first);
    case Kind::document:
      return sink.document(first);
    case Kind::note:
      return sink.note(first);
  }
}

}  // namespace

void PackedPictures::put(bool is_timed, uint8_t kind, const std::string& first, const std::string& second,
                         const EncodedFile& file) {
  std::vector<uint8_t>& part = is_timed ? timed_ : same_;
  put_number(part, items_++);
  put_number(part, kind);
  put_text(part, first);
  put_text(part, second);
  uint64_t size = 0;
  for (const std::vector<uint8_t>& piece : file) size += piece.size();
  put_number(part, size);
  for (const std::vector<uint8_t>& piece : file) part.insert(part.end(), piece.begin(), piece.end());
}

void PackedPictures::file(const std::string& path, EncodedFile file, const std::string& about, bool is_timed) {
  put(is_timed, uint8_t(is_timed ? Kind::timed_file : Kind::file), path, about, file);
}
void PackedPictures::written(const std::string& path, const std::string& about) {
  put(false, uint8_t(Kind::written), path, about, {});
}
void PackedPictures::video(std::vector<uint8_t> codes) { put(false, uint8_t(Kind::video), {}, {}, {std::move(codes)}); }
void PackedPictures::text(const std::string& text) { put(false, uint8_t(Kind::text), text, {}, {}); }
void PackedPictures::timed_text(const std::string& text) { put(true, uint8_t(Kind::timed_text), text, {}, {}); }
void PackedPictures::document(const std::string& json) { put(true, uint8_t(Kind::document), json, {}, {}); }
void PackedPictures::note(const std::string& line) { put(false, uint8_t(Kind::note), line, {}, {}); }

std::vector<uint8_t> PackedPictures::bytes() const {
  std::vector<uint8_t> all;
  all.reserve(sizeof(uint64_t) + same_.size() + timed_.size());
  put_number(all, same_.size());
  all.insert(all.end(), same_.begin(), same_.end());
  all.insert(all.end(), timed_.begin(), timed_.end());
  return all;
}

std::span<const uint8_t> part_without_times(std::span<const uint8_t> packed) { return Taking(packed).bytes(); }

void replay(std::span<const uint8_t> packed, PictureSink& sink) {
  Taking same(part_without_times(packed));
  Taking timed(packed.subspan(sizeof(uint64_t) + part_without_times(packed).size()));
  while (same.any() || timed.any()) {
    const bool is_same = !timed.any() || (same.any() && same.next_number() < timed.next_number());
    replay_item(is_same ? same : timed, sink);
  }
}

}  // namespace trueshade
