#include <dirent.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <span>

#include "core/error.h"
#include "core/file_notes.h"
#include "core/fp_env.h"
#include "core/image_files/image_io.h"

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

[[noreturn]] void fail(const std::string& path, const char* step, int error) {
  throw Error(ErrorKind::io, path, std::string("cannot ") + step + ": " + std::strerror(error), remedy(error));
}

std::string folder_of(const std::string& path) {
  const size_t slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

std::string temporary_name(const std::string& path, int attempt) {
  return folder_of(path) + "/.trueshade-" + std::to_string(getpid()) + "-" + std::to_string(attempt) + ".tmp";
}

/// Removes temporaries that processes left which were killed between naming a file and moving it to its place. A
/// temporary belongs to a process that is there, or holds its lock, until neither is so.
void remove_abandoned(const std::string& folder) {
  const std::unique_ptr<DIR, int (*)(DIR*)> entries(opendir(folder.c_str()), closedir);
  if (!entries) return;  // a folder may be writable and not readable
  while (const dirent* entry = readdir(entries.get())) {
    int owner = 0, attempt = 0, end = 0;
    if (std::sscanf(entry->d_name, ".trueshade-%d-%d.tmp%n", &owner, &attempt, &end) != 2 || end == 0 ||
        entry->d_name[end] != '\0' || owner <= 0 || kill(owner, 0) == 0 || errno != ESRCH)
      continue;
    const int file = openat(dirfd(entries.get()), entry->d_name, O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (file < 0) continue;
    struct stat status {};
    if (fstat(file, &status) == 0 && S_ISREG(status.st_mode) && flock(file, LOCK_EX | LOCK_NB) == 0)
      unlinkat(dirfd(entries.get()), entry->d_name, 0);
    close(file);
  }
}

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
    at = next.starts_with('/') ? next : folder_of(at) + '/' + next;
  }
  fail(path, "find what it links to", ELOOP);
}

Destination destination_of(const std::string& path) {
  if (path.empty()) throw Error(ErrorKind::io, "''", "is no name of a file", "name one");
  struct stat there {};
  if (stat(path.c_str(), &there) != 0) {
    if (errno == ENAMETOOLONG) fail(path, "write", errno);  // what else hinders, making a file in the folder will say
    return {false, followed(path)};
  }
  if (S_ISCHR(there.st_mode) || S_ISFIFO(there.st_mode)) return {true, path};
  if (S_ISDIR(there.st_mode)) fail(path, "write", EISDIR);
  if (!S_ISREG(there.st_mode))
    throw Error(ErrorKind::io, path, "is neither a file nor a stream of bytes", "choose another name");
  return {false, followed(path), there.st_mode & 0777};
}

void write_bytes(int descriptor, const std::string& path, std::span<const uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(path, "write", errno);
    bytes = bytes.subspan(size_t(written));
  }
}

void write_stream(const std::string& path, const FilePieces& pieces) {
  struct Stream {
    int descriptor;
    ~Stream() { close(descriptor); }
  } stream{open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY)};
  if (stream.descriptor < 0) fail(path, "open", errno);
  for (const std::span<const uint8_t> piece : pieces) write_bytes(stream.descriptor, path, piece);
}

/// A file in the folder of `path`, without a name where the file system can do that, so that not even a killed process
/// leaves it behind; else under a name of its own. Removed on destruction unless it took the name of `path`.
class Temporary {
 public:
  explicit Temporary(const std::string& path) : path_(path) {
    remove_abandoned(folder_of(path));
    // Its name is given through /proc, which a bare chroot may lack.
    if (access("/proc/self/fd", X_OK) == 0)
      descriptor_ = open(folder_of(path).c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666);
    for (int attempt = 0; descriptor_ < 0; ++attempt) {
      name_ = temporary_name(path, attempt);
      descriptor_ = open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666);
      if (descriptor_ < 0 && (errno != EEXIST || attempt == 1000)) fail(path, "create a file in its folder", errno);
    }
    // The lock keeps remove_abandoned() of other processes from this file, also of processes that do not see this one's
    // number. Nobody else has opened the file, so the lock is free. Without locks the process number has to do.
    flock(descriptor_, LOCK_EX | LOCK_NB);
  }
  ~Temporary() {
    if (descriptor_ >= 0) close(descriptor_);
    if (!name_.empty()) unlink(name_.c_str());
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;

  void write_all(const FilePieces& pieces) {
    for (const std::span<const uint8_t> piece : pieces) write_bytes(descriptor_, path_, piece);
  }

  /// The permissions of the file that it takes the place of, where the system allows.
  void take_mode(mode_t mode) {
    if (fchmod(descriptor_, mode) != 0 && errno != EPERM && errno != ENOTSUP) fail(path_, "give it its mode", errno);
  }

  /// On disk under the final name, in this order, so that a crash leaves the old file or the new one.
  void take_name() {
    if (fsync(descriptor_) != 0 && errno != EINVAL) fail(path_, "write to disk", errno);
    if (name_.empty()) give_name();
    const int closed = close(descriptor_);
    descriptor_ = -1;
    if (closed != 0) fail(path_, "write", errno);
    if (rename(name_.c_str(), path_.c_str()) != 0) fail(path_, "take this name", errno);
    name_.clear();
    const int folder = open(folder_of(path_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0)
      return;  // a folder may be writable and not readable; its entry is then written when the system likes
    const int synced = fsync(folder) != 0 && errno != EINVAL ? errno : 0;
    close(folder);
    if (synced != 0) fail(path_, "write its folder to disk", synced);
  }

 private:
  /// A file without a name cannot replace one; for the moment between this and rename it has a temporary's.
  void give_name() {
    const std::string self = "/proc/self/fd/" + std::to_string(descriptor_);
    for (int attempt = 0; name_.empty(); ++attempt) {
      const std::string name = temporary_name(path_, attempt);
      if (linkat(AT_FDCWD, self.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0)
        name_ = name;
      else if (errno != EEXIST || attempt == 1000)
        fail(path_, "create a file in its folder", errno);
    }
  }

  std::string path_, name_;
  int descriptor_ = -1;
};

}  // namespace

void write_file(const std::string& path, const FilePieces& pieces) {
  const FpScope fp;
  const Destination to = destination_of(path);
  if (to.stream) return write_stream(to.path, pieces);
  Temporary file(to.path);
  if (to.mode) file.take_mode(*to.mode);
  file.write_all(pieces);
  file.take_name();
  note_written(path, pieces);
}

void write_file(const std::string& path, std::span<const uint8_t> bytes) { write_file(path, FilePieces{{bytes}}); }

void check_writable(const std::string& path) {
  const FpScope fp;
  const Destination to = destination_of(path);
  if (!to.stream) const Temporary file(to.path);
}

}  // namespace trueshade
