#include "judge/bounds/light_lanes.h"

namespace trueshade::oracle {

namespace {

constexpr size_t kWidestVector = 64;  // doubles: more than any target has

size_t whole_vectors(size_t count) { return (count + kWidestVector - 1) / kWidestVector * kWidestVector; }

ErrorChain chain_at(const Arithmetic& a, double k) {
  const double v = a.roundoff * (1 + 0x1p-16), i = a.inverse_sqrt * (1 + 0x1p-16), q = a.square_root * (1 + 0x1p-16);
  ErrorChain c;
  const double eps = v + (1 + v) * k;
  c.eta = (2 * eps + eps * eps) * (1 + 3 * v) + 3 * v;
  c.root = c.eta / 2 * (1 + 2 * c.eta) * (1 + i) + i;
  c.direction = (c.root + v * (1 + c.root)) * (1 + v) + v;
  c.distance = c.eta * (1 + q) + q;
  // k1 d is rounded once, as a part of two sums and again of the larger partial sum; k2 d d twice, and as part of one
  // sum.
  const double product = c.distance * (1 + v) + v;
  const double both = (product + c.distance + product * c.distance) * (1 + v) + v;
  c.linear = product + 3 * v * (1 + product) * (1 + 4 * v);
  c.square = both + 2 * v * (1 + both) * (1 + 4 * v);
  return c;
}

}  // namespace

void LightColumns::add(const glm::vec3& at, const glm::vec3& rgb, float damping, float reach,
                       const glm::vec3& attenuation, uint32_t which) {
  for (size_t k = 0; k < 3; ++k) {
    position[k].push_back(double(at[int(k)]));
    color[k].push_back(double(rgb[int(k)]) * double(damping));
  }
  range.push_back(double(reach));
  k0.push_back(double(attenuation.x)), k1.push_back(double(attenuation.y)), k2.push_back(double(attenuation.z));
  index.push_back(which);
  ++count;
}

void LightColumns::pad() {
  for (std::vector<double>* plane :
       {&position[0], &position[1], &position[2], &color[0], &color[1], &color[2], &range, &k0, &k1, &k2})
    plane->resize(whole_vectors(count), 1.0);
}

void LightColumns::take(const LightColumns& from, std::span<const uint32_t> places) {
  count = places.size();
  const auto taken = [&](const std::vector<double>& plane, std::vector<double>& out) {
    if (out.size() < whole_vectors(count)) out.resize(whole_vectors(count), 1.0);  // beyond count: any numbers
    for (size_t i = 0; i < count; ++i) out[i] = plane[places[i]];
  };
  for (size_t k = 0; k < 3; ++k) taken(from.position[k], position[k]), taken(from.color[k], color[k]);
  taken(from.range, range), taken(from.k0, k0), taken(from.k1, k1), taken(from.k2, k2);
  index.resize(count);
  for (size_t i = 0; i < count; ++i) index[i] = from.index[places[i]];
}

LaneModel::LaneModel(const LightModel& light_model, const Arithmetic& a, bool ends, bool unlit)
    : model(light_model), arithmetic(a), extents(ends), adds_unlit(unlit), start(chain_at(a, 0)) {
  const ErrorChain end = chain_at(a, kLargestRatio);
  const auto rise = [&](double ErrorChain::*error) { return (end.*error - start.*error) / kLargestRatio * kOurs; };
  slope = {rise(&ErrorChain::eta),      rise(&ErrorChain::root),   rise(&ErrorChain::direction),
           rise(&ErrorChain::distance), rise(&ErrorChain::linear), rise(&ErrorChain::square)};
  constant = 4 * a.roundoff * (1 + 0x1p-16);  // k0: in two sums, and twice in the larger partial sums
}

bool lanes_suit(const LightModel& model) { return model.specular != Specular::phong; }

}  // namespace trueshade::oracle
