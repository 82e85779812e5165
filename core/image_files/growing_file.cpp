#include "core/image_files/growing_file.h"

#include <fcntl.h>
#include <libdeflate.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <vector>

#include "core/error.h"
#include "core/file_notes.h"
#include "core/image_files/file_aside.h"
#include "core/image_files/file_place.h"
#include "core/image_files/streamed_file.h"

namespace trueshade {
namespace {

/// Whether a path stands for standard output, as `-.png` does; its ending says what is written.
bool is_standard_output(const std::string& path) {
  return path.starts_with("-.") && path.find('/') == std::string::npos;
}

}  // namespace

uint32_t crc_of(std::span<const uint8_t> bytes, uint32_t before) {
  return libdeflate_crc32(before, bytes.data(), bytes.size());
}

std::string part_name(const std::string& path) {
  if (is_standard_output(path)) return {};
  const Destination to = destination_of(path);
  return to.stream ? std::string() : to.path + ".part";
}

GrowingFile::GrowingFile(const std::string& path, bool goes_on) : path_(path) {
  if (is_standard_output(path)) {
    stream_ = true;
    descriptor_ = dup(STDOUT_FILENO);
    if (descriptor_ < 0) fail_to(path, "open", errno);
    return;
  }
  const Destination to = destination_of(path);
  stream_ = to.stream;
  path_ = to.path;
  if (stream_) {
    descriptor_ = open(path_.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
    if (descriptor_ < 0) fail_to(path, "open", errno);
    return;
  }
  part_ = path_ + ".part";
  descriptor_ = open(part_.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | (goes_on ? 0 : O_CREAT), 0666);
  if (descriptor_ < 0) fail_to(part_, goes_on ? "open" : "create", errno);
  if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    throw Error(ErrorKind::io, part_, "another process is writing it", "wait for its end, or choose another name");
  if (!goes_on && ftruncate(descriptor_, 0) != 0) fail_to(part_, "create", errno);
  if (to.mode && fchmod(descriptor_, *to.mode) != 0 && errno != EPERM && errno != ENOTSUP)
    fail_to(part_, "give it its mode", errno);
}

GrowingFile::~GrowingFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

void GrowingFile::put(uint64_t at, std::span<const uint8_t> bytes) {
  if (stream_) {
    if (at != end_) throw Error(ErrorKind::usage, path_, "a stream takes bytes in order", "write to a file");
    end_ += bytes.size();
    return write_bytes(descriptor_, path_, bytes);
  }
  while (!bytes.empty()) {
    const ssize_t written = pwrite(descriptor_, bytes.data(), bytes.size(), off_t(at));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail_to(part_, "write", errno);
    bytes = bytes.subspan(size_t(written));
    at += uint64_t(written);
  }
}

void GrowingFile::cut(uint64_t size) {
  if (stream_) return;
  struct stat there {};
  if (fstat(descriptor_, &there) != 0) fail_to(part_, "open", errno);
  if (uint64_t(there.st_size) < size)
    throw Error(ErrorKind::io, part_, "is shorter than it was left", "delete it to begin anew");
  if (ftruncate(descriptor_, off_t(size)) != 0) fail_to(part_, "write", errno);
}

std::optional<uint32_t> GrowingFile::crc(uint64_t from, uint64_t end) const {
  constexpr uint64_t kStep = uint64_t(1) << 20;
  std::vector<uint8_t> bytes(size_t(std::min(kStep, end - from)));
  uint32_t crc = 0;
  while (from < end) {
    const ssize_t got =
        pread(descriptor_, bytes.data(), size_t(std::min<uint64_t>(bytes.size(), end - from)), off_t(from));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail_to(part_, "read", errno);
    if (got == 0) return std::nullopt;
    crc = crc_of({bytes.data(), size_t(got)}, crc);
    from += uint64_t(got);
  }
  return crc;
}

void GrowingFile::sync() {
  if (!stream_ && fdatasync(descriptor_) != 0 && errno != EINVAL) fail_to(part_, "write to disk", errno);
}

void GrowingFile::finish() {
  if (!stream_) {
    put_on_disk(descriptor_, part_);
    take_place(part_, path_);
    note_written_to_disk(path_);
  }
  const int closed = close(descriptor_);
  descriptor_ = -1;
  if (closed != 0) fail_to(path_, "write", errno);
}

}  // namespace trueshade
