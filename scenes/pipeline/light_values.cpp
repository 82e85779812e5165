#include "scenes/pipeline/light_values.h"

#include <bit>

#include "scenes/light_cone.h"

namespace trueshade {
namespace {

uint32_t bits_of(float value) { return std::bit_cast<uint32_t>(value); }

/// A field of the interface: its bits, of a vector those of the component c.
struct ValueRow {
  std::string_view name;
  uint32_t (*bits)(const Light&, int c);
};
template <auto kMember>
constexpr auto kVector = [](const Light& l, int c) { return bits_of((l.*kMember)[c]); };
template <auto kMember>
constexpr auto kScalar = [](const Light& l, int) { return bits_of(l.*kMember); };
template <auto kMember>
constexpr auto kOfCone = [](const Light& l, int) { return bits_of(LightCone(l).*kMember); };
constexpr auto kNoTexture = [](const Light&, int) { return uint32_t(-1); };

constexpr ValueRow kValueRows[] = {{"type", [](const Light& l, int) { return uint32_t(l.type); }},
                                   {"position", kVector<&Light::position>},
                                   {"range", kScalar<&Light::range>},
                                   {"direction", kVector<&Light::direction>},
                                   {"color", kVector<&Light::color>},
                                   {"attenuation", kVector<&Light::attenuation>},
                                   {"ambient", kVector<&Light::ambient>},
                                   {"cone", kScalar<&Light::cone_rad>},
                                   {"penumbra", kScalar<&Light::penumbra_rad>},
                                   {"cos_inner", kOfCone<&LightCone::cos_inner>},
                                   {"cos_outer", kOfCone<&LightCone::cos_outer>},
                                   {"cone_scale", kOfCone<&LightCone::scale>},
                                   {"cone_offset", kOfCone<&LightCone::offset>},
                                   {"spot_exponent", kScalar<&Light::spot_exponent>},
                                   {"penumbra_slope", kOfCone<&LightCone::penumbra_slope>},
                                   {"cutoff_slope", kOfCone<&LightCone::cutoff_slope>},
                                   {"right", kVector<&Light::right>},
                                   {"up", kVector<&Light::up>},
                                   {"shadow", kNoTexture},
                                   {"cookie", kNoTexture}};

}  // namespace

LightValue light_value(std::string_view name) {
  std::string_view field = name.substr(name.find('.') + 1);
  const size_t dot = field.find('.');
  const int component = dot == std::string_view::npos ? 0 : int(std::string_view("xyzw").find(field[dot + 1]));
  field = field.substr(0, dot);
  if (field == "index") return {nullptr, 0};
  for (const ValueRow& f : kValueRows)
    if (f.name == field) return {f.bits, component};
  return {[](const Light&, int) { return 0u; }, 0};
}

}  // namespace trueshade
