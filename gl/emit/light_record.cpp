#include "gl/emit/light_record.h"

#include <algorithm>
#include <bit>

#include "scenes/pipeline/light_values.h"

namespace trueshade::oracle {

std::string words_of_texel(size_t texel) {
  std::string words;
  for (const LightMember& m : kLightMembers)
    if (m.texel == texel) words += (words.empty() ? "" : "; ") + std::string(m.components) + ": " + std::string(m.name);
  return words;
}

namespace {

/// A float of a record.
struct Place {
  LightValue value;
  size_t at;        ///< among the floats of a light
  bool is_integer;  ///< of which the shader makes a uint
};

std::vector<Place> places_of(std::span<const size_t> texels) {
  constexpr std::string_view kComponents = "xyzw";
  std::vector<Place> places;
  for (const LightMember& m : kLightMembers) {
    const auto texel = std::find(texels.begin(), texels.end(), m.texel);
    for (size_t c = 0; c < m.components.size() && texel != texels.end(); ++c) {
      const std::string name = "light." + std::string(m.name) + (m.components.size() > 1 ? "." : "") +
                               std::string(m.components.size() > 1 ? kComponents.substr(c, 1) : "");
      places.push_back({light_value(name), 4 * size_t(texel - texels.begin()) + kComponents.find(m.components[c]),
                        !m.made_by.empty()});
    }
  }
  return places;
}

}  // namespace

std::vector<float> light_records(std::span<const Light> lights, std::span<const size_t> texels) {
  const std::vector<Place> places = places_of(texels);
  const size_t size = 4 * texels.size();
  std::vector<float> out(size * std::max<size_t>(lights.size(), 1));
  for (size_t i = 0; i < lights.size(); ++i)
    for (const Place& place : places) {
      const uint32_t bits = place.value.of(lights[i], uint32_t(i));
      out[i * size + place.at] = place.is_integer ? float(bits) : std::bit_cast<float>(bits);
    }
  return out;
}

}  // namespace trueshade::oracle
