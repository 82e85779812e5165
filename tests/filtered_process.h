#pragma once
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <iterator>

namespace trueshade::testing {

/// Runs `body` in a process of its own after a filter of system calls that `action` answers: mprotect() and mmap() that
/// ask for all of `protection`; or mprotect() alone. Returns what it ends with, or -1 where it is killed.
template <class Body>
int in_filtered_process(uint32_t action, uint32_t protection, const Body& body, bool maps_too = true) {
  const pid_t child = fork();
  if (child == 0) {
    const uint32_t third = offsetof(seccomp_data, args) + 2 * sizeof(uint64_t);  // its low half
    sock_filter code[] = {BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
                          BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, __NR_mprotect, 1, 0),
                          BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, uint32_t(maps_too ? __NR_mmap : __NR_mprotect), 0, 4),
                          BPF_STMT(BPF_LD | BPF_W | BPF_ABS, third),
                          BPF_STMT(BPF_ALU | BPF_AND | BPF_K, protection),
                          BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, protection, 0, 1),
                          BPF_STMT(BPF_RET | BPF_K, action),
                          BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW)};
    const sock_fprog program{static_cast<unsigned short>(std::size(code)), code};
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 || prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) != 0)
      _exit(99);
    _exit(body());
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace trueshade::testing
