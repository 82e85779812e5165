#include "judge/diagnosis/falloff_name.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace trueshade::oracle {

namespace {

/// Falloffs that renderers use.
struct KnownFalloff {
  std::string_view text;                       ///< its formula, and whose it is
  double (*at)(double d, const Light& light);  ///< as its source writes it; d > 0 in scene units
};

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

constexpr double kSlack = 1.15;  // a named curve may leave so much more than the free one

/// What each light would add to a pixel without its falloff, also a light that ends before the pixel.
struct Unfallen {
  Triple3 rest{};  ///< what is given, without what comes from lights that have no falloff
  std::vector<std::pair<const Light*, double>> lights;  ///< and the distance
  std::vector<Triple3> terms;
};
std::vector<Unfallen> unfallen(const LightShares& shares, const KnownFalloff& ours) {
  LightPass moved = shares.pass();
  std::vector<size_t> place(shares.scene().lights.size());  // of each light among those of a pixel
  std::vector<Unfallen> out;
  for (const SharedPixel& p : shares.pixels()) {
    Unfallen& pixel = out.emplace_back();
    pixel.rest = p.off;
    for (const Share& s : p.lights)
      if (s.d > 0) pixel.rest = plus(pixel.rest, s.term);
    for (size_t i = 0; i < shares.scene().lights.size(); ++i) {
      const Light& light = shares.scene().lights[i];
      const Triple3 way = minus(triple(light.position), p.surface.position);
      const double d = std::sqrt(inner(way, way)), half = 0.5 * double(light.range);
      if (!is_placed(light.type) || !(d > 0) || !std::isfinite(half)) continue;
      for (size_t k = 0; k < 3; ++k)
        moved.lights[i].position[int(k)] = float(p.surface.position[k] + half / d * way[k]);
      place[i] = pixel.lights.size();
      pixel.lights.emplace_back(&light, d);
    }
    pixel.terms.resize(pixel.lights.size());
    for (const LightAdded& added : lights_added(moved, p.surface)) {
      const Light& light = shares.scene().lights[added.light];
      if (place[added.light] < pixel.lights.size() && pixel.lights[place[added.light]].first == &light)
        pixel.terms[place[added.light]] = times(added.term, 1 / ours.at(0.5 * double(light.range), light));
    }
    moved.lights = shares.pass().lights;
  }
  return out;
}

/// LightShares::left_of() where all lights have this falloff, times one factor.
///   scale: receives the factor, the one that fits best
double left_under(const LightShares& shares, const KnownFalloff& falloff, const std::vector<Unfallen>& all,
                  double& scale) {
  std::vector<Triple3> made(all.size());
  double above = 0, below = 0, error = 0;
  for (size_t i = 0; i < all.size(); ++i) {
    for (size_t j = 0; j < all[i].lights.size(); ++j) {
      const auto& [light, d] = all[i].lights[j];
      if (all[i].terms[j] != Triple3{}) made[i] = plus(made[i], times(all[i].terms[j], falloff.at(d, *light)));
    }
    for (size_t k = 0; k < 3; ++k)
      above += shares.pixels()[i].weight[k] * all[i].rest[k] * made[i][k],
          below += shares.pixels()[i].weight[k] * made[i][k] * made[i][k];
  }
  scale = below > 0 ? above / below : 1;
  for (size_t i = 0; i < all.size(); ++i)
    for (size_t k = 0; k < 3; ++k)
      error += shares.pixels()[i].weight[k] * std::pow(all[i].rest[k] - scale * made[i][k], 2);
  return shares.left_of(error);
}

/// Whether the light of `s` changes as the known falloff says when it is moved nearer to the pixel and farther away.
bool moves_like(const LightShares& shares, const KnownFalloff& known, const SharedPixel& pixel, const Share& s) {
  LightPass moved = shares.pass();
  Light& light = moved.lights[s.light];
  const Triple3 way = minus(triple(light.position), pixel.surface.position);
  for (const double by : {0.5, 0.8, 1.2}) {
    for (size_t k = 0; k < 3; ++k) light.position[int(k)] = float(pixel.surface.position[k] + by * way[k]);
    const double wanted = known.at(by * s.d, light) / known.at(s.d, light);
    double made = 0;
    for (const LightAdded& added : lights_added(moved, pixel.surface))
      if (added.light == s.light)
        made = (added.term[0] + added.term[1] + added.term[2]) / (s.term[0] + s.term[1] + s.term[2]);
    if (std::fabs(made - wanted) > 2e-3 * wanted) return false;
  }
  return true;
}

/// The known falloff that the right light pass has, by moves_like() of some pixels; null where it has none of them.
const KnownFalloff* own_falloff(const LightShares& shares) {
  for (const KnownFalloff& known : kFalloffs) {
    size_t same = 0, asked = 0;
    for (size_t i = 0; i < shares.pixels().size() && asked < 8; i += 1 + shares.pixels().size() / 8) {
      const Share& s = shares.pixels()[i].lights[0];
      if (!(s.d > 0) || !(s.part < 0.8)) continue;
      ++asked, same += moves_like(shares, known, shares.pixels()[i], s);
    }
    if (asked > 0 && same == asked) return &known;
  }
  return nullptr;
}

}  // namespace

void name_falloff(const LightShares& shares, LightQuotient& q) {
  constexpr size_t kMostLights = 1024;  // each is asked at each pixel
  if (shares.scene().lights.size() > kMostLights) return;
  const KnownFalloff* const ours = own_falloff(shares);
  if (ours == nullptr) return;
  const std::vector<Unfallen> all = unfallen(shares, *ours);
  const KnownFalloff* best = nullptr;
  double least = HUGE_VAL, scale = 1;
  for (const KnownFalloff& theirs : kFalloffs) {
    double by = 1;
    if (const double left = left_under(shares, theirs, all, by); &theirs != ours && left < least)
      least = left, best = &theirs, scale = by;
  }
  if (least > kSlack * q.left) return;
  const std::string times = std::fabs(scale - 1) < 0.02 ? "" : digits(scale) + " times ";
  q.text = "as if the falloff were " + times + std::string(best->text) + ", where it is " + std::string(ours->text);
  q.left = least;
}

}  // namespace trueshade::oracle
