#include "judge/diagnosis/known_falloffs.h"

#include <algorithm>
#include <cmath>

namespace trueshade::oracle {

namespace {

double positive(double x) { return std::max(x, 0.0); }
double part(double d, const Light& l) { return d / double(l.range); }
double part4(double d, const Light& l) { return std::pow(part(d, l), 4); }
double squared(double x) { return x * x; }

constexpr KnownFalloff kFalloffs[] = {
    {"1 - d/r", [](double d, const Light& l) { return positive(1 - part(d, l)); }},
    {"(1 - d/r)^2", [](double d, const Light& l) { return squared(positive(1 - part(d, l))); }},
    {"1 - (d/r)^2", [](double d, const Light& l) { return positive(1 - squared(part(d, l))); }},
    {"(1 - (d/r)^2)^2", [](double d, const Light& l) { return squared(positive(1 - squared(part(d, l)))); }},
    {"no falloff", [](double, const Light&) { return 1.0; }},
    {"1/d", [](double d, const Light&) { return 1 / d; }},
    {"1/d^2, without a window", [](double d, const Light&) { return 1 / (d * d); }},
    {"1/(d^2 + 1), without a window", [](double d, const Light&) { return 1 / (d * d + 1); }},
    {"1/(1 + d)^2", [](double d, const Light&) { return 1 / squared(1 + d); }},
    {"1/(k0 + k1 d + k2 d^2) of the light's attenuation",
     [](double d, const Light& l) {
       return 1 / (double(l.attenuation.x) + double(l.attenuation.y) * d + double(l.attenuation.z) * d * d);
     }},
    {"(1 - (d/r)^4)/d^2, that of KHR_lights_punctual",
     [](double d, const Light& l) { return positive(1 - part4(d, l)) / (d * d); }},
    {"(1 - (d/r)^4)^2/d^2, that of Frostbite",
     [](double d, const Light& l) { return squared(positive(1 - part4(d, l))) / (d * d); }},
    {"(1 - (d/r)^4)^2/(d^2 + 1), that of Unreal Engine 4",
     [](double d, const Light& l) { return squared(positive(1 - part4(d, l))) / (d * d + 1); }},
};

}  // namespace

std::span<const KnownFalloff> known_falloffs() { return kFalloffs; }

}  // namespace trueshade::oracle
