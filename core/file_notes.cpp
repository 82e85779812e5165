#include "core/file_notes.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <mutex>

#include "core/json_string.h"
#include "core/sha256.h"

namespace trueshade {
namespace {

std::atomic<int> notes_descriptor{-1};

/// Lines of several threads do not mix. Who does not listen any more is told no more.
void write_note(const char* key, const std::string& path, std::string_view hash) {
  static std::mutex one_line;
  const std::string line =
      std::string("{\"") + key + "\": " + json_string(path) + ", \"sha256\": \"" + std::string(hash) + "\"}\n";
  const std::lock_guard lock(one_line);
  for (std::string_view rest = line; !rest.empty();) {
    const ssize_t written = write(notes_descriptor, rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;
    rest.remove_prefix(size_t(written));
  }
}

bool is_noting() { return notes_descriptor >= 0; }

void note_content(const char* key, const std::string& path) {
  if (!is_noting()) return;
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) return write_note(key, path, kAbsent);
  Sha256 hash;
  std::vector<uint8_t> piece(size_t(1) << 20);
  ssize_t got = 0;
  while ((got = read(file, piece.data(), piece.size())) > 0 || (got < 0 && errno == EINTR))
    if (got > 0) hash.update(piece.data(), size_t(got));
  close(file);
  write_note(key, path, got < 0 ? std::string(kThere) : hash.hex());
}

}  // namespace

void note_files_to(int descriptor) { notes_descriptor = descriptor; }

void note_read(const std::string& path, std::span<const uint8_t> content) {
  if (!is_noting()) return;
  Sha256 hash;
  hash.update(content.data(), content.size());
  write_note("read", path, hash.hex());
}

void note_read(const std::string& path, std::string_view word) {
  if (is_noting()) write_note("read", path, word);
}

void note_read_from_disk(const std::string& path) { note_content("read", path); }
void note_written_to_disk(const std::string& path) { note_content("wrote", path); }

void note_listed(const std::string& folder, const std::set<std::string>& names) {
  if (is_noting()) write_note("listed", folder, hash_of_names(names));
}

void note_written(const std::string& path, const std::vector<std::span<const uint8_t>>& pieces) {
  if (!is_noting()) return;
  Sha256 hash;
  for (const std::span<const uint8_t> piece : pieces) hash.update(piece.data(), piece.size());
  write_note("wrote", path, hash.hex());
}

std::string hash_of_names(const std::set<std::string>& names) {
  Sha256 hash;
  for (const std::string& name : names) hash.update(name.c_str(), name.size() + 1);
  return hash.hex();
}

}  // namespace trueshade
