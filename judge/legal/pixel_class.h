#pragma once
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace trueshade::oracle {

/// How a pixel compares with what the profile allows, and why it may differ from the nominal value (docs/gl_rules.md
/// section 7). The image passes where no pixel is a violation.
enum class PixelClass : uint8_t {
  exact,    ///< the value that the profile's nominal vertices, order and rounding give (float planes: within the bound)
  store_2,  ///< the nominal surface, some channel stored as another legal neighbour
  edge,     ///< another surface, whose edge the profile allows on either side of the sample
  depth_tie,  ///< another surface, whose depth the profile cannot tell from the nominal one's
  clip,       ///< another surface, at an edge made by clipping
  branch,     ///< a comparison in the shader may go either way
  tex,        ///< a texture lookup, or the alpha test it decides, has several legal results
  undefined,  ///< OpenGL gives the value no meaning: normalize(0), a triangle that may have no area
  violation,  ///< in no legal set
  left_out,   ///< not judged: no class of the others, and in none of the figures
};
inline constexpr size_t kPixelClasses = 9;  ///< but for left_out
/// The name of a class in reports: `DEPTH-TIE`.
std::string_view text(PixelClass c);

/// Whether pixels of that class show another surface, or another branch of the shader, than the nominal one.
inline bool shows_another(PixelClass c) {
  return c == PixelClass::edge || c == PixelClass::depth_tie || c == PixelClass::clip || c == PixelClass::branch;
}

/// Whether class `a` outranks class `b`: a pixel that gets both, by two draws or planes, keeps `a`.
bool worse(PixelClass a, PixelClass b);

}  // namespace trueshade::oracle
