#pragma once
#include <cstdint>
#include <string_view>

#include "scenes/texture.h"

namespace trueshade {

enum class Pattern : uint8_t {
  checker,  ///< cells of the first and the second colour by turns, the first at uv (0, 0)
  brick,    ///< bricks of the first colour, each a little darker or not, in running bond; joints of the second
  noise,    ///< from the first to the second colour by value noise of four octaves
};
inline constexpr std::string_view kPatternNames[] = {"checker", "brick", "noise"};

/// A texture that needs no file. It repeats without a seam (checker and brick: for an even number of cells).
struct TexturePattern {
  Pattern pattern = Pattern::checker;
  int width = 256, height = 256;
  TextureFormat format = TextureFormat::srgb8_a8;
  std::array<glm::vec4, 2> colors{glm::vec4(1.0f), glm::vec4(0.2f, 0.2f, 0.2f, 1.0f)};  ///< linear RGBA
  int columns = 8, rows = 8;  ///< cells, or bricks, or lattice cells of the first octave; 1..1024 each
  uint64_t seed = 0;          ///< of brick and noise
};

/// One level, by integers and + - * / alone: the same bits everywhere.
Texture texture_of(const TexturePattern& pattern);

}  // namespace trueshade
