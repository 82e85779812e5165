#include "bands/progress_note.h"

#include <sstream>

#include "core/sha256.h"

namespace trueshade {
namespace {

constexpr const char* kFirstLine = "trueshade progress 2";

std::string checksum_of(const std::string& text) {
  Sha256 hash;
  hash.update(text.data(), text.size());
  return hash.hex();
}

}  // namespace

std::string text_of(const ProgressNote& note) {
  std::ostringstream out;
  out << kFirstLine << "\nidentity " << note.identity << "\nrows " << note.rows << "\nhash " << note.hash << "\nplanes "
      << note.planes.size();
  for (const std::string& plane : note.planes) out << ' ' << plane;
  out << "\nfiles " << note.files.size();
  for (const StreamedState& file : note.files)
    out << ' ' << file.end << ' ' << file.pieces << ' ' << file.checksum << ' ' << file.pieces_crc << ' '
        << file.table_crc;
  out << "\ncounts " << note.counts.size();
  for (const uint64_t count : note.counts) out << ' ' << count;
  out << '\n';
  return out.str() + "check " + checksum_of(out.str()) + '\n';
}

std::optional<ProgressNote> note_of(const std::string& text) {
  const size_t check = text.rfind("check ");
  if (!text.starts_with(std::string(kFirstLine) + '\n') || check == std::string::npos ||
      text.substr(check) != "check " + checksum_of(text.substr(0, check)) + '\n')
    return std::nullopt;
  // The checksum says that the text is one of text_of(); so lists are as long as they say.
  std::istringstream in(text.substr(0, check));
  in.ignore(int(std::string(kFirstLine).size()) + 1);
  ProgressNote note;
  std::string word;
  size_t size = 0;
  in >> word >> note.identity >> word >> note.rows >> word >> note.hash >> word >> size;
  for (size_t i = 0; in && i < size; ++i) in >> note.planes.emplace_back();
  in >> word >> size;
  for (size_t i = 0; in && i < size; ++i) {
    StreamedState& file = note.files.emplace_back();
    in >> file.end >> file.pieces >> file.checksum >> file.pieces_crc >> file.table_crc;
  }
  in >> word >> size;
  for (size_t i = 0; in && i < size; ++i) in >> note.counts.emplace_back();
  return in ? std::optional(note) : std::nullopt;
}

std::string note_name(const std::string& file) { return file + ".progress"; }

}  // namespace trueshade
