#include "core/image_files/file_place.h"

#include <unistd.h>

#include <cerrno>
#include <climits>

#include "core/error.h"
#include "core/image_files/file_aside.h"

namespace trueshade {
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
    at = next.starts_with('/') ? next : folder_of_path(at) + '/' + next;
  }
  fail_to(path, "find what it links to", ELOOP);
}

/// Whether the process has it open, as what /dev/stdout and /dev/fd/63 stand for.
bool is_open(const struct stat& wanted) {
  constexpr int kMostDescriptors = 256;
  for (int descriptor = 0; descriptor < kMostDescriptors; ++descriptor) {
    struct stat status {};
    if (fstat(descriptor, &status) == 0 && status.st_dev == wanted.st_dev && status.st_ino == wanted.st_ino)
      return true;
  }
  return false;
}

}  // namespace

Destination destination_of(const std::string& path) {
  if (path.empty()) throw Error(ErrorKind::io, "''", "is no name of a file", "name one");
  struct stat there {};
  if (stat(path.c_str(), &there) != 0) {
    if (errno == ENAMETOOLONG) fail_to(path, "write", errno);  // what else hinders, making a file in the folder will say
    return {false, followed(path)};
  }
  if (S_ISFIFO(there.st_mode) && !is_open(there))
    throw Error(ErrorKind::io, path, "is a pipe, and opening it waits for a reader", "write to -, sent into the pipe");
  if (S_ISCHR(there.st_mode) || S_ISFIFO(there.st_mode)) return {true, path};
  if (S_ISDIR(there.st_mode)) fail_to(path, "write", EISDIR);
  if (!S_ISREG(there.st_mode))
    throw Error(ErrorKind::io, path, "is neither a file nor a stream of bytes", "choose another name");
  return {false, followed(path), there.st_mode & 0777};
}

}  // namespace trueshade
