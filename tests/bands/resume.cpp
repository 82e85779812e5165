// Pictures that a process has left unfinished are gone on with, and end as the same files.
#include "bands/picture_writer.h"
#include "bands/progress_note.h"
#include "core/error.h"
#include "tests/bands/city_picture.h"
#include "tests/catch.hpp"
#include "tests/scratch_folder.h"

using namespace trueshade;
using testing::city_picture;

namespace {

std::string content(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

/// What another process sends of a band where nobody asks for hashes of planes.
DrawnBand without_planes(const LargePicture& picture, int index) {
  return band_of_bytes(picture, index, bytes_of_band(draw_band(picture, index), SentPlanes::no));
}

/// Draws bands until `stop` of them are done, or all; whether it has finished.
bool go_on(LargePicture picture, const std::string& identity, Resume resume, int stop, int& rows_before) {
  PictureWriter writer(picture, identity, resume, std::chrono::seconds(0));
  rows_before = picture.rows_done = writer.rows_done();
  for (int i = 0; i < picture.bands(); ++i) {
    if (i == stop) return false;
    writer.take(draw_band(picture, i));
  }
  writer.finish();
  return true;
}

}  // namespace

TEST_CASE("A picture goes on from every band, with bands of another height, and ends as the same files", "[bands]") {
  const Scene scene = builtin_scene("city");
  const PreparedScene prepared(scene);
  const ScratchFolder folder;
  LargePicture picture = city_picture(prepared, 130, 500);
  picture.aovs = {"depth"};
  picture.files = {folder.path("a.png"), folder.path("a.exr")};
  int before = 0;
  REQUIRE(go_on(picture, "same", Resume::no, -1, before));
  const std::string png = content(picture.files[0]), exr = content(picture.files[1]);
  for (int stop = 0; stop < picture.bands(); ++stop) {
    INFO("stopped after " << stop);
    for (const std::string& file : picture.files) std::filesystem::remove(file);
    picture.rows = 64;
    REQUIRE_FALSE(go_on(picture, "same", Resume::no, stop, before));
    CHECK_FALSE(std::filesystem::exists(picture.files[0]));
    picture.rows = stop % 2 == 0 ? 64 : 192;
    REQUIRE(go_on(picture, "same", Resume::yes, -1, before));
    CHECK(before == 64 * stop);
    CHECK((content(picture.files[0]) == png));
    CHECK((content(picture.files[1]) == exr));
    CHECK(folder.entries() == std::vector<std::string>{"a.exr", "a.png"});
  }
}

TEST_CASE("A picture begins anew where what is there is not of it, torn, or partly gone", "[bands]") {
  const Scene scene = builtin_scene("sphere");
  const PreparedScene prepared(scene);
  const ScratchFolder folder;
  LargePicture picture = city_picture(prepared, 100, 300);
  picture.files = {folder.path("a.png"), folder.path("b.png")};
  int before = 0;
  REQUIRE(go_on(picture, "same", Resume::no, -1, before));
  const std::string png = content(picture.files[0]);
  const std::string note = note_name(picture.files[0]);
  const auto damaged = [&](const char* what, const auto& damage) {
    INFO(what);
    REQUIRE_FALSE(go_on(picture, "same", Resume::no, 3, before));
    damage();
    REQUIRE(go_on(picture, "same", Resume::yes, -1, before));
    CHECK(before == 0);
    CHECK((content(picture.files[0]) == png));
    CHECK((content(picture.files[1]) == png));
  };
  damaged("no note", [&] { std::filesystem::remove(note); });
  damaged("a note that is torn", [&] { std::filesystem::resize_file(note, std::filesystem::file_size(note) - 9); });
  damaged("a note with another digit", [&] {
    std::string text = content(note);
    text[text.find("rows ") + 5] ^= 1;
    folder.write("a.png.progress", text);
  });
  damaged("a part is gone", [&] { std::filesystem::remove(picture.files[1] + ".part"); });
  REQUIRE_FALSE(go_on(picture, "other", Resume::no, 3, before));
  REQUIRE(go_on(picture, "same", Resume::yes, -1, before));
  CHECK(before == 0);
}

TEST_CASE("One flipped bit of what lies on disk, or a part that is shorter, begins a picture anew", "[bands]") {
  const Scene scene = builtin_scene("sphere");
  const PreparedScene prepared(scene);
  const ScratchFolder folder;
  LargePicture picture = city_picture(prepared, 100, 300);
  picture.aovs = {"depth"};
  picture.files = {folder.path("a.png"), folder.path("a.exr")};
  int before = 0;
  REQUIRE(go_on(picture, "same", Resume::no, -1, before));
  const std::string whole[] = {content(picture.files[0]), content(picture.files[1])};
  for (size_t file = 0; file < 2; ++file) {
    const std::string name = std::filesystem::path(picture.files[file]).filename().string() + ".part";
    REQUIRE_FALSE(go_on(picture, "same", Resume::no, 3, before));
    const std::string left = content(folder.path(name));
    int anew = 0;
    for (size_t step = left.size() / 20, at = 0; at <= left.size(); at += step) {
      INFO(name << ", byte " << at << " of " << left.size());
      REQUIRE_FALSE(go_on(picture, "same", Resume::no, 3, before));
      std::string damaged = left;
      if (at + step <= left.size())
        damaged[at] = char(damaged[at] ^ 4);
      else
        damaged.pop_back();
      folder.write(name, damaged);
      REQUIRE(go_on(picture, "same", Resume::yes, -1, before));
      anew += before == 0;
      CHECK((content(picture.files[0]) == whole[0]));
      CHECK((content(picture.files[1]) == whole[1]));
    }
    CHECK(anew > 10);
  }
}

TEST_CASE("A picture whose bands came without planes goes on, unless the hashes of planes are asked for", "[bands]") {
  const Scene scene = builtin_scene("sphere");
  const PreparedScene prepared(scene);
  const ScratchFolder folder;
  LargePicture picture = city_picture(prepared, 100, 300);
  picture.aovs = {"depth", "albedo"};
  picture.files = {folder.path("a.exr")};
  using Finished = PictureWriter::Finished;
  /// Each letter a band: `p` with planes, `-` without. Finishes the picture after its last band.
  const auto draw = [&](Resume resume, const std::string& bands, int rows_before) -> std::optional<Finished> {
    INFO(bands << " after " << rows_before);
    picture.rows_done = 0;
    PictureWriter writer(picture, "same", resume, std::chrono::seconds(0));
    picture.rows_done = writer.rows_done();
    CHECK(writer.rows_done() == rows_before);
    CHECK(writer.why_anew().empty() == (resume == Resume::no || rows_before > 0));
    for (size_t i = 0; i < bands.size(); ++i)
      writer.take(bands[i] == 'p' ? draw_band(picture, int(i)) : without_planes(picture, int(i)));
    return int(bands.size()) == picture.bands() ? std::optional(writer.finish()) : std::nullopt;
  };
  const auto whole = draw(Resume::no, "ppppp", 0);
  REQUIRE(whole);
  REQUIRE(whole->plane_hashes.size() == 2);
  const std::string exr = content(picture.files[0]);
  /// The same picture, begun by one run and ended by another.
  const auto both = [&](const char* begun, Resume resume, const char* ended, int rows_before, bool has_plane_hashes) {
    INFO(begun << ' ' << ended);
    CHECK_FALSE(draw(Resume::no, begun, 0));
    const auto resumed = draw(resume, ended, rows_before);
    REQUIRE(resumed);
    CHECK(resumed->hash == whole->hash);
    CHECK(resumed->plane_hashes == (has_plane_hashes ? whole->plane_hashes : std::vector<std::string>()));
    CHECK(counts_of(resumed->counts).size() == counts_of(whole->counts).size());
    CHECK(resumed->counts.pixels == whole->counts.pixels);
    CHECK((content(picture.files[0]) == exr));
    CHECK(folder.entries() == std::vector<std::string>{"a.exr"});
  };
  both("pp", Resume::with_plane_hashes, "ppp", 128, true);
  both("pp", Resume::yes, "ppp", 128, true);
  both("pp", Resume::yes, "-pp", 128, false);
  both("--", Resume::yes, "ppp", 128, false);
  both("p-", Resume::yes, "---", 128, false);
  both("--", Resume::with_plane_hashes, "ppppp", 0, true);
  both("p-", Resume::with_plane_hashes, "ppppp", 0, true);
}

TEST_CASE("Two processes do not write one part", "[bands]") {
  const Scene scene = builtin_scene("sphere");
  const PreparedScene prepared(scene);
  const ScratchFolder folder;
  LargePicture picture = city_picture(prepared, 100, 100);
  picture.files = {folder.path("a.png")};
  const PictureWriter first(picture, "same", Resume::no);
  CHECK_THROWS_AS(PictureWriter(picture, "same", Resume::no), Error);
}

TEST_CASE("Notes come back as they were, and texts that are none do not", "[bands]") {
  ProgressNote note{"abc", 640, "00ff", {"11", "22"}, {{100, 5, 77, 6, 9}, {3, 2, 1, 8, 4}}, {1, 2, 3}};
  const std::string text = text_of(note);
  const std::optional<ProgressNote> read = note_of(text);
  REQUIRE(read);
  CHECK(text_of(*read) == text);
  CHECK(read->rows == 640);
  CHECK(read->files[1].pieces == 2);
  CHECK_FALSE(note_of(""));
  for (size_t i = 0; i < text.size(); ++i) {
    CHECK_FALSE(note_of(text.substr(0, i)));
    std::string other = text;
    other[i] = char(other[i] ^ 1);
    CHECK_FALSE(note_of(other));
  }
}
