#include "farm/mpi/known_process.h"

#include <cstdio>
#include <cstring>
#include <string>

namespace trueshade {

KnownProcess known_process(int number) {
  char text[1024];
  std::FILE* const file = std::fopen(("/proc/" + std::to_string(number) + "/stat").c_str(), "re");
  if (file == nullptr) return {number, 0};
  const size_t size = std::fread(text, 1, sizeof text - 1, file);
  std::fclose(file);
  text[size] = '\0';
  const char* const fields = std::strrchr(text, ')');  // behind the name, which may hold anything
  char state = 'X';
  unsigned long long started = 0;
  // Fields 3 and 22.
  if (fields == nullptr ||
      std::sscanf(fields, ") %c %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %llu", &state,
                  &started) != 2 ||
      state == 'Z' || state == 'X')
    return {number, 0};
  return {number, started};
}

}  // namespace trueshade
