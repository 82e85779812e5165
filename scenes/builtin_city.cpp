#include <algorithm>
#include <vector>

#include "scenes/builtin_scenes.h"
#include "scenes/pcg32.h"
#include "scenes/shapes.h"
#include "scenes/trig.h"

// A city at night. Blocks of four lots between streets, the lots built up from the centre outwards with towers of one to
// three cubes until the number of objects is reached; lamps along the streets and on the roofs. One unit is a metre or so.
namespace trueshade::builtin {
namespace {

constexpr uint32_t kObjects = 2490, kLights = 757;
constexpr int kLot = 10, kStreet = 8, kPitch = 2 * kLot + kStreet;

struct Lot {
  int x, z;  ///< of the centre
  int distance2() const { return x * x + z * z; }
};

struct Roof {
  glm::dvec3 centre;
  double half_width;
};

/// Lots around the centre, nearest first; at least `count`.
std::vector<Lot> lots_from_centre(uint32_t count) {
  int half = 1;  // blocks to each side
  while (uint64_t(half) * uint64_t(half) * 12 < count) ++half;  // the inscribed disc has 4 * pi * half^2 lots
  std::vector<Lot> lots;
  for (int z = -half; z < half; ++z)
    for (int x = -half; x < half; ++x)
      for (const int dz : {-kLot / 2, kLot / 2})
        for (const int dx : {-kLot / 2, kLot / 2}) lots.push_back({x * kPitch + kPitch / 2 + dx, z * kPitch + kPitch / 2 + dz});
  std::stable_sort(lots.begin(), lots.end(), [](const Lot& a, const Lot& b) { return a.distance2() < b.distance2(); });
  return lots;
}

void add_materials(Scene& scene) {
  const glm::vec3 colors[] = {{0.42f, 0.43f, 0.46f}, {0.50f, 0.52f, 0.56f}, {0.62f, 0.60f, 0.57f}, {0.55f, 0.47f, 0.40f},
                              {0.36f, 0.40f, 0.48f}, {0.66f, 0.66f, 0.68f}, {0.48f, 0.38f, 0.34f}, {0.40f, 0.46f, 0.46f}};
  for (const glm::vec3& color : colors) scene.materials.push_back({"wall", glm::vec4(color, 1.0f)});
}

/// Adds the cubes of one building and returns its highest roof.
Roof add_building(Scene& scene, const Lot& lot, double city_radius, uint32_t budget, Pcg32& random) {
  const double away = std::sqrt(double(lot.distance2())) / city_radius;
  const double centre = 1.0 / (1.0 + 10.0 * away * away);
  const double luck = random.real();
  double height = 5.0 + 7.0 * random.real() + centre * (8.0 + 62.0 * luck * luck);
  double width = kLot * random.between(0.66, 0.92), depth = kLot * random.between(0.66, 0.92), base = 0.0;
  const uint32_t material = 1 + random.below(uint32_t(scene.materials.size()) - 1);
  const uint32_t tiers = std::min(budget, height > 26.0 ? 3u : height > 11.0 ? 1 + random.below(2) : 1u);
  for (uint32_t tier = 0; tier < tiers; ++tier) {
    const double rise = tier + 1 == tiers ? height - base : (height - base) * random.between(0.55, 0.8);
    scene.instances.push_back(
        {0, material, placed({double(lot.x), base + rise / 2, double(lot.z)}, {width, rise, depth})});
    base += rise;
    if (tier + 1 < tiers) width *= random.between(0.5, 0.82), depth *= random.between(0.5, 0.82);
  }
  return {{double(lot.x), base, double(lot.z)}, std::min(width, depth) / 2};
}

/// Sodium and white lamps; here and there a quarter with neon of its own hue.
glm::dvec3 lamp_color(const glm::dvec3& at, bool on_roof, Pcg32& random) {
  const double pick = random.real();
  const double quarter = 0.5 + 0.5 * sine(at.x * 0.017 + 1.3) * cosine(at.z * 0.021 - 0.4);
  if (pick < (on_roof ? 0.62 : 0.3)) return color_of_hue(0.48 + 0.44 * quarter + 0.06 * random.real(), 0.8);
  if (pick < 0.85) return {1.0, 0.62, 0.26};
  return {0.85, 0.9, 1.0};
}

Light street_lamp(double city_radius, double reach, Pcg32& random) {
  const int streets = int(city_radius / kPitch);
  const double along = random.between(-city_radius, city_radius);
  const double across = kPitch * (int(random.below(uint32_t(2 * streets + 1))) - streets) +
                        (random.below(2) == 0 ? -0.3 : 0.3) * kStreet;
  const glm::dvec3 at = random.below(2) == 0 ? glm::dvec3(along, 6.0 * reach, across) : glm::dvec3(across, 6.0 * reach, along);
  return point_light(at, lamp_color(at, false, random) * random.between(0.7, 1.1), 34.0 * reach);
}

Light roof_lamp(const std::vector<Roof>& roofs, double reach, Pcg32& random) {
  const Roof& roof = roofs[random.below(uint32_t(roofs.size()))];
  const double spread = roof.half_width * 0.9;
  const glm::dvec3 at = roof.centre + glm::dvec3(random.between(-spread, spread), 5.0 * reach, random.between(-spread, spread));
  return point_light(at, lamp_color(at, true, random) * random.between(0.8, 1.2), 30.0 * reach);
}

}  // namespace

Scene city(const Parameters& parameters) {
  Scene scene;
  scene.clear = {0.012f, 0.016f, 0.035f, 1.0f};
  scene.materials.push_back({"ground", {0.30f, 0.30f, 0.32f, 1.0f}});
  add_materials(scene);
  scene.meshes.push_back(cube_mesh());

  Pcg32 random(parameters.seed, 1);
  const uint32_t objects = parameters.objects_or(kObjects);
  const std::vector<Lot> lots = lots_from_centre(objects);
  const double city_radius = 14.0 + 6.0 * std::sqrt(double(objects));  // near 1.6 cubes a building
  scene.instances.push_back(
      {0, 0, placed({0.0, -1.0, 0.0}, {2.3 * city_radius, 2.0, 2.3 * city_radius})});
  std::vector<Roof> roofs;
  for (size_t i = 0; scene.instances.size() < objects; ++i)
    roofs.push_back(add_building(scene, lots[i], city_radius, objects - uint32_t(scene.instances.size()), random));
  if (roofs.empty()) roofs.push_back({{0.0, 0.0, 0.0}, city_radius});

  const uint32_t lights = parameters.lights_or(kLights);
  const double reach = parameters.reach(kLights);
  for (uint32_t i = 0; i < lights; ++i)
    scene.lights.push_back(i % 2 == 0 ? street_lamp(city_radius, reach, random) : roof_lamp(roofs, reach, random));

  scene.camera.eye = glm::vec3(glm::dvec3(0.55, 0.38, 0.75) * city_radius);
  scene.camera.target = glm::vec3(glm::dvec3(0.0, 0.02, 0.0) * city_radius);
  scene.camera.fov_y_rad = 0.85f;
  scene.camera.near = 1.0f;
  scene.camera.far = float(8.0 * city_radius);
  return scene;
}

}  // namespace trueshade::builtin
