#pragma once
#include <iterator>

#include "scenes/pipeline/light_model.h"

namespace trueshade {

/// Any light model that a pipeline may state; `random` gives 32 bits or more a call.
template <class Random>
LightModel random_light_model(Random& random) {
  constexpr float kShininess[] = {0, 1, 2, 5, 32, 60, 7.5f, 0.25f, 8192, 8191};
  const auto share = [&random] { return float(uint32_t(random()) >> 8) * 0x1p-24f; };
  LightModel m;
  m.renormalize = random() % 2 == 0;
  m.specular_masked = random() % 2 == 0;
  m.shininess = kShininess[random() % std::size(kShininess)];
  m.specular_color = {share(), share(), share()};
  m.falloff = Falloff(random() % 6);
  m.order = TermOrder(random() % 4);
  m.cone = Cone(random() % 5);
  m.diffuse = Diffuse(random() % 4 == 0);
  m.specular = Specular(random() % 3);
  m.specular_source = SpecularSource(random() % 4);
  m.viewer = Viewer(random() % 2);
  m.emission = random() % 2 == 0;
  if (random() % 2 == 0) m.global_ambient = {0.2f, 0.1f, 0.0f};
  if (random() % 3 == 0) m.damping = 0.3f;
  m.clamp_result = random() % 3 == 0;
  m.alpha_from_albedo = random() % 2 == 0;
  if (m.order == TermOrder::albedo_last) m.emission = false;
  if (m.order == TermOrder::albedo_last && m.specular_source != SpecularSource::albedo) m.specular = Specular::none;
  return m;
}

}  // namespace trueshade
