// fuzz_replay: prints the names of the targets. fuzz_replay TARGET FOLDER...: runs a target over the files of folders.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/fuzz/targets.h"

int main(int count, char** arguments) {
  using namespace trueshade::fuzz;
  if (count == 1) {
    for (const Target& target : targets()) std::printf("%.*s\n", int(target.name.size()), target.name.data());
    return 0;
  }
  const Target* const target = target_named(arguments[1]);
  if (target == nullptr) return std::fprintf(stderr, "there is no target %s\n", arguments[1]), 2;
  std::vector<std::filesystem::path> files;
  for (int i = 2; i < count; ++i)
    for (const auto& entry : std::filesystem::directory_iterator(arguments[i]))
      if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const std::filesystem::path& path : files) {
    std::printf("%s\n", path.filename().c_str());  // the last one printed is the one that ended the process
    std::fflush(stdout);
    std::ifstream file(path, std::ios::binary);
    const std::vector<uint8_t> bytes{std::istreambuf_iterator<char>(file), {}};
    target->run(bytes);
  }
  std::printf("%zu files\n", files.size());
  return files.empty() ? 1 : 0;
}
