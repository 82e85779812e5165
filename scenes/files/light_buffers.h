#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "core/image.h"

// Lights as a GPU has them: a buffer of positions, one of colours, one of falloffs; sample i of each is light i.
namespace trueshade {

/// The samples of one buffer, from a table of three numbers a line, between commas, semicolons, tabs or spaces. A first
/// line without a number names the columns. Error(bad_input) behind `where` with the line, Error(limit) over `most`.
std::vector<glm::vec3> samples_from_csv(std::string_view text, const std::string& where, uint64_t most);

/// The same from R, G, B of a float image, texel after texel, rows top first. Error(bad_input) for 8 bits a channel.
std::vector<glm::vec3> samples_from_image(const Image& image, const std::string& where, uint64_t most);

}  // namespace trueshade
