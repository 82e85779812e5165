#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/pipeline/pipeline.h"

// How a light stands in the buffer `lights`, as RGBA32F texels.
namespace trueshade::oracle {

/// A member of `Light` in programs/light_interface.glsl: which components of which texel it is.
struct LightMember {
  std::string_view name;
  size_t texel;
  std::string_view components;    ///< "xyz", "w"
  std::string_view made_by = {};  ///< a function that makes it of them; empty: it is they
};

/// Every member there but `shadow`, `cookie` and `user`, by ascending texel. A new one takes a component that no row
/// has, or a texel behind the others.
inline constexpr LightMember kLightMembers[] = {
    {"position", 0, "xyz"},    {"type", 0, "w", "ts_type_of"},
    {"color", 1, "xyz"},       {"range", 1, "w"},
    {"direction", 2, "xyz"},   {"cos_outer", 2, "w"},
    {"attenuation", 3, "xyz"}, {"spot_exponent", 3, "w"},
    {"ambient", 4, "xyz"},     {"index", 4, "w", "uint"},
    {"cone", 5, "x"},          {"penumbra", 5, "y"},
    {"cos_inner", 5, "z"},     {"penumbra_slope", 5, "w"},
    {"cone_scale", 6, "x"},    {"cone_offset", 6, "y"},
    {"cutoff_slope", 6, "z"},  {"right", 7, "xyz"},
    {"up", 8, "xyz"},
};

/// Texels that a light may have; light_texels() says which of them it has.
inline constexpr size_t kLightTexels = kLightMembers[std::size(kLightMembers) - 1].texel + 1;

/// What a texel holds, in words: "xyz: position; w: type".
std::string words_of_texel(size_t texel);

/// The buffer: of each light these texels; of no light, zeros for one.
std::vector<float> light_records(std::span<const Light> lights, std::span<const size_t> texels);

}  // namespace trueshade::oracle
