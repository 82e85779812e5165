// Faults of the planes that hold what materials reflect and emit. The picture was lit from the right ones.
#include <bit>
#include <cmath>

#include "tests/judge/diagnosis/plants.h"
#include "tests/judge/srgb_in_double.h"

namespace trueshade::testing {

namespace {

/// Each material reflects and emits another colour.
void coloured(Scene& s, Pipeline&) {
  for (size_t i = 0; i < s.materials.size(); ++i) {
    const float a = 0.1f * float(i % 5), b = 0.1f * float(i % 3);
    s.materials[i].specular_color = {0.2f + a, 0.3f + b, 0.7f - a};
    s.materials[i].emission = {0.05f + b, 0.4f - a * 0.5f, 0.1f + a};
    s.materials[i].shininess = 20.0f + 10.0f * float(i % 4);
  }
}

/// Numbers of a plane by a formula of them, where there is a surface.
template <class Formula>
Plant rewritten(std::string_view name, std::string_view finding, std::string_view plane, int variants,
                Formula formula) {
  Plant p;
  p.name = name, p.names = {finding}, p.plane = plane, p.presets = {"gl-fixed"};
  p.variants = variants, p.base = coloured;
  p.output = [plane, formula](const Scene&, const Pipeline&, oracle::Capture& c, int variant) {
    const Image ids = *c.plane("id.object");
    for (NamedImage& i : c.planes)
      for (int y = 0; i.name == plane && y < ids.height; ++y)
        for (int x = 0; x < ids.width; ++x) {
          if (ids.code(x, y, 0) == 0) continue;
          std::array<double, 4> v;
          for (int k = 0; k < 4; ++k) v[size_t(k)] = i.image.value(x, y, k);
          formula(v, variant);
          for (int k = 0; k < 4; ++k) i.image.set_code(x, y, k, std::bit_cast<uint32_t>(float(v[size_t(k)])));
        }
  };
  return p;
}

void encode(std::array<double, 4>& v, int) {
  for (size_t k = 0; k < 3; ++k) v[k] = srgb_encoded(v[k]);
}
void scale(std::array<double, 4>& v, int variant) {
  constexpr double kFactors[] = {0.5, 3.0, 1.1};
  for (size_t k = 0; k < 3; ++k) v[k] *= kFactors[variant];
}

}  // namespace

const std::vector<Plant>& plants_of_gloss() {
  static const std::vector<Plant> all = {
      rewritten("specular colours encoded as sRGB", "specular-srgb-encoded", "specular", 1, encode),
      rewritten("specular colours as BGR", "specular-bgr", "specular", 1, [](auto& v, int) { std::swap(v[0], v[2]); }),
      rewritten("specular colours with a gain", "specular-scaled", "specular", 3, scale),
      rewritten("shininess in the plane off", "gloss-scaled", "specular", 2,
                [](auto& v, int variant) { v[3] *= variant == 0 ? 4 : 0.5; }),
      rewritten("emission encoded as sRGB", "emission-srgb-encoded", "emission", 1, encode),
      rewritten("emission with a gain", "emission-scaled", "emission", 3, scale),
  };
  return all;
}

}  // namespace trueshade::testing
