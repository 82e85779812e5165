// Items of PackedPictures: number in the order, kind, two texts, bytes. Those whose content holds times stand apart
// from the others, which are the same wherever a picture is drawn.
#include "cli/picture_sink.h"
#include "core/error.h"

namespace trueshade {
namespace {

Error bad_picture() {
  return {ErrorKind::bad_input, "picture", "another process has sent what is no picture",
          "run the same version everywhere"};
}

enum class Kind : uint8_t { file, timed_file, written, video, text, timed_text, document, note };

void replay_item(ByteReader& from, PictureSink& sink) {
  from.number<uint64_t>();
  const auto kind = from.enumerator(Kind::note);
  const std::string first = from.text(), second = from.text();
  const std::span<const uint8_t> bytes = from.run();
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
  ByteWriter& part = is_timed ? timed_ : same_;
  part.number(items_++);
  part.number(kind);
  part.text(first);
  part.text(second);
  part.run(file);
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
  ByteWriter all;
  all.reserve(2 * sizeof(uint64_t) + same_.bytes().size() + timed_.bytes().size());
  all.run(same_.bytes());
  all.run(timed_.bytes());
  return all.take();
}

std::span<const uint8_t> part_without_times(std::span<const uint8_t> packed) try {
  return ByteReader(packed).run();
} catch (const BadBytes&) {
  throw bad_picture();
}

void replay(std::span<const uint8_t> packed, PictureSink& sink) try {
  ByteReader all(packed);
  ByteReader same(all.run()), timed(all.run());
  all.end();
  const auto number = [](ByteReader of) { return of.at_end() ? UINT64_MAX : of.number<uint64_t>(); };
  while (!same.at_end() || !timed.at_end()) replay_item(number(same) < number(timed) ? same : timed, sink);
} catch (const BadBytes&) {
  throw bad_picture();
}

}  // namespace trueshade
