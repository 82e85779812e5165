#pragma once
#include <cstdint>
#include <string>

namespace trueshade {

/// What standard output carries beside the names of files.
enum class StandardOutput : uint8_t {
  files,   ///< nothing, or text for people: the names go there too
  answer,  ///< --hash, --stats or --json, which programs read: the names go to standard error
};

/// Says that a file is written: `wrote out/city.png (800x800 rgba8, PNG, 1.2 MB)`. `about` is what stands before the
/// size. A file that is standard output itself keeps its bytes: its line goes to standard error.
void say_written(const std::string& path, const std::string& about, StandardOutput standard_output);

/// write_file() of a text, into a folder that is made if it is not there.
void write_text(const std::string& path, const std::string& text);

/// `PNG` of a name that ends in .png.
std::string kind_of_file(const std::string& path);

}  // namespace trueshade
