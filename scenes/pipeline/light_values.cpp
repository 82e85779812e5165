#include "scenes/pipeline/light_values.h"

#include <bit>

#include "scenes/light_cone.h"

namespace trueshade {
namespace {

uint32_t bits_of(float value) { return std::bit_cast<uint32_t>(value); }

/// A number that is no member of Light.
struct MadeValue {
  std::string_view name;
  uint32_t (*bits)(const Light&);
};
template <auto kMember>
constexpr auto kOfCone = [](const Light& l) { return bits_of(LightCone(l).*kMember); };
constexpr auto kNoTexture = [](const Light&) { return uint32_t(-1); };

constexpr MadeValue kMadeValues[] = {{"type", [](const Light& l) { return uint32_t(l.type); }},
                                     {"cos_inner", kOfCone<&LightCone::cos_inner>},
                                     {"cos_outer", kOfCone<&LightCone::cos_outer>},
                                     {"cone_scale", kOfCone<&LightCone::scale>},
                                     {"cone_offset", kOfCone<&LightCone::offset>},
                                     {"penumbra_slope", kOfCone<&LightCone::penumbra_slope>},
                                     {"cutoff_slope", kOfCone<&LightCone::cutoff_slope>},
                                     {"shadow", kNoTexture},
                                     {"cookie", kNoTexture}};

}  // namespace

LightValue light_value(std::string_view name) {
  std::string_view field = name.substr(name.find('.') + 1);
  const size_t dot = field.find('.');
  const int component = dot == std::string_view::npos ? 0 : int(std::string_view("xyzw").find(field[dot + 1]));
  field = field.substr(0, dot);
  LightValue value{field == "index", nullptr, nullptr, component};
  for (const LightField& row : kLightFields)
    if (!row.member.empty() && row.name == field) value.member = &row;
  for (const MadeValue& made : kMadeValues)
    if (made.name == field) value.made = made.bits;
  return value;
}

uint32_t LightValue::of(const Light& light, uint32_t index) const {
  if (is_index) return index;
  if (made != nullptr) return made(light);
  if (member == nullptr) return 0;
  if (const auto* vector = std::get_if<glm::vec3 Light::*>(&member->at)) return bits_of((light.*(*vector))[component]);
  return bits_of(light.*std::get<float Light::*>(member->at));
}

}  // namespace trueshade
