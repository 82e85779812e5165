#include "scenes/files/content/scene_files.h"

#include <fcntl.h>
#include <linux/openat2.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <mutex>
#include <set>

#include "core/error.h"
#include "core/file_notes.h"
#include "core/memory_cap.h"

namespace trueshade {
namespace {

// O_NONBLOCK: opening a FIFO must not wait for its other end before fstat can refuse it.
constexpr int kOpenFlags = O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY;

const std::string kOrTrusted = ", or " + std::string(kTrustRemedy);

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }

 private:
  int fd_;
};

/// Bytes of a regular file; see read_user_file().
uint64_t checked_size(int fd, uint64_t limit, const std::string& where, std::string_view option) {
  struct stat status {};
  if (fstat(fd, &status) != 0) throw Error(ErrorKind::io, where, std::strerror(errno), "a file that can be read");
  if (!S_ISREG(status.st_mode))
    throw Error(ErrorKind::bad_input, where, "this is no regular file", "a file, no folder, pipe or device");
  const uint64_t size = uint64_t(status.st_size);
  if (size > limit)
    throw Error(ErrorKind::limit, where, std::to_string(size) + " bytes are over the limit",
                within_limit(limit, "bytes", option));
  return size;
}

Bytes content(int fd, uint64_t limit, const std::string& where, std::string_view option) {
  const uint64_t size = checked_size(fd, limit, where, option);
  require_memory(size, where, "the file");
  Bytes bytes(size_t{size});
  for (size_t done = 0; done < bytes.size();) {
    const ssize_t got = ::read(fd, bytes.data() + done, bytes.size() - done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw Error(ErrorKind::io, where, std::strerror(errno), "a file that can be read");
    if (got == 0) throw Error(ErrorKind::io, where, "the file became shorter while it was read", "try again");
    done += size_t(got);
  }
  return bytes;
}

/// `place` stands in errors, `path` in notes.
void check_opened(int fd, const std::string& place, const std::string& path) {
  if (fd >= 0) return;
  const int error = errno;
  note_read(path, kAbsent);
  if (error == EXDEV || error == ELOOP)
    throw Error(ErrorKind::bad_input, place, "a link leads out of the scene's folder",
                "a file inside the folder" + kOrTrusted);
  throw Error(ErrorKind::io, place, std::strerror(error), "a file that exists and can be read");
}

std::string folder_of(const std::string& path) {
  const size_t slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// RFC 3986: a letter, then letters, digits, + - . up to a colon.
bool has_scheme(std::string_view uri) {
  const size_t colon = uri.find_first_of(":/?#");
  return colon != std::string_view::npos && colon > 0 && uri[colon] == ':';
}

/// The lists in which paths are noted now. One set for the process, because the files of a scene are read on any
/// thread.
struct Notebooks {
  std::mutex mutex;
  std::set<std::set<std::string>*> open;
};

Notebooks& notebooks() {
  static Notebooks all;
  return all;
}

bool climbs_out(std::string_view path) {
  int depth = 0;
  for (size_t start = 0; start <= path.size();) {
    const size_t end = std::min(path.find('/', start), path.size());
    const std::string_view step = path.substr(start, end - start);
    if (step == "..")
      --depth;
    else if (!step.empty() && step != ".")
      ++depth;
    if (depth < 0) return true;
    start = end + 1;
  }
  return false;
}

}  // namespace

FilesRead::FilesRead() {
  const std::lock_guard lock(notebooks().mutex);
  notebooks().open.insert(&paths_);
}

FilesRead::~FilesRead() {
  const std::lock_guard lock(notebooks().mutex);
  notebooks().open.erase(&paths_);
}

std::vector<std::string> FilesRead::paths() const {
  const std::lock_guard lock(notebooks().mutex);
  return {paths_.begin(), paths_.end()};
}

void FilesRead::note(const std::string& path) {
  const std::lock_guard lock(notebooks().mutex);
  for (std::set<std::string>* const paths : notebooks().open) paths->insert(path);
}

Bytes read_user_file(const std::string& path, uint64_t limit, std::string_view option) {
  FilesRead::note(path);
  const Descriptor file(open(path.c_str(), kOpenFlags));
  if (file.get() < 0) {
    const int error = errno;
    note_read(path, kAbsent);
    throw Error(ErrorKind::io, path, std::strerror(error), "a file that exists and can be read");
  }
  Bytes bytes = content(file.get(), limit, path, option);
  note_read(path, bytes);
  return bytes;
}

std::string path_below(const std::string& folder_path, const std::string& path) {
  return path.starts_with('/') ? path : folder_path + path;
}

std::string path_from_uri(std::string_view uri, std::string_view where, NamedPaths paths) {
  const std::string remedy = "a path relative to the scene's folder and inside it";
  const auto fail = [&](const char* reason) { throw Error(ErrorKind::bad_input, where, reason, remedy); };
  const auto fail_unless_trusted = [&](const char* reason) {
    if (paths == NamedPaths::inside) throw Error(ErrorKind::bad_input, where, reason, remedy + kOrTrusted);
  };
  if (has_scheme(uri)) fail(uri[1] == ':' ? "the path begins with a drive of Windows" : "the path has a scheme");
  std::string path;
  for (size_t i = 0; i < uri.size(); ++i) {
    char c = uri[i];
    if (c == '%') {
      const int high = i + 2 < uri.size() ? hex_digit(uri[i + 1]) : -1,
                low = i + 2 < uri.size() ? hex_digit(uri[i + 2]) : -1;
      if (high < 0 || low < 0) fail("the path has a % without two hexadecimal digits");
      c = char(high * 16 + low);
      i += 2;
    }
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) fail("the path has a control character");
    if (c == '\\') fail("the path has a backslash");
    path += c;
  }
  if (path.empty()) fail("the path is empty");
  if (path[0] == '/') fail_unless_trusted("the path is absolute");
  if (climbs_out(path)) fail_unless_trusted("the path leaves the scene's folder");
  if (path.size() >= PATH_MAX) fail("the path is too long");
  return path;
}

SceneFolder::SceneFolder(const std::string& scene_path, NamedPaths paths)
    : name_(folder_of(scene_path)), paths_(paths) {
  folder_ = open(name_.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
  if (folder_ < 0)
    throw Error(ErrorKind::io, scene_path, std::string("its folder: ") + std::strerror(errno),
                "a folder that can be read");
}

SceneFolder::~SceneFolder() { close(folder_); }

int SceneFolder::open_named(const std::string& path, bool portable) const {
  FilesRead::note(path_of(path));
  if (paths_ == NamedPaths::any) return openat(folder_, path.c_str(), kOpenFlags);
  return open_beneath(path, portable);
}

int SceneFolder::open_beneath(const std::string& relative, bool portable) const {
  if (!portable) {
    open_how how{};
    how.flags = uint64_t(kOpenFlags);
    how.resolve = RESOLVE_BENEATH | RESOLVE_NO_MAGICLINKS;
    const long fd = syscall(SYS_openat2, folder_, relative.c_str(), &how, sizeof how);
    if (fd >= 0 || (errno != ENOSYS && errno != EPERM)) return int(fd);  // EPERM: a sandbox that knows no openat2
  }
  const auto resolved = [](const std::string& path) {
    const std::unique_ptr<char, decltype(&std::free)> real(realpath(path.c_str(), nullptr), &std::free);
    return real ? std::string(real.get()) : std::string();
  };
  const std::string folder = resolved(name_), file = resolved(path_of(relative));
  if (folder.empty() || file.empty()) return -1;
  if (!file.starts_with(folder == "/" ? folder : folder + "/")) {
    errno = EXDEV;
    return -1;
  }
  return open(file.c_str(), kOpenFlags | O_NOFOLLOW);
}

Bytes SceneFolder::read(const std::string& path, uint64_t limit, std::string_view where, bool portable) const {
  const Descriptor file(open_named(path, portable));
  const std::string place = std::string(where) + ": " + path;
  check_opened(file.get(), place, path_of(path));
  Bytes bytes = content(file.get(), limit, place, "--max-file");
  note_read(path_of(path), bytes);
  return bytes;
}

void SceneFolder::check(const std::string& path, uint64_t limit, std::string_view where) const {
  const Descriptor file(open_named(path, false));
  const std::string place = std::string(where) + ": " + path;
  check_opened(file.get(), place, path_of(path));
  checked_size(file.get(), limit, place, "--max-file");
  note_read(path_of(path), kThere);
}

}  // namespace trueshade
