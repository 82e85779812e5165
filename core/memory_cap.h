#pragma once
#include <cstdint>
#include <string_view>

// A limit on the memory that the process uses. The process has one such limit, like a limit of setrlimit(): what it
// loads, draws and writes is in memory at the same time, so all of it counts.
namespace trueshade {

/// Bytes of memory that the process can have: the memory of the machine, or the least limit of the control groups that
/// the process is in and of their parents (memory.max of version 2, memory.limit_in_bytes of version 1), if that is
/// less.
uint64_t available_memory();

/// The limit in bytes. It is half of available_memory() until set_memory_cap() is called.
uint64_t memory_cap();
/// Sets the limit in bytes.
void set_memory_cap(uint64_t bytes);

/// Bytes of memory that the process uses (Linux, proc(5): /proc/self/statm), without the parts of mapped files that are
/// in memory. The system takes these back when it needs room.
uint64_t resident_memory();
/// resident_memory() with the parts of mapped files.
uint64_t resident_memory_with_files();

/// Is called before memory is taken. Throws Error(limit) that names --max-memory if resident_memory() plus `bytes` is
/// over the limit. `what` names what needs the memory, such as "the picture", and `remedy` what asks for less of it.
void require_memory(uint64_t bytes, std::string_view where, std::string_view what,
                    std::string_view remedy = "ask for less");

/// The least limit of a control group and its parents. `group` is a path below `root`, such as /a/b; each folder on the
/// path may hold a file `name` with a number or `max`. UINT64_MAX if no file has a number.
uint64_t least_group_limit(std::string_view root, std::string_view group, std::string_view name);

}  // namespace trueshade
