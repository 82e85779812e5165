// How the planes of what materials reflect and emit are encoded.
#include <algorithm>
#include <utility>

#include "judge/diagnosis/plane_faults.h"
#include "judge/legal/level_range.h"

namespace trueshade::oracle {

namespace {

using Numbers = std::array<double, 4> PlaneValues::*;

double encoded_srgb(double v) { return srgb_encoded(std::max(0.0, v)); }
double decoded_srgb(double v) { return srgb_decoded(std::max(0.0, v)); }

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
constexpr double kFactors[] = {0.25, 0.5, 0.8, 0.9, 1.1, 1.25, 2, 4};
constexpr double kExponents[] = {1.0 / 128, 0.25, 0.5, 2, 4, 128};
constexpr auto kSmooth = PlaneFault::Search::smooth, kOneOf = PlaneFault::Search::one_of;

// name, text, plane, change, redraw, move, search, starts
constexpr PlaneFault kFaults[] = {
    {"specular-srgb-encoded", "the specular colours are sRGB-encoded", Plane::specular,
     recoded<kSpecular, encoded_srgb>},
    {"specular-srgb-decoded", "the specular colours are decoded as if they were sRGB", Plane::specular,
     recoded<kSpecular, decoded_srgb>},
    {"specular-bgr", "the specular colours' channels are in the order BGR", Plane::specular, exchanged<kSpecular>},
    {"specular-scaled", "the specular colours are %s times what they should be", Plane::specular, scaled<kSpecular>,
     nullptr, nullptr, kSmooth, kFactors},
    {"gloss-scaled", "the plane's shininess is %s times what it should be", Plane::specular, gloss_scaled, nullptr,
     nullptr, kOneOf, kExponents},
    {"emission-srgb-encoded", "the emission is sRGB-encoded", Plane::emission, recoded<kEmission, encoded_srgb>},
    {"emission-srgb-decoded", "the emission is decoded as if it were sRGB", Plane::emission,
     recoded<kEmission, decoded_srgb>},
    {"emission-bgr", "the emission's channels are in the order BGR", Plane::emission, exchanged<kEmission>},
    {"emission-scaled", "the emission is %s times what it should be", Plane::emission, scaled<kEmission>, nullptr,
     nullptr, kSmooth, kFactors},
};

}  // namespace

std::span<const PlaneFault> gloss_faults() { return kFaults; }

}  // namespace trueshade::oracle
