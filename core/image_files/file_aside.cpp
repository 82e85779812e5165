#include "core/image_files/file_aside.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>

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

std::string temporary_name(const std::string& path, int attempt) {
  return folder_of_path(path) + "/.trueshade-" + std::to_string(getpid()) + "-" + std::to_string(attempt) + ".tmp";
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

}  // namespace

void fail_to(const std::string& path, const char* step, int error) {
  throw Error(ErrorKind::io, path, std::string("cannot ") + step + ": " + std::strerror(error), remedy(error));
}

std::string folder_of_path(const std::string& path) {
  const size_t slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

void write_bytes(int descriptor, const std::string& path, std::span<const uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail_to(path, "write", errno);
    bytes = bytes.subspan(size_t(written));
  }
}

void put_on_disk(int descriptor, const std::string& path) {
  if (fsync(descriptor) != 0 && errno != EINVAL) fail_to(path, "write to disk", errno);
}

void take_place(const std::string& from, const std::string& to) {
  if (rename(from.c_str(), to.c_str()) != 0) fail_to(to, "take this name", errno);
  const int folder = open(folder_of_path(to).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;  // a folder may be writable and not readable; its entry is then written when the system likes
  const int synced = fsync(folder) != 0 && errno != EINVAL ? errno : 0;
  close(folder);
  if (synced != 0) fail_to(to, "write its folder to disk", synced);
}

FileAside::FileAside(const std::string& path) : path_(path) {
  remove_abandoned(folder_of_path(path));
  // Its name is given through /proc, which a bare chroot may lack.
  if (access("/proc/self/fd", X_OK) == 0)
    descriptor_ = open(folder_of_path(path).c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666);
  for (int attempt = 0; descriptor_ < 0; ++attempt) {
    name_ = temporary_name(path, attempt);
    descriptor_ = open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (descriptor_ < 0 && (errno != EEXIST || attempt == 1000)) fail_to(path, "create a file in its folder", errno);
  }
  // The lock keeps remove_abandoned() of other processes from this file, also of processes that do not see this one's
  // number. Nobody else has opened the file, so the lock is free. Without locks the process number has to do.
  flock(descriptor_, LOCK_EX | LOCK_NB);
}

FileAside::~FileAside() {
  if (descriptor_ >= 0) close(descriptor_);
  if (!name_.empty()) unlink(name_.c_str());
}

void FileAside::write(std::span<const uint8_t> bytes) { write_bytes(descriptor_, path_, bytes); }

void FileAside::take_mode(mode_t mode) {
  if (fchmod(descriptor_, mode) != 0 && errno != EPERM && errno != ENOTSUP) fail_to(path_, "give it its mode", errno);
}

void FileAside::take_name() {
  put_on_disk(descriptor_, path_);  // before it has a name, which a process that is killed would leave behind
  if (name_.empty()) give_name();
  take_place(name_, path_);
  name_.clear();
  const int closed = close(descriptor_);
  descriptor_ = -1;
  if (closed != 0) fail_to(path_, "write", errno);
}

/// A file without a name cannot replace one; for the moment between this and rename it has a temporary's.
void FileAside::give_name() {
  const std::string self = "/proc/self/fd/" + std::to_string(descriptor_);
  for (int attempt = 0; name_.empty(); ++attempt) {
    const std::string name = temporary_name(path_, attempt);
    if (linkat(AT_FDCWD, self.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0)
      name_ = name;
    else if (errno != EEXIST || attempt == 1000)
      fail_to(path_, "create a file in its folder", errno);
  }
}

}  // namespace trueshade
