#include "scene_cache/checked_file.h"

#include <fcntl.h>
#include <libdeflate.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>

#include "core/error.h"
#include "core/memory_cap.h"
#include "core/threads/parallel_for.h"

namespace trueshade {
namespace {

constexpr uint64_t kMagic = 0x0a31686361435354;  // "TSCach1\n"
constexpr uint32_t kFormat = 4;                  // of everything in the file, the tables too
constexpr size_t kAlignment = 64;

struct Footer {
  uint64_t magic = kMagic;
  uint32_t format = kFormat;
  uint32_t checksum_of_checksums = 0;
  uint64_t tables = 0, tables_bytes = 0;  ///< where the tables are
  uint64_t content = 0;                   ///< bytes of arrays and tables; the checksums come next
  uint64_t size = 0;                      ///< of the file
  uint32_t unused = 0;
  uint32_t checksum = 0;  ///< of the footer up to here
};
static_assert(sizeof(Footer) == 56);

uint32_t checksum_of(const Footer& footer) { return libdeflate_crc32(0, &footer, offsetof(Footer, checksum)); }

template <class T>
std::span<const uint8_t> bytes_of(const T* first, size_t count) {
  return {reinterpret_cast<const uint8_t*>(first), count * sizeof(T)};
}

/// Whether nobody but the user and root can have written it.
bool is_ours(const struct stat& status) {
  return S_ISREG(status.st_mode) && (status.st_uid == geteuid() || status.st_uid == 0) &&
         (status.st_mode & (S_IWGRP | S_IWOTH)) == 0;
}

}  // namespace

uint64_t CheckedFileWriter::add(std::span<const uint8_t> array) {
  pad(kAlignment);
  const uint64_t at = size_;
  append(array);
  return at;
}

void CheckedFileWriter::finish(std::span<const uint8_t> tables) {
  Footer footer;
  footer.tables = add(tables), footer.tables_bytes = tables.size();
  pad(kAlignment);
  footer.content = size_;
  if (size_ % kSegmentBytes != 0) checksums_.push_back(checksum_);
  const std::span<const uint8_t> checksums = bytes_of(checksums_.data(), checksums_.size());
  footer.size = size_ + checksums.size() + sizeof footer;
  footer.checksum_of_checksums = libdeflate_crc32(0, checksums.data(), checksums.size());
  footer.checksum = checksum_of(footer);
  file_.write(checksums);
  file_.write(bytes_of(&footer, 1));
  file_.take_mode(S_IRUSR | S_IWUSR | S_IRGRP | S_IROTH);
  file_.take_name();
}

void CheckedFileWriter::append(std::span<const uint8_t> bytes) {
  file_.write(bytes);
  while (!bytes.empty()) {
    const size_t room = kSegmentBytes - size_ % kSegmentBytes, taken = std::min(room, bytes.size());
    checksum_ = libdeflate_crc32(checksum_, bytes.data(), taken);
    bytes = bytes.subspan(taken);
    size_ += taken;
    if (size_ % kSegmentBytes != 0) continue;
    checksums_.push_back(checksum_);
    checksum_ = 0;
  }
}

void CheckedFileWriter::pad(size_t alignment) {
  constexpr uint8_t kZeros[kAlignment] = {};
  append({kZeros, (alignment - size_ % alignment) % alignment});
}

CheckedFile::CheckedFile(std::string path, const uint8_t* map, size_t size)
    : path_(std::move(path)), map_(map), size_(size), checked_((size / kSegmentBytes) / 64 + 1) {}

CheckedFile::~CheckedFile() { munmap(const_cast<uint8_t*>(map_), size_); }

std::shared_ptr<const CheckedFile> CheckedFile::open(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (descriptor < 0) return nullptr;
  struct stat status {};
  void* map = MAP_FAILED;
  if (fstat(descriptor, &status) == 0 && is_ours(status) && size_t(status.st_size) >= sizeof(Footer))
    map = mmap(nullptr, size_t(status.st_size), PROT_READ, MAP_SHARED, descriptor, 0);
  close(descriptor);
  if (map == MAP_FAILED) return nullptr;
  const std::shared_ptr<CheckedFile> file(
      new CheckedFile(path, static_cast<const uint8_t*>(map), size_t(status.st_size)));
  return file->read_footer() ? file : nullptr;
}

bool CheckedFile::read_footer() {
  Footer footer;
  std::memcpy(&footer, map_ + size_ - sizeof footer, sizeof footer);
  if (footer.magic != kMagic || footer.format != kFormat || footer.checksum != checksum_of(footer) ||
      footer.size != size_ || footer.content > size_ || footer.content % kAlignment != 0)
    return false;
  const size_t segments = (footer.content + kSegmentBytes - 1) / kSegmentBytes;
  if (size_ - footer.content != segments * sizeof(uint32_t) + sizeof footer) return false;
  content_ = footer.content;
  checksums_ = reinterpret_cast<const uint32_t*>(map_ + content_);
  if (libdeflate_crc32(0, checksums_, segments * sizeof(uint32_t)) != footer.checksum_of_checksums) return false;
  const auto tables = bytes_at(footer.tables, footer.tables_bytes);
  if (!tables || tables->empty()) return false;
  const size_t last = (footer.tables + footer.tables_bytes - 1) / kSegmentBytes;
  for (size_t segment = footer.tables / kSegmentBytes; segment <= last; ++segment)
    if (!is_intact(segment)) return false;
  tables_ = *tables;
  return true;
}

std::optional<std::span<const uint8_t>> CheckedFile::bytes_at(uint64_t offset, uint64_t bytes) const {
  if (offset > content_ || bytes > content_ - offset) return std::nullopt;
  return std::span(map_ + offset, size_t(bytes));
}

void CheckedFile::fetch(const void* first, size_t bytes) const {
  const auto at = size_t(static_cast<const uint8_t*>(first) - map_), page = at / kSegmentBytes * kSegmentBytes;
  madvise(const_cast<uint8_t*>(map_) + page, bytes + (at - page), MADV_WILLNEED);  // a wish
}

bool CheckedFile::is_intact(size_t segment) const {
  const size_t first = segment * kSegmentBytes;
  return libdeflate_crc32(0, map_ + first, std::min(kSegmentBytes, content_ - first)) == checksums_[segment];
}

void CheckedFile::check_all() const {
  const size_t segments = (content_ + kSegmentBytes - 1) / kSegmentBytes;
  constexpr size_t kOfTask = 64;
  parallel_for(int((segments + kOfTask - 1) / kOfTask), 0, [&](int task) {
    const size_t first = size_t(task) * kOfTask * kSegmentBytes;
    check(map_ + first, std::min(kOfTask * kSegmentBytes, content_ - first));
  });
}

void CheckedFile::check_segment(size_t segment) const {
  if (!is_intact(segment))
    throw Error(ErrorKind::io, path_, "the bytes from " + std::to_string(segment * kSegmentBytes) + " on are damaged",
                "remove the file; it is made anew");
  checked_[segment / 64].fetch_or(uint64_t(1) << (segment % 64), std::memory_order_release);
  constexpr size_t kNowAndThen = 512;  // segments
  if (++checks_ % kNowAndThen == 0) stay_below_cap();
}

void CheckedFile::stay_below_cap() const {
  if (resident_memory_with_files() <= memory_cap()) return;
  for (std::atomic<uint64_t>& bits : checked_) bits.store(0, std::memory_order_release);
  madvise(const_cast<uint8_t*>(map_), size_, MADV_DONTNEED);
}

}  // namespace trueshade
