#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <optional>
#include <span>

#include "core/error.h"
#include "core/fp_env.h"
#include "core/image_files/file_aside.h"
#include "core/image_files/image_io.h"

namespace trueshade {
namespace {

/// What a path that may be written stands for.
struct Destination {
  bool stream;                   ///< a device or a pipe: bytes go into it, and nothing takes its place
  std::string path;              ///< with no link at its end
  std::optional<mode_t> mode{};  ///< permissions of the file that is there
};

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

Destination destination_of(const std::string& path) {
  if (path.empty()) throw Error(ErrorKind::io, "''", "is no name of a file", "name one");
  struct stat there {};
  if (stat(path.c_str(), &there) != 0) {
    if (errno == ENAMETOOLONG) fail_to(path, "write", errno);  // what else hinders, making a file in the folder will say
    return {false, followed(path)};
  }
  if (S_ISCHR(there.st_mode) || S_ISFIFO(there.st_mode)) return {true, path};
  if (S_ISDIR(there.st_mode)) fail_to(path, "write", EISDIR);
  if (!S_ISREG(there.st_mode))
    throw Error(ErrorKind::io, path, "is neither a file nor a stream of bytes", "choose another name");
  return {false, followed(path), there.st_mode & 0777};
}

void write_stream(const std::string& path, const FilePieces& pieces) {
  struct Stream {
    int descriptor;
    ~Stream() { close(descriptor); }
  } stream{open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY)};
  if (stream.descriptor < 0) fail_to(path, "open", errno);
  for (const std::span<const uint8_t> piece : pieces) write_bytes(stream.descriptor, path, piece);
}

}  // namespace

void write_file(const std::string& path, const FilePieces& pieces) {
  const FpScope fp;
  const Destination to = destination_of(path);
  if (to.stream) return write_stream(to.path, pieces);
  FileAside file(to.path);
  if (to.mode) file.take_mode(*to.mode);
  for (const std::span<const uint8_t> piece : pieces) file.write(piece);
  file.take_name();
}

void write_file(const std::string& path, std::span<const uint8_t> bytes) { write_file(path, FilePieces{{bytes}}); }

void check_writable(const std::string& path) {
  const FpScope fp;
  const Destination to = destination_of(path);
  if (!to.stream) const FileAside file(to.path);
}

}  // namespace trueshade
