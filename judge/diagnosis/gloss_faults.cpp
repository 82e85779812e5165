// How the planes of what materials reflect and emit are encoded.
#include <algorithm>
#include <utility>

#include "judge/diagnosis/plane_faults.h"
#include "judge/diagnosis/srgb_numbers.h"
#include "judge/legal/level_range.h"

namespace trueshade::oracle {

namespace {

using Numbers = std::array<double, 4> PlaneValues::*;

/// A number decoded as a texel of codes is: at least 0, at most 1.
double decoded_texel(double v) { return srgb_decoded(std::max(0.0, v)); }

template <Numbers Of, double (*Change)(double)>
void recoded(const PlaneContext&, PlaneValues& v, double) {
  for (size_t k = 0; k < 3; ++k) (v.*Of)[k] = Change((v.*Of)[k]);
}
template <Numbers Of>
void scaled(const PlaneContext&, PlaneValues& v, double f) {
  for (size_t k = 0; k < 3; ++k) (v.*Of)[k] *= f;
}
template <Numbers Of>
void exchanged(const PlaneContext&, PlaneValues& v, double) {
  std::swap((v.*Of)[0], (v.*Of)[2]);
}
void gloss_scaled(const PlaneContext&, PlaneValues& v, double f) { v.specular[3] *= f; }

constexpr auto kSpecular = &PlaneValues::specular, kEmission = &PlaneValues::emission;
constexpr double kColorFactors[] = {0.25, 0.5, 0.8, 0.9, 1.1, 1.25, 2, 4};
constexpr double kGlossFactors[] = {1.0 / 128, 0.25, 0.5, 2, 4, 128};

// name, text, plane, change, redraw, move, search, starts
constexpr PlaneFault kGlossFaults[] = {
    {"specular-srgb-encoded", "the specular colours are sRGB-encoded", Plane::specular,
     recoded<kSpecular, encoded_srgb>},
    {"specular-srgb-decoded", "the specular colours are decoded as if they were sRGB", Plane::specular,
     recoded<kSpecular, decoded_texel>},
    {"specular-bgr", "the specular colours' channels are in the order BGR", Plane::specular, exchanged<kSpecular>},
    {"specular-scaled", "the specular colours are %s times what they should be", Plane::specular, scaled<kSpecular>,
     nullptr, nullptr, kSmooth, kColorFactors},
    {"gloss-scaled", "the plane's shininess is %s times what it should be", Plane::specular, gloss_scaled, nullptr,
     nullptr, kOneOf, kGlossFactors},
    {"emission-srgb-encoded", "the emission is sRGB-encoded", Plane::emission, recoded<kEmission, encoded_srgb>},
    {"emission-srgb-decoded", "the emission is decoded as if it were sRGB", Plane::emission,
     recoded<kEmission, decoded_texel>},
    {"emission-bgr", "the emission's channels are in the order BGR", Plane::emission, exchanged<kEmission>},
    {"emission-scaled", "the emission is %s times what it should be", Plane::emission, scaled<kEmission>, nullptr,
     nullptr, kSmooth, kColorFactors},
};

}  // namespace

std::span<const PlaneFault> gloss_faults() { return kGlossFaults; }

}  // namespace trueshade::oracle
