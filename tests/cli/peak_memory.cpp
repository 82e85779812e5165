// peak_memory COMMAND ARGUMENT...: runs a command, prints the most memory it had, in kB, and ends as it did. A process that has started
// others before cannot tell this: getrusage() gives the largest of all, and a child begins with the size of its parent.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>

int main(int count, char** arguments) {
  if (count < 2) return 2;
  const pid_t child = fork();
  if (child == 0) {
    execv(arguments[1], arguments + 1);
    _exit(127);
  }
  int status = 0;
  rusage usage{};
  if (child < 0 || wait4(child, &status, 0, &usage) != child || !WIFEXITED(status)) return 1;
  std::printf("peak %ld\n", usage.ru_maxrss);
  return WEXITSTATUS(status);
}
