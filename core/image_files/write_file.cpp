#include <dirent.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <memory>
#include <span>

#include "core/fp_env.h"
#include "core/image_files/file_place.h"
#include "core/image_files/image_io.h"

namespace trueshade {
namespace {

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

void write_stream(const std::string& path, const FilePieces& pieces) {
  struct Stream {
    int descriptor;
    ~Stream() { close(descriptor); }
  } stream{open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY)};
  if (stream.descriptor < 0) fail_to_write(path, "open", errno);
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
      if (descriptor_ < 0 && (errno != EEXIST || attempt == 1000)) fail_to_write(path, "create a file in its folder", errno);
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
    if (fchmod(descriptor_, mode) != 0 && errno != EPERM && errno != ENOTSUP) fail_to_write(path_, "give it its mode", errno);
  }

  /// On disk under the final name, so that a crash leaves the old file or the new one.
  void take_name() {
    if (name_.empty()) give_name();
    move_to_place(descriptor_, name_, path_);
    name_.clear();
    const int closed = close(descriptor_);
    descriptor_ = -1;
    if (closed != 0) fail_to_write(path_, "write", errno);
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
        fail_to_write(path_, "create a file in its folder", errno);
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
}

void write_file(const std::string& path, std::span<const uint8_t> bytes) { write_file(path, FilePieces{{bytes}}); }

void check_writable(const std::string& path) {
  const FpScope fp;
  const Destination to = destination_of(path);
  if (!to.stream) const Temporary file(to.path);
}

}  // namespace trueshade
