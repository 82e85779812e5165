#pragma once
#include <cstdint>
#include <string_view>

// The memory that the process may come to use. It is one number of the process, as a limit of setrlimit() is: whatever
// is loaded, drawn and written counts against it, because all of it is resident at once.
namespace trueshade {

/// Bytes of memory that the process can have: the machine's, or the least limit of its control groups, where that is
/// less (memory.max of version 2 and memory.limit_in_bytes of version 1, the group's own and those of its parents).
uint64_t available_memory();

/// The limit; half of available_memory() until set_memory_cap() is called.
uint64_t memory_cap();
void set_memory_cap(uint64_t bytes);

/// Bytes of the process that are in memory (Linux, proc(5): the second number of /proc/self/statm).
uint64_t resident_memory();

/// To be called before memory is taken: Error(limit) that names --max-memory where `bytes` more than are resident would
/// be over the cap. `what` needs them: "the picture".
void require_memory(uint64_t bytes, std::string_view where, std::string_view what);

/// The least limit along `group`, a path like /a/b, below `root`, where each folder may hold a file `name` with a
/// number or `max`; UINT64_MAX where none does.
uint64_t least_group_limit(std::string_view root, std::string_view group, std::string_view name);

}  // namespace trueshade
