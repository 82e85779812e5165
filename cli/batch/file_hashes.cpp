#include "cli/batch/file_hashes.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <set>
#include <vector>

#include "cli/picture_rows.h"
#include "core/error.h"
#include "core/file_notes.h"
#include "core/sha256.h"

namespace trueshade::batch {
namespace {

std::array<int64_t, 7> stamp_of(const struct stat& file) {
  return {int64_t(file.st_dev),         int64_t(file.st_ino),          int64_t(file.st_size),
          int64_t(file.st_mtim.tv_sec), int64_t(file.st_mtim.tv_nsec), int64_t(file.st_ctim.tv_sec),
          int64_t(file.st_ctim.tv_nsec)};
}

std::string hash_of_content(int file) {
  Sha256 hash;
  std::vector<uint8_t> bytes(size_t(1) << 18);
  for (;;) {
    const ssize_t got = read(file, bytes.data(), bytes.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return std::string(kAbsent);
    if (got == 0) return hash.hex();
    hash.update(bytes.data(), size_t(got));
  }
}

std::string hash_of_listing(const std::string& folder) {
  try {
    std::set<std::string> passed_over;
    return hash_of_names(pictures_in(folder, passed_over));
  } catch (const Error&) {
    return std::string(kAbsent);
  }
}

}  // namespace

std::string FileHashes::of_file(const std::string& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (file < 0) return std::string(kAbsent);
  struct Closer {
    int file;
    ~Closer() { close(file); }
  } const closer{file};
  struct stat status {};
  if (fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) return std::string(kAbsent);
  const std::array<int64_t, 7> stamp = stamp_of(status);
  {
    const std::lock_guard lock(mutex_);
    const auto known = known_.find(path);
    if (known != known_.end() && known->second.stamp == stamp) return known->second.hash;
  }
  std::string hash = hash_of_content(file);
  const std::lock_guard lock(mutex_);
  known_.insert_or_assign(path, Known{stamp, hash});
  return hash;
}

bool FileHashes::is_as_noted(const FileNote& note, const std::string& path) {
  if (note.kind == FileNote::Kind::listed) return hash_of_listing(path) == note.hash;
  if (note.hash == kThere) {
    struct stat status {};
    return stat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode);
  }
  return of_file(path) == note.hash;
}

bool FileHashes::are_those_of(const JobResult& result, const std::string& folder) {
  return std::all_of(result.files.begin(), result.files.end(), [&](const FileNote& note) {
    return is_as_noted(note, note.path.starts_with('/') ? note.path : folder + '/' + note.path);
  });
}

}  // namespace trueshade::batch
