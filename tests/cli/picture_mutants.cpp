// picture_mutants COUNT: changes each of a dozen small EXR and JPEG files in COUNT ways and decodes every mutant as
// scene textures and `trueshade info` do: no crash, no two seconds, no memory over the cap, and an error is one line.
// Mutants run in children, which OpenImageIO's threads need started anew; one that ends its child is named and written
// to mutant-KIND-NUMBER in the working folder. picture_mutants KIND FIRST END SECONDS: is such a child, and may be run
// under valgrind.

#include <cstddef>
#include <cstdio>

// clang-format off
#include <jpeglib.h>  // needs what stands before it
// clang-format on

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/image_files/channel_file.h"
#include "core/image_files/image_io.h"
#include "core/memory_cap.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

using Bytes = std::vector<uint8_t>;

constexpr uint64_t kCap = uint64_t(512) << 20, kSlack = uint64_t(64) << 20;
constexpr int kSeconds = 2, kWidth = 40, kHeight = 70;

[[noreturn]] void fail(const std::string& what) {
  std::fprintf(stderr, "picture_mutants: %s\n", what.c_str());
  std::_Exit(99);
}

/// Half a ramp and half noise, so that every way to compress has something to do.
float value_at(int x, int y, int channel) {
  const uint32_t noise = (uint32_t(x) * 73856093u ^ uint32_t(y) * 19349663u) * 2654435761u >> 24;
  return float(x + y * channel) / float(kWidth + kHeight) + (y % 16 < 8 ? 0.0f : float(noise) / 512.0f);
}

/// An EXR with R, G, B, A in halves, depths in floats and identifiers; in tiles where `tile` is above 0.
Bytes exr_of(const std::string& compression, int tile) {
  OIIO::ImageSpec spec(kWidth, kHeight, 6, OIIO::TypeDesc::FLOAT);
  spec.channelnames = {"R", "G", "B", "A", "depth.Z", "id.object"};
  spec.channelformats = {OIIO::TypeDesc::HALF, OIIO::TypeDesc::HALF,  OIIO::TypeDesc::HALF,
                         OIIO::TypeDesc::HALF, OIIO::TypeDesc::FLOAT, OIIO::TypeDesc::UINT32};
  spec.attribute("Compression", compression);
  spec.attribute("note", "a text");
  spec.tile_width = spec.tile_height = tile;
  std::vector<float> values;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (int channel = 0; channel < 6; ++channel) values.push_back(value_at(x, y, channel));
  Bytes bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const auto file = OIIO::ImageOutput::create("openexr");
  if (!file || !file->set_ioproxy(&memory) || !file->open("seed.exr", spec) ||
      !file->write_image(OIIO::TypeDesc::FLOAT, values.data()) || !file->close())
    fail("no EXR by " + compression);
  return bytes;
}

/// An EXR of two parts.
Bytes exr_of_parts() {
  std::vector<OIIO::ImageSpec> specs(2, OIIO::ImageSpec(kWidth, kHeight, 3, OIIO::TypeDesc::FLOAT));
  specs[0].attribute("oiio:subimagename", "normals");
  specs[1].attribute("oiio:subimagename", "positions");
  std::vector<float> values;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (int channel = 0; channel < 3; ++channel) values.push_back(value_at(x, y, channel));
  const ScratchFolder folder;  // OpenImageIO writes parts into files alone
  const std::string path = folder.path("seed.exr");
  const auto file = OIIO::ImageOutput::create("openexr");
  if (!file || !file->open(path, 2, specs.data()) || !file->write_image(OIIO::TypeDesc::FLOAT, values.data()) ||
      !file->open(path, specs[1], OIIO::ImageOutput::AppendSubimage) ||
      !file->write_image(OIIO::TypeDesc::FLOAT, values.data()) || !file->close())
    fail("no EXR of parts");
  std::ifstream written(path, std::ios::binary);
  return Bytes(std::istreambuf_iterator<char>(written), {});
}

struct JpegKind {
  int components, sampling;
  bool progressive;
  int restart_rows;
};

Bytes jpeg_of(const JpegKind& kind) {
  jpeg_compress_struct encoder{};
  jpeg_error_mgr errors{};
  encoder.err = jpeg_std_error(&errors);
  jpeg_create_compress(&encoder);
  unsigned char* buffer = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&encoder, &buffer, &size);
  encoder.image_width = kWidth, encoder.image_height = kHeight;
  encoder.input_components = kind.components;
  encoder.in_color_space = kind.components == 1 ? JCS_GRAYSCALE : JCS_RGB;
  jpeg_set_defaults(&encoder);
  encoder.comp_info[0].h_samp_factor = encoder.comp_info[0].v_samp_factor = kind.sampling;
  encoder.restart_in_rows = kind.restart_rows;
  if (kind.progressive) jpeg_simple_progression(&encoder);
  jpeg_start_compress(&encoder, TRUE);
  for (int y = 0; y < kHeight; ++y) {
    Bytes row;
    for (int x = 0; x < kWidth; ++x)
      for (int channel = 0; channel < kind.components; ++channel)
        row.push_back(uint8_t(255.0f * std::min(1.0f, value_at(x, y, channel))));
    JSAMPROW rows[] = {row.data()};
    jpeg_write_scanlines(&encoder, rows, 1);
  }
  jpeg_finish_compress(&encoder);
  Bytes bytes(buffer, buffer + size);
  jpeg_destroy_compress(&encoder);
  std::free(buffer);
  return bytes;
}

constexpr const char* kKinds[] = {
    "exr-none", "exr-rle",  "exr-zips",  "exr-zip",   "exr-piz",   "exr-pxr24",  "exr-b44",          "exr-b44a",
    "exr-dwaa", "exr-dwab", "exr-tiles", "exr-parts", "jpeg-grey", "jpeg-color", "jpeg-progressive", "jpeg-restarts"};

Bytes seed_of(const std::string& kind) {
  if (kind == "exr-tiles") return exr_of("zip", 16);
  if (kind == "exr-parts") return exr_of_parts();
  if (kind.starts_with("exr-")) return exr_of(kind.substr(4), 0);
  if (kind == "jpeg-grey") return jpeg_of({1, 1, false, 0});
  if (kind == "jpeg-color") return jpeg_of({3, 2, false, 0});
  if (kind == "jpeg-progressive") return jpeg_of({3, 2, true, 0});
  if (kind == "jpeg-restarts") return jpeg_of({3, 1, false, 1});
  fail("there is no kind " + kind);
}

/// A number that breaks programs, written as 4 bytes of either order.
void put_hostile_word(Bytes& bytes, size_t at, uint64_t random) {
  constexpr uint32_t kWords[] = {0,          1,          0x7f,       0xff,       0xffff,     0x10000,
                                 0x7fffffff, 0x80000000, 0xffffffff, 0x00010000, 0x7fffffff, 0x3fffffff};
  const uint32_t word = kWords[random % std::size(kWords)];
  for (size_t k = 0; k < 4 && at + k < bytes.size(); ++k)
    bytes[at + k] = uint8_t(word >> 8 * (random % 2 == 0 ? k : 3 - k));
}

/// One change. A quarter of all are in the first 512 bytes, where headers are.
void change(Bytes& bytes, std::mt19937_64& random) {
  const auto below = [&](size_t count) { return size_t(random() % std::max<size_t>(count, 1)); };
  const size_t at = below(below(4) == 0 ? std::min<size_t>(bytes.size(), 512) : bytes.size());
  const size_t length = std::min(1 + below(64), bytes.size() - at);
  const auto begin = bytes.begin() + ptrdiff_t(at), end = begin + ptrdiff_t(length);
  switch (below(8)) {
    case 0:
      bytes[at] ^= uint8_t(1u << below(8));
      return;
    case 1:
      bytes[at] = uint8_t(random());
      return;
    case 2:
    case 3:
      return put_hostile_word(bytes, at, random());
    case 4:
      std::generate(begin, end, [&] { return uint8_t(random()); });
      return;
    case 5:
      bytes.erase(begin, end);
      break;
    case 6: {
      const Bytes copy(begin, end);
      bytes.insert(bytes.begin() + ptrdiff_t(below(bytes.size())), copy.begin(), copy.end());
      return;
    }
    default:
      if (below(4) == 0) bytes.resize(at);
  }
  if (bytes.empty()) bytes.push_back(0);
}

Bytes mutant_of(const Bytes& seed, const std::string& kind, uint64_t number) {
  std::mt19937_64 random(number * 1000003u + kind.size() * 8191u + uint8_t(kind.back()));
  Bytes bytes = seed;
  for (uint64_t changes = 1 + random() % 3; changes > 0; --changes) change(bytes, random);
  return bytes;
}

/// Bytes that the process had at most since it last was asked (proc(5): clear_refs).
uint64_t peak_memory() {
  std::ifstream status("/proc/self/status");
  std::string word;
  uint64_t kilobytes = 0;
  while (status >> word)
    if (word == "VmHWM:") status >> kilobytes;
  std::ofstream("/proc/self/clear_refs") << '5';
  return kilobytes * 1024;
}

template <typename Job>
bool succeeds(Job job) {
  try {
    job();
    return true;
  } catch (const Error& error) {
    const std::string_view text = error.what();
    if (text.find('\n') != std::string_view::npos || !text.ends_with(")")) fail("an error of several lines");
    return false;
  }
}

void write_at_start(int file, std::span<const uint8_t> bytes) {
  if (pwrite(file, bytes.data(), bytes.size(), 0) != ssize_t(bytes.size())) fail("a file cannot be written");
}

template <typename... Numbers>
void note(Numbers... numbers) {
  const uint64_t list[] = {numbers...};
  write_at_start(STDOUT_FILENO, {reinterpret_cast<const uint8_t*>(list), sizeof list});
}

int run_child(const std::string& kind, uint64_t first, uint64_t end, unsigned seconds) {
  const Bytes seed = seed_of(kind);
  const int file = memfd_create("mutant", 0);
  const std::string path = "/proc/self/fd/" + std::to_string(file);
  set_memory_cap(kCap);
  uint64_t decoded = 0, most = 0;
  peak_memory();
  for (uint64_t number = first; number < end; ++number) {
    const Bytes bytes = mutant_of(seed, kind, number);
    note(number);
    alarm(seconds);
    decoded += succeeds([&] {
      const Image image = decode_image(bytes, "mutant", kCap);
      if (image.texels.size() !=
          size_t(image.width) * size_t(image.height) * size_t(info(image.format).bytes_per_texel()))
        fail("a picture of the wrong size");
    });
    if (kind.starts_with("exr")) {
      if (ftruncate(file, 0) != 0) fail("a file cannot be written");
      write_at_start(file, bytes);
      succeeds([&] { read_image_info(path); });
      succeeds([&] { read_planes(path); });
      succeeds([&] { read_channel_file(path, kMostExpansion); });
    }
    alarm(0);
    most = std::max(most, peak_memory());
    if (most > kCap + kSlack) fail("memory over the cap");
  }
  note(end, decoded, most);
  return 0;
}

/// How a child ended: the mutant that it was at, and the signal or exit code.
struct Ending {
  uint64_t number = 0, decoded = 0, most = 0;
  int status = 0;
};

Ending child(const char* program, const std::string& kind, uint64_t first, uint64_t end, const std::string& notes) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, notes.c_str(), O_RDWR | O_CREAT | O_TRUNC, 0600);
  std::string words[] = {program, kind, std::to_string(first), std::to_string(end), std::to_string(kSeconds)};
  char* arguments[] = {words[0].data(), words[1].data(), words[2].data(), words[3].data(), words[4].data(), nullptr};
  pid_t process = 0;
  Ending ending;
  if (posix_spawn(&process, program, &actions, nullptr, arguments, environ) != 0) fail("a child cannot be started");
  posix_spawn_file_actions_destroy(&actions);
  waitpid(process, &ending.status, 0);
  std::ifstream file(notes, std::ios::binary);
  file.read(reinterpret_cast<char*>(&ending), 3 * sizeof(uint64_t));
  return ending;
}

/// Findings among the mutants of one file.
int run_kind(const char* program, const std::string& kind, uint64_t count, const std::string& notes) {
  int findings = 0;
  uint64_t first = 0, decoded = 0, most = 0;
  while (first < count) {
    const Ending ending = child(program, kind, first, count, notes);
    decoded += ending.decoded, most = std::max(most, ending.most);
    first = ending.number;
    if (ending.status == 0) break;
    ++findings;
    const std::string name = "mutant-" + kind + "-" + std::to_string(first);
    const Bytes bytes = mutant_of(seed_of(kind), kind, first);
    std::ofstream(name, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    std::printf("%s: %s %d\n", name.c_str(), WIFSIGNALED(ending.status) ? "signal" : "exit code",
                WIFSIGNALED(ending.status) ? WTERMSIG(ending.status) : WEXITSTATUS(ending.status));
    ++first;
  }
  std::printf("%-17s %6llu mutants, %6llu decoded, at most %llu MiB, %d findings\n", kind.c_str(),
              static_cast<unsigned long long>(count), static_cast<unsigned long long>(decoded),
              static_cast<unsigned long long>(most >> 20), findings);
  std::fflush(stdout);
  return findings;
}

}  // namespace
}  // namespace trueshade

int main(int count, char** arguments) {
  using namespace trueshade;
  const auto number = [&](int i) { return std::strtoull(arguments[i], nullptr, 10); };
  if (count == 5) return run_child(arguments[1], number(2), number(3), unsigned(number(4)));
  if (count != 2) return std::fprintf(stderr, "picture_mutants COUNT\n"), 2;
  const ScratchFolder folder;
  int findings = 0;
  for (const char* kind : kKinds) findings += run_kind("/proc/self/exe", kind, number(1), folder.path("notes"));
  return findings == 0 ? 0 : 1;
}
