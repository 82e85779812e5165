// `trueshade view`: hands over to the program trueshade-view, which alone knows SDL and ImGui, so that the command
// starts without them. The program is looked for beside this one, then where `cmake --install` puts it.
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

#include "cli/commands.h"
#include "core/error.h"

namespace trueshade {

namespace {

/// The words that this program was called with, its name first.
std::vector<std::string> words_of_call() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> words;
  for (std::string word; std::getline(file, word, '\0');) words.push_back(word);
  return words;
}

}  // namespace

void view(const ViewOptions&) {
  namespace fs = std::filesystem;
  constexpr const char* kProgram = "trueshade-view";
  std::error_code absent;
  const fs::path here = fs::read_symlink("/proc/self/exe", absent).parent_path();
  if (absent) throw Error(ErrorKind::io, "/proc/self/exe", absent.message(), "a system with /proc");
  for (const char* folder : {".", "../lib/trueshade", "../" TRUESHADE_LIBDIR "/trueshade"}) {
    const fs::path path = here / folder / kProgram;
    if (!fs::exists(path, absent)) continue;
    std::vector<std::string> words = words_of_call();
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    execv(path.c_str(), arguments.data());
    throw Error(ErrorKind::io, path.string(), std::strerror(errno), "a program that can be started");
  }
  throw Error(ErrorKind::io, kProgram, "the window is not installed with this command",
              "install the package trueshade-view; or libsdl2-dev and libimgui-dev, and build anew");
}

}  // namespace trueshade
