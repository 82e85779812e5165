#pragma once
#include <optional>
#include <string>

namespace trueshade {

/// The path of a file that a picture's metadata names. Anybody may have made the picture, so the file is looked for
/// beneath the folder where the command runs and beneath the picture's own, and in the latter by the last part of its
/// name too; links that lead out are not followed. Nothing where it is in none of these places.
std::optional<std::string> file_named_by(const std::string& picture, const std::string& name);

}  // namespace trueshade
