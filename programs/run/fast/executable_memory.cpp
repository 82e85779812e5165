#include "programs/run/fast/executable_memory.h"

#include <sys/mman.h>

#include <cstring>

namespace trueshade::programs {

ExecutableMemory::ExecutableMemory(std::span<const uint8_t> code) {
  void* const pages = mmap(nullptr, code.size(), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (pages == MAP_FAILED) return;
  std::memcpy(pages, code.data(), code.size());
  if (mprotect(pages, code.size(), PROT_READ | PROT_EXEC) == 0)
    data_ = pages, size_ = code.size();
  else
    munmap(pages, code.size());
}

ExecutableMemory::~ExecutableMemory() {
  if (data_ != nullptr) munmap(data_, size_);
}

}  // namespace trueshade::programs
