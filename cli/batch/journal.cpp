#include "cli/batch/journal.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "cli/batch/file_hashes.h"
#include "cli/version.h"
#include "core/error.h"

namespace trueshade::batch {
namespace {

Error cannot(const std::string& path, const char* step) {
  return {ErrorKind::io, path, std::string("cannot ") + step + ": " + std::strerror(errno),
          "check the disk, or name another file by --state"};
}

}  // namespace

Journal::Journal(const std::string& path, std::string program, bool keeps) : path_(path), program_(std::move(program)) {
  descriptor_ = open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC | O_NOCTTY | O_NOFOLLOW, 0666);
  if (descriptor_ < 0) throw cannot(path, "open it");
  try {
    struct stat status {};
    if (fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode))
      throw Error(ErrorKind::bad_input, path, "this is no regular file", "name another by --state");
    if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
      throw Error(ErrorKind::bad_input, path, "another run is at work with it",
                  "wait for its end, or add --state FILE");
    if (!keeps && ftruncate(descriptor_, 0) != 0) throw cannot(path, "empty it");
    if (keeps) read_lines();
  } catch (...) {
    close(descriptor_);
    throw;
  }
}

Journal::~Journal() { close(descriptor_); }

void Journal::read_lines() {
  std::string text;
  char bytes[65536];
  for (ssize_t got; (got = pread(descriptor_, bytes, sizeof bytes, off_t(text.size()))) != 0;) {
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw cannot(path_, "read it");
    text.append(bytes, size_t(got));
  }
  size_t at = 0;
  for (size_t end; (end = text.find('\n', at)) != std::string::npos; at = end + 1) {
    try {
      ResultLine line = result_from_line(std::string_view(text).substr(at, end - at), path_);
      std::string name = line.name;
      lines_.insert_or_assign(std::move(name), std::move(line));
    } catch (const Error&) {
      // Its job runs again.
    }
  }
  if (at < text.size() && ftruncate(descriptor_, off_t(at)) != 0) throw cannot(path_, "take a torn line out of it");
}

const JobResult* Journal::result_of(const Job& job) const {
  const auto found = lines_.find(job.name);
  if (found == lines_.end() || found->second.identity != identity_of(job, program_)) return nullptr;
  return &found->second.result;
}

void Journal::add(const Job& job, const JobResult& result) {
  const std::string line = line_of(job, result, program_) + '\n';
  const std::lock_guard lock(mutex_);
  struct stat before {};
  if (fstat(descriptor_, &before) != 0) throw cannot(path_, "write it");
  for (size_t done = 0; done < line.size();) {
    const ssize_t written = write(descriptor_, line.data() + done, line.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const Error failure = cannot(path_, "write it");
      if (ftruncate(descriptor_, before.st_size) != 0) throw failure;  // the torn line is passed over when it is read
      throw failure;
    }
    done += size_t(written);
  }
}

std::string program_identity() {
  FileHashes hashes;
  return std::string("trueshade ") + kVersion + ' ' + kCommit + ' ' + hashes.of_file("/proc/self/exe");
}

}  // namespace trueshade::batch
