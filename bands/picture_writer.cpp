#include "bands/picture_writer.h"

#include <unistd.h>

#include <fstream>
#include <sstream>

#include "core/sha256.h"

namespace trueshade {
namespace {

constexpr const char* kTorn = "the note of an earlier run is torn";

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
  if (resume != Resume::no && go_on(resume)) return;
  if (!note_path_.empty()) unlink(note_path_.c_str());  // it is of parts that are overwritten now
  for (const std::string& file : picture.files)
    files_.push_back(std::make_unique<StreamedFile>(file, picture.streamed(file)));
}

PictureWriter::~PictureWriter() = default;

bool PictureWriter::go_on(Resume resume) {
  if (note_path_.empty() || access(note_path_.c_str(), F_OK) != 0) return false;
  const std::optional<ProgressNote> note = note_of(read_text(note_path_));
  why_anew_ = note ? take_over(*note, resume) : kTorn;
  if (!why_anew_.empty()) return false;
  for (size_t i = 0; i < picture_.files.size(); ++i)
    files_.push_back(
        std::make_unique<StreamedFile>(picture_.files[i], picture_.streamed(picture_.files[i]), &note->files[i]));
  rows_done_ = note->rows;
  return true;
}

/// Takes hashes and counts of a note, or returns why the picture cannot go on from it, and changes nothing.
std::string PictureWriter::take_over(const ProgressNote& note, Resume resume) {
  if (note.identity != identity_ || note.files.size() != picture_.files.size())
    return "the note of an earlier run is of another picture";
  for (const std::string& file : picture_.files)
    if (access(part_name(file).c_str(), F_OK) != 0) return part_name(file) + " is gone";
  const bool has_plane_hashes = note.planes.size() == picture_.aovs.size();
  if (!has_plane_hashes && resume == Resume::with_plane_hashes)
    return "the hashes of planes are asked for, and the earlier run has kept none";
  ImageHash hash;
  std::vector<ImageHash> plane_hashes(note.planes.size());
  FrameStats counts;
  bool whole = (has_plane_hashes || note.planes.empty()) && hash.resume(note.hash) && set_counts(note.counts, counts);
  for (size_t i = 0; whole && i < plane_hashes.size(); ++i) whole = plane_hashes[i].resume(note.planes[i]);
  if (!whole) return kTorn;
  for (size_t i = 0; i < note.files.size(); ++i)
    if (!part_is_sound(picture_.files[i], picture_.streamed(picture_.files[i]), note.files[i]))
      return part_name(picture_.files[i]) + " is not what the earlier run has left";
  hash_ = hash, plane_hashes_ = std::move(plane_hashes), counts_ = std::move(counts);
  return {};
}

void PictureWriter::take(const DrawnBand& band) {
  hash_.add(picture_.color(), band.color);
  if (band.planes.size() < plane_hashes_.size()) plane_hashes_.clear();
  const std::vector<Format> formats = picture_.planes();
  for (size_t i = 0; i < plane_hashes_.size(); ++i) plane_hashes_[i].add(formats[i], band.planes[i]);
  add_counts(band.counts, counts_);
  for (size_t i = 0; i < files_.size(); ++i) files_[i]->append(band.of_files[i]);
  rows_done_ += band.rows;
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
