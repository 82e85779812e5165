// What a rank makes of its frames, on its way to rank 0.
#include "cli/picture_sink.h"
#include "core/error.h"
#include "tests/catch.hpp"

namespace trueshade {
namespace {

/// What a sink was called with, a line a call.
class Told : public PictureSink {
 public:
  void file(const std::string& path, EncodedFile file, const std::string& about, bool is_timed) override {
    std::string bytes;
    for (const std::vector<uint8_t>& piece : file) bytes.append(piece.begin(), piece.end());
    add("file", {path, bytes, about, is_timed ? "timed" : "same"});
  }
  void written(const std::string& path, const std::string& about) override { add("written", {path, about}); }
  void video(std::vector<uint8_t> codes) override { add("video", {{codes.begin(), codes.end()}}); }
  void text(const std::string& text) override { add("text", {text}); }
  void timed_text(const std::string& text) override { add("timed_text", {text}); }
  void document(const std::string& json) override { add("document", {json}); }
  void note(const std::string& line) override { add("note", {line}); }

  std::string lines;

 private:
  void add(std::string line, const std::vector<std::string>& words) {
    for (const std::string& word : words) line += '|' + word;
    lines += line + '\n';
  }
};

void make_all(PictureSink& sink, const std::string& time) {
  sink.timed_text(time);
  sink.file("a.png", {{'a', 'b'}, {}, {'c'}}, "about", false);
  sink.file("a.html", {{time.begin(), time.end()}}, "report", true);
  sink.text("hash");
  sink.document(time);
  sink.written("b.png", "large");
  sink.video({'v'});
  sink.note("");
}

std::vector<uint8_t> packed(const std::string& time) {
  PackedPictures sink;
  make_all(sink, time);
  return sink.bytes();
}

}  // namespace

TEST_CASE("What is made of a picture comes out of its bytes in its order") {
  Told direct, replayed;
  make_all(direct, "12 ms");
  replay(packed("12 ms"), replayed);
  CHECK(replayed.lines == direct.lines);
  Told none;
  replay(PackedPictures().bytes(), none);
  CHECK(none.lines.empty());
}

TEST_CASE("The part of a packed picture without times does not depend on times, and on all else") {
  const auto part = [](const std::vector<uint8_t>& bytes) {
    const std::span<const uint8_t> of = part_without_times(bytes);
    return std::vector<uint8_t>(of.begin(), of.end());
  };
  CHECK(part(packed("12 ms")) == part(packed("3456 ms")));
  PackedPictures more;
  make_all(more, "12 ms");
  more.note("x");
  CHECK(part(packed("12 ms")) != part(more.bytes()));
}

TEST_CASE("Bytes that are no packed picture are refused") {
  std::vector<uint8_t> bytes = packed("12 ms");
  Told sink;
  for (size_t size = 0; size < bytes.size(); ++size) {
    INFO(size << " of " << bytes.size() << " bytes");
    CHECK_THROWS_AS(replay(std::span(bytes).first(size), sink), Error);
  }
  CHECK_THROWS_AS(part_without_times(std::span(bytes).first(9)), Error);
  bytes.push_back(0);
  CHECK_THROWS_AS(replay(bytes, sink), Error);
  CHECK(sink.lines.empty());
}

}  // namespace trueshade
