#include "bands/picture_writer.h"

#include <unistd.h>

#include <fstream>
#include <sstream>

#include "bands/progress_note.h"
#include "core/sha256.h"

namespace trueshade {
namespace {

std::string read_text(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

/// The file of the note. Empty where a file is a stream: its bytes are gone, so a later run cannot continue it.
std::string note_path_of(const std::vector<std::string>& files) {
  for (const std::string& file : files)
    if (part_name(file).empty()) return {};
  return files.empty() ? std::string() : note_name(files.front());
}

std::string digest(const std::string& text) {
  Sha256 hash;
  hash.update(text.data(), text.size());
  return hash.hex();
}

}  // namespace

PictureWriter::PictureWriter(const LargePicture& picture, const std::string& identity, Resume resume,
                             std::chrono::seconds between_notes)
    : picture_(picture),
      note_path_(note_path_of(picture.files)),
      identity_(digest(identity)),
      plane_hashes_(picture.aovs.size()),
      between_notes_(between_notes),
      noted_(std::chrono::steady_clock::now()) {
  if (resume == Resume::yes && go_on()) return;
  if (!note_path_.empty()) unlink(note_path_.c_str());  // it is of parts that are overwritten now
  for (const std::string& file : picture.files)
    files_.push_back(std::make_unique<StreamedFile>(file, picture.streamed(file)));
}

PictureWriter::~PictureWriter() = default;

bool PictureWriter::go_on() {
  if (note_path_.empty()) return false;
  const std::optional<ProgressNote> note = note_of(read_text(note_path_));
  bool whole = note && note->identity == identity_ && note->files.size() == picture_.files.size() &&
               note->planes.size() == plane_hashes_.size() && hash_.resume(note->hash) &&
               set_counts(note->counts, counts_);
  for (size_t i = 0; whole && i < plane_hashes_.size(); ++i) whole = plane_hashes_[i].resume(note->planes[i]);
  for (const std::string& file : picture_.files) whole = whole && access(part_name(file).c_str(), F_OK) == 0;
  if (!whole) {
    hash_ = {}, plane_hashes_.assign(picture_.aovs.size(), {}), counts_ = {};
    return false;
  }
  for (size_t i = 0; i < picture_.files.size(); ++i)
    files_.push_back(
        std::make_unique<StreamedFile>(picture_.files[i], picture_.streamed(picture_.files[i]), &note->files[i]));
  rows_done_ = note->rows;
  return true;
}

void PictureWriter::take(const DrawnBand& band) {
  hash_.add(band.color);
  if (band.planes.size() == plane_hashes_.size())
    for (size_t i = 0; i < plane_hashes_.size(); ++i) plane_hashes_[i].add(band.planes[i]);
  else
    plane_hashes_.clear();
  add_counts(band.counts, counts_);
  for (size_t i = 0; i < files_.size(); ++i) files_[i]->append(band.of_files[i]);
  rows_done_ += band.color.height;
  if (rows_done_ < picture_.drawn().height && std::chrono::steady_clock::now() - noted_ >= between_notes_) keep_note();
}

/// What the note says is on disk before the note is.
void PictureWriter::keep_note() {
  if (note_path_.empty()) return;
  ProgressNote note{identity_, rows_done_, hash_.progress(), {}, {}, counts_of(counts_)};
  for (const ImageHash& plane : plane_hashes_) note.planes.push_back(plane.progress());
  for (const auto& file : files_) {
    file->sync();
    note.files.push_back(file->state());
  }
  const std::string text = text_of(note);
  write_file(note_path_, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
  noted_ = std::chrono::steady_clock::now();
}

PictureWriter::Finished PictureWriter::finish() {
  Finished finished{hash_.hex(), {}, counts_};
  for (ImageHash& plane : plane_hashes_) finished.plane_hashes.push_back(plane.hex());
  for (const auto& file : files_) file->finish(finished.hash);
  if (!note_path_.empty()) unlink(note_path_.c_str());
  return finished;
}

}  // namespace trueshade
