#include "cli/commands.h"
#include "cli/notes.h"
#include "cli/picture_output.h"
#include "cli/picture_sink.h"
#include "cli/written_files.h"

namespace trueshade {

void PrintedPictures::file(const std::string& path, EncodedFile file, const std::string& about, bool) {
  if (is_standard_output(path))
    for (const std::vector<uint8_t>& piece : file) print_bytes(piece);
  else
    write_file(path, FilePieces(file.begin(), file.end()));
  written(path, about);
}

void PrintedPictures::written(const std::string& path, const std::string& about) {
  const bool answers = options_.hash || options_.stats || options_.json;
  say_written(path, about, answers ? StandardOutput::answer : StandardOutput::files);
}

void PrintedPictures::video(std::vector<uint8_t> codes) { print_bytes(codes); }
void PrintedPictures::text(const std::string& text) { print(text); }
void PrintedPictures::timed_text(const std::string& text) { print(text); }

void PrintedPictures::document(const std::string& json) { documents_ += (documents_.empty() ? "" : ",") + json; }

void PrintedPictures::note(const std::string& line) {
  if (said_.insert(line).second) say_notes({line});
}

void PrintedPictures::end() const {
  if (!options_.json) return;
  const char* const list = options_.numbered() ? "frames" : options_.cube_map ? "faces" : nullptr;
  print(list ? "{\"" + std::string(list) + "\":[" + documents_ + "]}\n" : documents_ + '\n');
}

}  // namespace trueshade
