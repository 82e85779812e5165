#include "scenes/files/gltf/extras/punctual_lights.h"

#include <algorithm>
#include <cmath>

namespace trueshade::gltf {
namespace {

/// Within what a program may change that reads a number as a float and writes it.
bool is_near(double a, double b) { return std::fabs(a - b) <= 1e-5 * std::max(std::fabs(a), std::fabs(b)) + 1e-12; }

bool is_same(const LightSource& source, const Light& light, bool photometric) {
  if (source.type != light.type) return false;
  const double largest = std::max({light.color.x, light.color.y, light.color.z});
  const double strength = std::min(largest * photometric_intensity(light, photometric), 1e18);
  bool same = is_near(source.intensity, strength);
  for (int k = 0; k < 3; ++k)
    same = same && is_near(double(source.color[k]), largest > 0 ? double(light.color[k]) / largest : 0.0);
  const bool has_range =
      !is_directional(light.type) && std::isfinite(light.range) && light.range >= 1e-30f && light.range <= 1e18f;
  return same && (has_range ? is_near(double(source.range), double(light.range)) : !std::isfinite(source.range));
}

bool is_at(const NodeSource& node, const Light& light) {
  if (!node.matrix || is_directional(light.type)) return node.matrix.has_value();
  for (int k = 0; k < 3; ++k)
    if (!is_near((*node.matrix)[3][k], double(light.position[k]))) return false;
  return true;
}

}  // namespace

double photometric_intensity(const Light& light, bool photometric) {
  if (photometric || is_directional(light.type)) return 1.0;
  if (std::isfinite(light.range)) return double(light.range) * double(light.range) / 8.0;
  return light.attenuation.z > 0.0f ? 1.0 / double(light.attenuation.z) : 1.0;
}

std::string note_of_lights(const Document& document, const Scene& scene) {
  std::vector<const Light*> written;
  for (const Light& light : scene.lights)
    if (row_of(light.type).in_gltf) written.push_back(&light);
  std::vector<const NodeSource*> nodes;
  for (const NodeSource& node : document.nodes)
    if (node.light != kNone) nodes.push_back(&node);
  const Timeline& moves = scene.timeline;
  const bool stands = moves.lights.empty() && moves.orbits.empty() && moves.node_lights.empty();
  size_t apart = std::max(nodes.size(), written.size()) - std::min(nodes.size(), written.size());
  for (size_t i = 0; i < std::min(nodes.size(), written.size()); ++i)
    if (!is_same(document.lights[nodes[i]->light], *written[i], scene.photometric) ||
        (stands && !is_at(*nodes[i], *written[i])))
      ++apart;
  if (apart == 0) return {};
  return std::to_string(apart) + (apart == 1 ? " light" : " lights") +
         " of KHR_lights_punctual differ from those in /extras/trueshade, which are drawn (to draw the file's own, "
         "remove its /extras)";
}

}  // namespace trueshade::gltf
