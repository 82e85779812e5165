#include <cmath>

#include "scenes/builtin/builtin_scenes.h"
#include "scenes/builtin/pcg32.h"
#include "scenes/builtin/surface_net.h"
#include "scenes/shapes.h"
#include "scenes/trig.h"

// A hill of rabbits. One rabbit is the surface of a field: rounded parts, joined smoothly, of which we mesh the zero
// level.
namespace trueshade::builtin {
namespace {

constexpr uint32_t kRabbitsLights = 100, kRabbitsObjects = 125;
constexpr size_t kRabbitTriangles = 40000;

double length(const glm::dvec3& v) { return std::sqrt(dot(v, v)); }

double ball(const glm::dvec3& p, const glm::dvec3& centre, double radius) { return length(p - centre) - radius; }

/// Near the distance to an ellipsoid, exact to first order at its surface.
double ellipsoid(const glm::dvec3& p, const glm::dvec3& centre, const glm::dvec3& radii) {
  const glm::dvec3 q = (p - centre) / radii;
  const double scaled = length(q), slope = length(q / radii);
  return slope > 0.0 ? scaled * (scaled - 1.0) / slope : -radii.x;
}

/// A rod from a to b, of radius ra at a and rb at b.
double rod(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, double ra, double rb) {
  const glm::dvec3 ab = b - a, ap = p - a;
  const double raw = dot(ap, ab) / dot(ab, ab);
  const double t = raw < 0.0 ? 0.0 : raw > 1.0 ? 1.0 : raw;
  return length(ap - ab * t) - (ra + (rb - ra) * t);
}

/// The smaller of both, rounded where they meet over a width of k.
double joined(double a, double b, double k) {
  const double near = k - std::fabs(a - b);
  const double least = a < b ? a : b;
  return near > 0.0 ? least - near * near / (4.0 * k) : least;
}

double eye_field(const glm::dvec3& p) { return ball(p, {0.113, 0.625, 0.345}, 0.030); }

/// `p` with x >= 0: the rabbit is symmetric. The ear is an oval in front of which a groove is cut.
double ear_field(const glm::dvec3& p) {
  const double oval = joined(rod(p, {0.055, 0.68, 0.22}, {0.105, 0.90, 0.13}, 0.034, 0.062),
                             rod(p, {0.105, 0.90, 0.13}, {0.135, 1.06, 0.07}, 0.062, 0.022), 0.05);
  const double groove = rod(p, {0.085, 0.78, 0.245}, {0.145, 1.02, 0.155}, 0.045, 0.045);
  return -joined(-oval, groove, 0.03);
}

double rabbit_field(const glm::dvec3& at) {
  const glm::dvec3 p(std::fabs(at.x), at.y, at.z);
  double f = ellipsoid(p, {0.0, 0.31, -0.10}, {0.235, 0.275, 0.33});                      // body
  f = joined(f, ellipsoid(p, {0.0, 0.33, 0.13}, {0.165, 0.21, 0.17}), 0.12);              // chest
  f = joined(f, ellipsoid(p, {0.185, 0.20, -0.17}, {0.105, 0.175, 0.20}), 0.05);          // haunch
  f = joined(f, rod(p, {0.185, 0.05, -0.20}, {0.185, 0.045, 0.11}, 0.052, 0.048), 0.05);  // hind foot
  f = joined(f, rod(p, {0.090, 0.27, 0.20}, {0.085, 0.055, 0.25}, 0.062, 0.046), 0.05);   // foreleg
  f = joined(f, rod(p, {0.085, 0.045, 0.25}, {0.085, 0.042, 0.32}, 0.046, 0.042), 0.04);  // paw
  f = joined(f, ball(p, {0.0, 0.23, -0.46}, 0.088), 0.03);                                // tail
  double head = ellipsoid(p, {0.0, 0.60, 0.26}, {0.140, 0.135, 0.165});
  head = joined(head, ball(p, {0.045, 0.555, 0.385}, 0.062), 0.07);  // cheek
  head = joined(head, ball(p, {0.0, 0.592, 0.432}, 0.026), 0.025);   // nose
  head = joined(head, eye_field(p), 0.008);
  head = joined(head, ear_field(p), 0.045);
  return joined(f, head, 0.09);
}

/// 1 where `distance` is below 0, 0 beyond `soft`, between them a straight line: the edge of a patch of colour.
double patch(double distance, double soft) {
  const double part = 1.0 - distance / soft;
  return part < 0.0 ? 0.0 : part > 1.0 ? 1.0 : part;
}

/// Lighter below, pink inside the ears and on the nose, dark eyes, white tail; times the material's colour.
glm::dvec3 rabbit_color(const glm::dvec3& at) {
  const glm::dvec3 p(std::fabs(at.x), at.y, at.z);
  glm::dvec3 color(0.78 + 0.22 * patch(p.y, 0.3));
  const auto paint = [&](const glm::dvec3& other, double share) { color += (other - color) * share; };
  paint({1.0, 1.0, 1.0}, patch(ball(p, {0.0, 0.23, -0.50}, 0.09), 0.02));
  if (p.y > 0.74)
    paint({0.95, 0.60, 0.60}, patch(rod(p, {0.085, 0.78, 0.245}, {0.145, 1.02, 0.155}, 0.045, 0.045), 0.012));
  paint({0.9, 0.48, 0.5}, patch(ball(p, {0.0, 0.600, 0.450}, 0.022), 0.012));
  paint({0.03, 0.025, 0.04}, patch(eye_field(p), 0.010));
  return color;
}

}  // namespace

Mesh rabbit_mesh() {
  Mesh mesh = surface_net(rabbit_field, {-0.3151, -0.0217, -0.5731}, {52, 93, 86}, 0.0122);
  mesh.name = "rabbit";
  split_edges(mesh, kRabbitTriangles);
  for (size_t v = 0; v < mesh.vertex_count(); ++v) {
    const glm::dvec3 color = rabbit_color({mesh.position[0][v], mesh.position[1][v], mesh.position[2][v]});
    for (int k = 0; k < 3; ++k) mesh.color[size_t(k)].push_back(float(color[k]));
    mesh.color[3].push_back(1.0f);
  }
  order_in_patches(mesh);
  return mesh;
}

Scene rabbits(const Parameters& parameters) {
  Scene scene;
  scene.clear = {0.01f, 0.012f, 0.02f, 1.0f};
  scene.materials = {{"snow", {0.86f, 0.85f, 0.83f, 1.0f}},
                     {"sand", {0.76f, 0.62f, 0.46f, 1.0f}},
                     {"slate", {0.50f, 0.52f, 0.58f, 1.0f}},
                     {"clay", {0.66f, 0.42f, 0.32f, 1.0f}}};
  scene.meshes = {rabbit_mesh()};
  Pcg32 random(parameters.seed, 2);
  const uint32_t objects = parameters.objects_or(kRabbitsObjects);
  // Seeds of a sunflower: evenly spread over a disc however many they are; the hill rises towards the middle.
  const double spacing = 0.45, radius = spacing * std::sqrt(double(objects)), top = 0.42 * radius;
  const auto on_hill = [&](double distance, double angle) {
    const double part = distance / radius;
    return glm::dvec3(distance * cosine(angle), top * (1.0 - part * part), distance * sine(angle));
  };
  for (uint32_t i = 0; i < objects; ++i) {
    const double angle = 2.399963229728653 * i;
    const glm::dvec3 at = on_hill(spacing * std::sqrt(i + 0.5), angle);
    const double outward = 0.5 * kPi - angle + random.between(-0.9, 0.9);  // looking down the hill, more or less
    const uint32_t material = random.below(4);
    scene.instances.push_back({0, material, placed(at, glm::dvec3(random.between(0.92, 1.15)), outward)});
  }
  const uint32_t lights = parameters.lights_or(kRabbitsLights);
  const double reach = parameters.reach(kRabbitsLights);
  Pcg32 drift(parameters.seed, 22);
  for (uint32_t i = 0; i < lights; ++i) {
    const double distance = radius * 1.08 * std::sqrt((i + 0.5) / lights), angle = 2.399963229728653 * i + 1.0;
    const glm::dvec3 at = on_hill(distance, angle) + glm::dvec3(0.0, 0.9 + 0.8 * random.real(), 0.0) * reach;
    const double hue = 0.06 + 0.5 * random.real() * random.real() + (i % 4 == 0 ? 0.5 : 0.0);
    const Light light = point_light(at, color_of_hue(hue, 0.55) * random.between(0.55, 0.85), 2.6 * reach);
    const double wide = drift.between(0.3, 0.7) * reach, period = drift.between(4.0, 9.0);
    add_moving(scene, light, {wide, 0.0, 0.0}, {0.0, 0.4 * wide, wide}, period, drift.real());
  }
  scene.camera.eye = glm::vec3(glm::dvec3(0.25, 0.85, 1.35) * radius);
  scene.camera.target = glm::vec3(glm::dvec3(0.0, 0.20, 0.16) * radius);
  scene.camera.fov_y_rad = 0.8f;
  scene.camera.near = 0.1f;
  scene.camera.far = float(10.0 * radius);
  return scene;
}

}  // namespace trueshade::builtin
