#include <algorithm>
#include <vector>

#include "scenes/builtin/builtin_scenes.h"
#include "scenes/builtin/pcg32.h"
#include "scenes/shapes.h"
#include "scenes/trig.h"

// A city at night. Blocks of four lots between streets, the lots built up from the centre outwards with towers of one
// to three cubes until the number of objects is reached; lamps along the streets, on the roofs and before the walls.
// One unit is a metre or so.
namespace trueshade::builtin {
namespace {

constexpr uint32_t kCityObjects = 2490, kCityLights = 757;
constexpr int kLot = 10, kStreet = 10, kPitch = 2 * kLot + kStreet;

struct Lot {
  int x, z;  ///< of the centre
  int distance2() const { return x * x + z * z; }
};

struct Building {
  glm::dvec3 roof;  ///< middle of the highest roof
  double roof_half_width;
  double half_width;  ///< of the lowest cube, along x and z at most
};

/// Lots around the centre, nearest first; at least `count`.
std::vector<Lot> lots_from_centre(uint32_t count) {
  int half = 1;                                                 // blocks to each side
  while (uint64_t(half) * uint64_t(half) * 12 < count) ++half;  // the inscribed disc has 4 * pi * half^2 lots
  std::vector<Lot> lots;
  for (int z = -half; z < half; ++z)
    for (int x = -half; x < half; ++x)
      for (const int dz : {-kLot / 2, kLot / 2})
        for (const int dx : {-kLot / 2, kLot / 2})
          lots.push_back({x * kPitch + kPitch / 2 + dx, z * kPitch + kPitch / 2 + dz});
  std::stable_sort(lots.begin(), lots.end(), [](const Lot& a, const Lot& b) { return a.distance2() < b.distance2(); });
  return lots;
}

void add_materials(Scene& scene) {
  const glm::vec3 colors[] = {{0.42f, 0.43f, 0.46f}, {0.50f, 0.52f, 0.56f}, {0.62f, 0.60f, 0.57f},
                              {0.55f, 0.47f, 0.40f}, {0.36f, 0.40f, 0.48f}, {0.66f, 0.66f, 0.68f},
                              {0.48f, 0.38f, 0.34f}, {0.40f, 0.46f, 0.46f}};
  for (const glm::vec3& color : colors) scene.materials.push_back({"wall", glm::vec4(color, 1.0f)});
}

/// Bits of x and z in turn: near on this curve is near on the ground.
uint64_t curve_position(const Building& building) {
  const uint32_t x = uint32_t(int(building.roof.x) + (1 << 20)), z = uint32_t(int(building.roof.z) + (1 << 20));
  uint64_t position = 0;
  for (int bit = 21; bit >= 0; --bit) position = position << 2 | (z >> bit & 1) << 1 | (x >> bit & 1);
  return position;
}

/// Adds the cubes of one building.
Building add_building(Scene& scene, const Lot& lot, double city_radius, uint32_t budget, Pcg32& random) {
  const double away = std::sqrt(double(lot.distance2())) / city_radius;
  const double centre = 1.0 / (1.0 + 10.0 * away * away);
  const double luck = random.real();
  const double height = 5.0 + 7.0 * random.real() + centre * (6.0 + 58.0 * luck * luck);
  double width = kLot * random.between(0.66, 0.92), depth = kLot * random.between(0.66, 0.92), base = 0.0;
  const double half_width = std::max(width, depth) / 2;
  const uint32_t material = 1 + random.below(uint32_t(scene.materials.size()) - 1);
  const uint32_t tiers = std::min(budget, height > 26.0 ? 3u : height > 11.0 ? 1 + random.below(2) : 1u);
  for (uint32_t tier = 0; tier < tiers; ++tier) {
    const double rise = tier + 1 == tiers ? height - base : (height - base) * random.between(0.55, 0.8);
    scene.instances.push_back(
        {0, material, placed({double(lot.x), base + rise / 2, double(lot.z)}, {width, rise, depth})});
    base += rise;
    if (tier + 1 < tiers) width *= random.between(0.5, 0.82), depth *= random.between(0.5, 0.82);
  }
  return {{double(lot.x), base, double(lot.z)}, std::min(width, depth) / 2, half_width};
}

/// Sodium and white lamps; here and there a quarter with neon of its own hue.
glm::dvec3 lamp_color(const glm::dvec3& at, bool on_roof, Pcg32& random) {
  const double pick = random.real();
  const double quarter = 0.5 + 0.5 * sine(at.x * 0.017 + 1.3) * cosine(at.z * 0.021 - 0.4);
  if (pick < (on_roof ? 0.62 : 0.3)) return color_of_hue(0.48 + 0.44 * quarter + 0.06 * random.real(), 0.8);
  if (pick < 0.85) return {1.0, 0.62, 0.26};
  return {0.85, 0.9, 1.0};
}

/// Goes to and fro along its street.
void add_street_lamp(Scene& scene, uint32_t number, double city_radius, double reach, Pcg32& random, Pcg32& drift) {
  const int streets = int(city_radius / kPitch);
  const glm::dvec2 even = even_point(number);
  const double along = (2.0 * even.x - 1.0) * city_radius;
  const double across =
      kPitch * (int(even.y * (2 * streets + 1)) - streets) + (random.below(2) == 0 ? -0.3 : 0.3) * kStreet;
  const bool along_x = random.below(2) == 0;
  const glm::dvec3 at = along_x ? glm::dvec3(along, 7.0 * reach, across) : glm::dvec3(across, 7.0 * reach, along);
  const glm::dvec3 color = lamp_color(at, false, random);
  const double way = drift.between(10.0, 40.0), period = way * drift.between(0.4, 0.8);
  add_moving(scene, point_light(at, color * random.between(0.8, 1.2), 44.0 * reach),
             along_x ? glm::dvec3(way, 0.0, 0.0) : glm::dvec3(0.0, 0.0, way), glm::dvec3(0.0), period, drift.real());
}

/// Circles above its roof.
void add_roof_lamp(Scene& scene, const Building& building, double reach, Pcg32& random, Pcg32& drift) {
  const double spread = building.roof_half_width * 0.9;
  const glm::dvec3 at =
      building.roof + glm::dvec3{random.between(-spread, spread), 6.0 * reach, random.between(-spread, spread)};
  const glm::dvec3 color = lamp_color(at, true, random);
  const double period = drift.between(4.0, 9.0);
  add_moving(scene, point_light(at, color * random.between(0.8, 1.2), 40.0 * reach), {3.0 * reach, 0.0, 0.0},
             {0.0, 0.0, 3.0 * reach}, period, drift.real());
}

/// A sign before one of the four walls, somewhere between street and roof.
Light wall_lamp(const Building& building, double reach, Pcg32& random) {
  const double away = building.half_width + 4.0 * reach, along = random.between(-0.9, 0.9) * building.half_width;
  const double side = random.below(2) == 0 ? -away : away;
  const double height = building.roof.y * random.between(0.3, 0.95);
  const glm::dvec3 offset = random.below(2) == 0 ? glm::dvec3(side, 0.0, along) : glm::dvec3(along, 0.0, side);
  const glm::dvec3 at = glm::dvec3(building.roof.x, height, building.roof.z) + offset;
  const glm::dvec3 color = lamp_color(at, true, random);
  return point_light(at, color * random.between(0.8, 1.2), 40.0 * reach);
}

}  // namespace

Scene city(const Parameters& parameters) {
  Scene scene;
  scene.clear = {0.016f, 0.022f, 0.05f, 1.0f};
  scene.materials.push_back({"ground", {0.36f, 0.36f, 0.38f, 1.0f}});
  add_materials(scene);
  scene.meshes.push_back(cube_mesh());

  Pcg32 random(parameters.seed, 1), drift(parameters.seed, 21);
  const uint32_t objects = parameters.objects_or(kCityObjects);
  const std::vector<Lot> lots = lots_from_centre(objects);
  const double city_radius = 15.0 + 6.4 * std::sqrt(double(objects));  // near 1.6 cubes a building
  scene.instances.push_back({0, 0, placed({0.0, -1.0, 0.0}, {2.2 * city_radius, 2.0, 2.2 * city_radius})});
  std::vector<Building> buildings;
  for (size_t i = 0; scene.instances.size() < objects; ++i)
    buildings.push_back(add_building(scene, lots[i], city_radius, objects - uint32_t(scene.instances.size()), random));
  std::stable_sort(buildings.begin(), buildings.end(),
                   [](const Building& a, const Building& b) { return curve_position(a) < curve_position(b); });
  if (buildings.empty()) buildings.push_back({glm::dvec3(0.0), city_radius, city_radius});

  const uint32_t lights = parameters.lights_or(kCityLights);
  const double reach = parameters.reach(kCityLights);
  for (uint32_t i = 0; i < lights; ++i) {
    const Building& building = buildings[size_t(even_point(i).x * double(buildings.size()))];
    if (i % 8 < 3)
      add_street_lamp(scene, i, city_radius, reach, random, drift);
    else if (i % 8 < 5)
      add_roof_lamp(scene, building, reach, random, drift);
    else
      scene.lights.push_back(wall_lamp(building, reach, random));
  }

  scene.camera.eye = glm::vec3(glm::dvec3(0.55, 0.46, 0.78) * city_radius);
  scene.camera.target = glm::vec3(glm::dvec3(0.0, -0.02, 0.02) * city_radius);
  scene.camera.fov_y_rad = 0.85f;
  scene.camera.near = 1.0f;
  scene.camera.far = float(8.0 * city_radius);
  return scene;
}

}  // namespace trueshade::builtin
