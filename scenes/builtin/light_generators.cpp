#include "scenes/builtin/light_generators.h"

#include <cmath>

#include "scenes/builtin/pcg32.h"
#include "scenes/trig.h"

namespace trueshade {

void add_ring(Scene& scene, const LightRing& ring) {
  Pcg32 random(ring.seed, 9);
  for (uint32_t i = 0; i < ring.count; ++i) {
    const double turn = double(i) / ring.count, angle = 2.0 * kPi * turn;
    const double ramp = turn * double(ring.colors.size());
    const size_t first = size_t(ramp) % ring.colors.size(), second = (first + 1) % ring.colors.size();
    const double part = ramp - std::floor(ramp);
    const double bright = 1.0 - ring.noise * random.real(), rise = 0.5 * ring.radius * ring.noise * random.real();
    Light light;
    light.position = glm::vec3(ring.centre + glm::dvec3(ring.radius * cosine(angle), rise, ring.radius * sine(angle)));
    light.color = glm::vec3((glm::dvec3(ring.colors[first]) * (1.0 - part) + glm::dvec3(ring.colors[second]) * part) *
                            (ring.intensity * bright));
    light.range = ring.range;
    light.attenuation = ring.attenuation;
    if (ring.turn_s > 0.0) {
      const float radius = float(ring.radius);
      scene.timeline.orbits.push_back({uint32_t(scene.lights.size()),
                                       light.position,
                                       {radius, 0.0f, 0.0f},
                                       {0.0f, 0.0f, radius},
                                       float(ring.turn_s),
                                       float(turn)});
    }
    scene.lights.push_back(light);
  }
}

void add_box(Scene& scene, const LightBox& box) {
  Pcg32 random(box.seed, 11);
  for (uint32_t i = 0; i < box.count; ++i) {
    const glm::dvec3 share{random.real(), random.real(), random.real()};
    const glm::vec3& color = box.colors[random.below(uint32_t(box.colors.size()))];
    Light light;
    light.position = glm::vec3(box.from + (box.to - box.from) * share);
    light.color = glm::vec3(glm::dvec3(color) * (box.intensity * (1.0 - box.noise * random.real())));
    light.range = box.range;
    light.attenuation = box.attenuation;
    if (box.drift > 0.0) {
      const float radius = float(box.drift), period = float(box.drift_s * random.between(0.75, 1.25));
      scene.timeline.orbits.push_back({uint32_t(scene.lights.size()),
                                       light.position,
                                       {radius, 0.0f, 0.0f},
                                       {0.0f, 0.0f, radius},
                                       period,
                                       float(random.real())});
    }
    scene.lights.push_back(light);
  }
}

}  // namespace trueshade
