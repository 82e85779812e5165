#include "core/image_files/file_place.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <cstdio>
#include <cstring>

#include "core/error.h"

namespace trueshade {
namespace {

const char* remedy(int error) {
  switch (error) {
    case ENOENT:
    case ENOTDIR:
      return "create the folder first";
    case EACCES:
    case EPERM:
    case EROFS:
      return "choose a folder you may write to";
    case ENOSPC:
    case EDQUOT:
      return "free some space or choose another disk";
    case EFBIG:
      return "raise the limit on file sizes, or write a smaller image";
    case EISDIR:
      return "name a file, not a folder";
    case ENAMETOOLONG:
      return "choose a shorter name";
    default:
      return "check the disk and the folder";
  }
}

}  // namespace

void fail_to_write(const std::string& path, const char* step, int error) {
  throw Error(ErrorKind::io, path, std::string("cannot ") + step + ": " + std::strerror(error), remedy(error));
}

std::string folder_of(const std::string& path) {
  const size_t slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

namespace {

/// Where links lead, also to what is not there yet.
std::string followed(const std::string& path) {
  constexpr int kMostLinks = 40;  // as many as Linux follows
  std::string at = path;
  for (int links = 0; links <= kMostLinks; ++links) {
    char target[PATH_MAX];
    const ssize_t length = readlink(at.c_str(), target, sizeof target);
    if (length < 0) return at;
    const std::string next(target, size_t(length));
    at = next.starts_with('/') ? next : folder_of(at) + '/' + next;
  }
  fail_to_write(path, "find what it links to", ELOOP);
}

}  // namespace

Destination destination_of(const std::string& path) {
  if (path.empty()) throw Error(ErrorKind::io, "''", "is no name of a file", "name one");
  struct stat there {};
  if (stat(path.c_str(), &there) != 0) {
    if (errno == ENAMETOOLONG)
      fail_to_write(path, "write", errno);  // what else hinders, making a file in the folder will say
    return {false, followed(path)};
  }
  if (S_ISCHR(there.st_mode) || S_ISFIFO(there.st_mode)) return {true, path};
  if (S_ISDIR(there.st_mode)) fail_to_write(path, "write", EISDIR);
  if (!S_ISREG(there.st_mode))
    throw Error(ErrorKind::io, path, "is neither a file nor a stream of bytes", "choose another name");
  return {false, followed(path), there.st_mode & 0777};
}

void write_bytes(int descriptor, const std::string& path, std::span<const uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail_to_write(path, "write", errno);
    bytes = bytes.subspan(size_t(written));
  }
}

void move_to_place(int descriptor, const std::string& from, const std::string& to) {
  if (fsync(descriptor) != 0 && errno != EINVAL) fail_to_write(to, "write to disk", errno);
  if (rename(from.c_str(), to.c_str()) != 0) fail_to_write(to, "take this name", errno);
  const int folder = open(folder_of(to).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;  // a folder may be writable and not readable; its entry is then written when the system likes
  const int synced = fsync(folder) != 0 && errno != EINVAL ? errno : 0;
  close(folder);
  if (synced != 0) fail_to_write(to, "write its folder to disk", synced);
}

}  // namespace trueshade
