#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <span>

#include "core/file_notes.h"
#include "core/fp_env.h"
#include "core/image_files/file_aside.h"
#include "core/image_files/file_place.h"
#include "core/image_files/image_io.h"

namespace trueshade {
namespace {

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
  note_written(path, pieces);
}

void write_file(const std::string& path, std::span<const uint8_t> bytes) { write_file(path, FilePieces{{bytes}}); }

void check_writable(const std::string& path) {
  const FpScope fp;
  const Destination to = destination_of(path);
  if (!to.stream) const FileAside file(to.path);
}

}  // namespace trueshade
