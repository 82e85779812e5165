#pragma once
#include <cstddef>
#include <cstdlib>
#include <new>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace trueshade {

/// An allocator for arrays of many megabytes that are read at scattered places. It asks the system for large pages,
/// with which such reads seldom wait for page tables. Every array begins at a cache line.
template <class T>
struct HugePages {
  using value_type = T;
  static constexpr size_t kPage = size_t(1) << 21;
  static constexpr std::align_val_t kLine{64};
  static_assert(alignof(T) <= 64);

  HugePages() = default;
  template <class U>
  HugePages(const HugePages<U>&) {}  // NOLINT: allocators convert

  T* allocate(size_t count) {
    const size_t bytes = count * sizeof(T);
    if (bytes < 2 * kPage) return static_cast<T*>(::operator new(bytes, kLine));
    void* const memory = std::aligned_alloc(kPage, (bytes + kPage - 1) / kPage * kPage);
    if (memory == nullptr) throw std::bad_alloc();
#ifdef __linux__
    madvise(memory, bytes / kPage * kPage, MADV_HUGEPAGE);  // a wish: whether it is granted changes nothing else
#endif
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, size_t count) {
    if (count * sizeof(T) < 2 * kPage)
      ::operator delete(memory, kLine);
    else
      std::free(memory);
  }
  bool operator==(const HugePages&) const = default;
};

template <class T>
using HugeVector = std::vector<T, HugePages<T>>;

}  // namespace trueshade
