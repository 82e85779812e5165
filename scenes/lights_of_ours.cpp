#include "scenes/lights_of_ours.h"

#include <algorithm>

#include "core/fp_env.h"
#include "scenes/scene_defaults.h"
#include "scenes/shapes.h"
#include "scenes/trig.h"

namespace trueshade {
namespace {

constexpr double kGreyReflectance = 0.7;             // reflectance that the lights are made for
constexpr double kLeastGain = 0.7, kMostGain = 5.0;  // of the lights on white and on dark surfaces
constexpr double kBrightest = 1.05;                  // gain times the brightest channel of a surface
constexpr double kSmallShare = 0.01;                 // of the triangles: a surface of fewer may be cut off
constexpr double kLightDistance = 2.2;               // of all but ambient light, in radii of the bounds
constexpr double kFalloffThere = 0.6;                // how a lamp's attenuation grows over that distance
constexpr double kPhotometricShare = 0.4;            // of the squared distance: a lamp's intensity where light spreads
constexpr double kMostIntensity = 1e17;
constexpr double kMostAttenuation = 1e18;  // that validate() takes: of a lamp 1e-9 units off

struct Lamp {
  glm::dvec3 from;   // the centre of the bounds
  glm::dvec3 color;  // on grey surfaces
};
constexpr Lamp kLamps[kLightsOfOurs - 1] = {{{-0.8, 1.0, 0.9}, {1.45, 1.36, 1.2}},
                                            {{1.0, 0.35, 0.7}, {0.34, 0.42, 0.56}},
                                            {{0.5, 0.9, -1.0}, {0.6, 0.57, 0.52}}};

constexpr const char* kGround = "ground";  // of its mesh and its material
constexpr double kGroundReflectance = 0.34;
constexpr double kGroundRadius = 8.0;  // in radii of the bounds
constexpr double kMostGround = 9e17;   // of its coordinates
constexpr glm::dvec3 kSoftLight(0.17, 0.18, 0.2);

double ground_height(const Bounds& bounds) { return bounds.least.y - 0.004 * bounds.radius; }

double luminance(const glm::dvec3& color) { return (0.2126 * color.x + 0.7152 * color.y) + 0.0722 * color.z; }

glm::dvec3 mean_color(const Mesh& mesh) {
  if (!mesh.has_color() || mesh.vertex_count() == 0) return glm::dvec3(1.0);
  glm::dvec3 sum(0.0);
  for (int k = 0; k < 3; ++k)
    for (const float x : mesh.color[size_t(k)]) sum[k] += double(x);
  return sum / double(mesh.vertex_count());
}

glm::dvec3 mean_color(const Scene& scene, const Material& material) {
  const glm::dvec3 base(material.base_color);
  if (!material.color_map.used()) return base;
  const Texture& texture = scene.textures[size_t(material.color_map.texture)];
  const TextureLevel& last = texture.levels.back();
  if (last.width != 1 || last.height != 1) return base;
  const std::array<float, 4> texel = texel_value(texture, texture.levels.size() - 1, 0, 0);
  return base * glm::dvec3(texel[0], texel[1], texel[2]);
}

/// What an instance gives back of white light, and how many triangles it has.
struct Surface {
  glm::dvec3 color;
  double triangles;
};
std::vector<Surface> surfaces_of(const Scene& scene) {
  std::vector<glm::dvec3> of_mesh, of_material;
  for (const Mesh& mesh : scene.meshes) of_mesh.push_back(mean_color(mesh));
  for (const Material& material : scene.materials) of_material.push_back(mean_color(scene, material));
  std::vector<Surface> surfaces;
  for (const Instance& instance : scene.instances)
    surfaces.push_back({of_mesh[instance.mesh] * of_material[instance.material],
                        double(scene.meshes[instance.mesh].triangle_count())});
  return surfaces;
}

double mean_of(const std::vector<Surface>& surfaces) {
  double sum = 0.0, weight = 0.0;
  for (const Surface& surface : surfaces) {
    sum += surface.triangles * luminance(surface.color);
    weight += surface.triangles;
  }
  return weight > 0.0 ? sum / weight : 0.0;
}

/// The largest channel of a surface that has a share of the scene worth speaking of.
double brightest_of(const std::vector<Surface>& surfaces) {
  double all = 0.0, brightest = 0.0;
  for (const Surface& surface : surfaces) all += surface.triangles;
  for (const Surface& surface : surfaces)
    if (surface.triangles >= kSmallShare * all)
      brightest = std::max({brightest, surface.color.x, surface.color.y, surface.color.z});
  return brightest;
}

/// How much more light than on grey a scene gets: more on dark surfaces, unless a bright one among them would be cut
/// off at 1.
double gain_of(const Scene& scene) {
  const std::vector<Surface> surfaces = surfaces_of(scene);
  const double reflectance = mean_of(surfaces), brightest = brightest_of(surfaces);
  if (!(reflectance > 0.0)) return 1.0;
  const double gain = std::clamp(kGreyReflectance / reflectance, kLeastGain, kMostGain);
  return std::min(gain, std::max(kBrightest / brightest, 1.0));
}

double photometric_intensity(double distance2) { return std::min(kPhotometricShare * distance2, kMostIntensity); }

double lamp_distance(const Bounds& bounds) { return kLightDistance * bounds.radius; }

/// Whether lamps are so near that no float holds how their light falls off.
bool are_too_near(const Bounds& bounds) {
  const double distance = lamp_distance(bounds);
  return !(kFalloffThere / (distance * distance) <= kMostAttenuation);
}

glm::vec3 place_of(const Bounds& bounds, const glm::dvec3& from) {
  return glm::vec3(bounds.centre + unit(from) * lamp_distance(bounds));
}

/// In place of one that is too near: it shines as from far away, as brightly as the lamp on the centre of the bounds.
Light distant_lamp(const Scene& scene, const glm::dvec3& from, const glm::dvec3& color) {
  Light light;
  light.type = LightType::directional;
  light.direction = glm::vec3(-unit(from));
  light.color = glm::vec3(color * (scene.photometric ? kPhotometricShare : 1.0 / (1.0 + kFalloffThere)));
  return light;
}

void add_lamp(Scene& scene, const Bounds& bounds, const glm::dvec3& from, const glm::dvec3& color) {
  const double distance = lamp_distance(bounds), distance2 = distance * distance;
  const double intensity = scene.photometric ? photometric_intensity(distance2) : 1.0;
  if (are_too_near(bounds)) {
    scene.lights.push_back(distant_lamp(scene, from, color));
    return;
  }
  Light light;
  light.position = place_of(bounds, from);
  light.color = glm::vec3(color * intensity);
  light.range = float(6.0 * bounds.radius);
  light.attenuation = {1.0f, 0.0f, float(kFalloffThere / distance2)};
  scene.lights.push_back(light);
}

}  // namespace

double mean_reflectance(const Scene& scene) {
  const FpScope fp;
  return mean_of(surfaces_of(scene));
}

double spread_light(const Light& lamp) {
  const FpScope fp;
  if (is_directional(lamp.type)) return kPhotometricShare * (1.0 + kFalloffThere);
  if (is_ambient(lamp.type) || !(lamp.attenuation.z > 0.0f)) return 1.0;
  return photometric_intensity(kFalloffThere / double(lamp.attenuation.z));
}

void add_lights_of_ours(Scene& scene) {
  const FpScope fp;
  if (scene.lights_of_ours) return;
  const Bounds bounds = bounds_of(scene);
  const double gain = gain_of(scene);
  for (const Lamp& lamp : kLamps) add_lamp(scene, bounds, lamp.from, lamp.color * gain);
  scene.lights.push_back(ambient_light(glm::vec3(kSoftLight * gain)));
  scene.clear = {0.02f, 0.02f, 0.03f, 1.0f};
  scene.lights_of_ours = true;
}

std::array<LampPlace, kLightsOfOurs - 1> lamps_for(const Scene& scene, const glm::dvec3& vertical,
                                                   const glm::dvec2& turn) {
  const FpScope fp;
  const Bounds bounds = bounds_without_ground(scene);
  const glm::dvec3 right(1.0, 0.0, 0.0), front = cross(right, vertical);
  std::array<LampPlace, kLightsOfOurs - 1> places;
  for (size_t i = 0; i < places.size(); ++i) {
    const glm::dvec3 made = kLamps[i].from;
    const double x = dot(made, right), z = dot(made, front);
    const glm::dvec3 from =
        right * (x * turn.y + z * turn.x) + vertical * dot(made, vertical) + front * (z * turn.y - x * turn.x);
    places[i] = {place_of(bounds, from), glm::vec3(-unit(from))};
  }
  return places;
}

void turn_lamps(Scene& scene, const glm::dvec2& turn) {
  if (!scene.lights_of_ours || turn == glm::dvec2(0.0, 1.0)) return;
  place_lamps(scene, lamps_for(scene, glm::dvec3(0.0, 1.0, 0.0), turn));
}

void place_lamps(Scene& scene, std::span<const LampPlace> places) {
  for (size_t i = 0; i < places.size(); ++i) {
    Light& lamp = scene.lights[scene.lights.size() - kLightsOfOurs + i];
    (is_directional(lamp.type) ? lamp.direction : lamp.position) =
        is_directional(lamp.type) ? places[i].direction : places[i].position;
  }
}

void add_ground(Scene& scene) {
  constexpr int kSides = 96;
  const FpScope fp;
  const Bounds bounds = bounds_of(scene);
  const double radius = kGroundRadius * bounds.radius, height = ground_height(bounds);
  const bool fits = std::fabs(bounds.centre.x) + radius < kMostGround &&
                    std::fabs(bounds.centre.z) + radius < kMostGround && std::fabs(height) < kMostGround;
  if (scene.triangle_count() == 0 || !fits || are_too_near(bounds)) return;
  Mesh disc;
  disc.name = kGround;
  const glm::dvec3 up(0.0, 1.0, 0.0), centre(bounds.centre.x, height, bounds.centre.z);
  add_vertex(disc, centre, up);
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2.0 * kPi * double(i) / kSides;
    add_vertex(disc, centre + glm::dvec3(cosine(angle), 0.0, -sine(angle)) * radius, up);
    disc.indices.insert(disc.indices.end(), {0, uint32_t(1 + i), uint32_t(1 + (i + 1) % kSides)});
  }
  see_ground(scene.camera, bounds);
  const float grey = float(kGroundReflectance / gain_of(scene));
  scene.clear = glm::vec4(glm::vec3(kSoftLight * kGroundReflectance), 1.0f);  // as the ground is where no lamp reaches
  Instance instance;
  instance.mesh = uint32_t(scene.meshes.size());
  instance.material = uint32_t(scene.materials.size());
  scene.meshes.push_back(std::move(disc));
  scene.materials.push_back({kGround, {grey, grey, grey, 1.0f}});
  scene.instances.push_back(instance);
  scene.ground_of_ours = true;
}

void see_ground(Camera& camera, const Bounds& bounds) {
  const FpScope fp;
  const glm::dvec3 to_centre =
      glm::dvec3(bounds.centre.x, ground_height(bounds), bounds.centre.z) - glm::dvec3(camera.eye);
  const double farthest = std::sqrt(dot(to_centre, to_centre)) + kGroundRadius * bounds.radius;
  camera.far = std::max(camera.far, float(std::min(1.01 * farthest, kMostGround)));
}

void remove_ground(Scene& scene) {
  if (!scene.is_model || scene.photometric || !scene.ground_of_ours) return;
  scene.instances.pop_back();
  scene.ground_of_ours = false;
}

}  // namespace trueshade
