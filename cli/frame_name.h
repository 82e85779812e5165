#pragma once
#include <string>

namespace trueshade {

/// The name of one frame's file: the number in the place of the first `%d`, `%05d` (any width to 9) or run of `#` in
/// the file's name; else, four digits and a dot before the ending: `out/city.png` is `out/city.0007.png`. A number
/// longer than its place keeps all its digits.
std::string frame_name(const std::string& path, int frame);

}  // namespace trueshade
