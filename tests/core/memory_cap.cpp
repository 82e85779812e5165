#include "core/memory_cap.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cstring>
#include <string>

#include "core/error.h"
#include "tests/catch.hpp"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

TEST_CASE("the least limit of a control group and its parents counts") {
  const ScratchFolder root;
  root.write("memory.max", "max\n");
  root.write("a/memory.max", "1048576\n");
  root.write("a/b/memory.max", "4194304\n");
  root.write("c/memory.limit_in_bytes", "77\n");
  const std::string folder = root.path("");
  CHECK(least_group_limit(folder, "/a/b", "memory.max") == 1048576);
  CHECK(least_group_limit(folder, "/a", "memory.max") == 1048576);
  CHECK(least_group_limit(folder, "/", "memory.max") == UINT64_MAX);
  CHECK(least_group_limit(folder, "/gone/deeper", "memory.max") == UINT64_MAX);
  CHECK(least_group_limit(folder, "/c", "memory.limit_in_bytes") == 77);
  root.write("memory.max", "12\n");
  CHECK(least_group_limit(folder, "/a/b", "memory.max") == 12);
}

TEST_CASE("what is resident is counted, and memory over the cap is refused by the option's name") {
  CHECK(available_memory() <= uint64_t(sysconf(_SC_PHYS_PAGES)) * uint64_t(sysconf(_SC_PAGESIZE)));
  CHECK(memory_cap() == available_memory() / 2);
  const uint64_t before = resident_memory(), more = uint64_t(64) << 20;
  void* const pages = mmap(nullptr, more, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  REQUIRE(pages != MAP_FAILED);
  std::memset(pages, 1, more);
  CHECK(resident_memory() >= before + more);
  munmap(pages, more);
  set_memory_cap(before + 4 * more);
  CHECK_NOTHROW(require_memory(more, "f", "the file"));
  try {
    require_memory(8 * more, "f", "the file");
    FAIL("nothing was refused");
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::limit);
    CHECK(std::string(error.what()).starts_with("f: the file needs 512 MiB besides the "));
    CHECK(std::string(error.what()).find("--max-memory") != std::string::npos);
  }
  CHECK_THROWS_AS(require_memory(UINT64_MAX, "f", "the file"), Error);
  set_memory_cap(0);
}

}  // namespace
}  // namespace trueshade
