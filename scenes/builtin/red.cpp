#include <vector>

#include "scenes/builtin/builtin_scenes.h"
#include "scenes/builtin/pcg32.h"
#include "scenes/shapes.h"
#include "scenes/trig.h"

// A canyon in red rock: one mesh of 2000 x 2000 vertices, terraced along a meandering river, under a faint ambient
// light, point lights on the slopes and spot lights from above.
namespace trueshade::builtin {
namespace {

constexpr uint32_t kRedLights = 100;
constexpr int kSide = 2000;       // vertices
constexpr double kExtent = 40.0;  // scene units across

/// Value noise: random heights on a lattice of whole numbers, joined by smooth steps. In [0, 1].
class Noise {
 public:
  explicit Noise(uint64_t seed) : heights_(kMask + 1) {
    Pcg32 random(seed, 7);
    for (float& h : heights_) h = float(random.below(1 << 16)) * (1.0f / 65536.0f);
  }

  double at(double x, double y) const {
    const double fx = std::floor(x), fy = std::floor(y);
    const uint32_t ix = uint32_t(int(fx)), iy = uint32_t(int(fy));
    const double s = smooth(x - fx), t = smooth(y - fy);
    const double a = lattice(ix, iy), b = lattice(ix + 1, iy), c = lattice(ix, iy + 1), d = lattice(ix + 1, iy + 1);
    const double low = a + (b - a) * s, high = c + (d - c) * s;
    return low + (high - low) * t;
  }

 private:
  static constexpr uint32_t kMask = 4095;
  static double smooth(double t) { return t * t * (3.0 - 2.0 * t); }
  double lattice(uint32_t x, uint32_t y) const {
    const uint32_t mixed = (x * 0x9E3779B1u) ^ (y * 0x85EBCA77u);
    return double(heights_[(mixed ^ (mixed >> 15)) & kMask]);
  }
  std::vector<float> heights_;
};

double clamp01(double x) { return x < 0.0 ? 0.0 : x > 1.0 ? 1.0 : x; }

/// Height of the rock at (x, z), in [0, 6] or so.
double rock_height(const Noise& noise, double x, double z) {
  const double warp = noise.at(x * 0.21 + 7.3, z * 0.21);
  const double river = x + 4.2 * (noise.at(z * 0.13 + 3.1, 11.0) - 0.5) * 2.0 + 1.4 * (warp - 0.5);
  const double from_river = river < 0.0 ? -river : river;
  const double wall = clamp01((from_river - 1.2) * 0.13);
  const double hills = noise.at(x * 0.33, z * 0.33 + 20.0) * 0.6 + noise.at(x * 0.9 + 5.0, z * 0.9) * 0.25;
  const double mass = (wall * wall * (3.0 - 2.0 * wall)) * 5.0 + hills * (0.35 + 2.2 * wall);
  // Terraces: flat treads and steep risers, as layers of rock weather.
  const double layer = mass * 1.5 + 1.6 * noise.at(x * 0.17 + 2.0, z * 0.17), tread = std::floor(layer),
               rise = clamp01((layer - tread - 0.62) * 2.63);
  const double terraced = (tread + rise * rise * (3.0 - 2.0 * rise)) * (1.0 / 1.5);
  const double detail =
      noise.at(x * 3.1, z * 3.1) * 0.10 + noise.at(x * 8.7, z * 8.7) * 0.035 + noise.at(x * 23.0, z * 23.0) * 0.012;
  return terraced * 0.8 + mass * 0.2 + detail;
}

Mesh rock_mesh(const Noise& noise) {
  Mesh mesh;
  mesh.name = "rock";
  const double step = kExtent / (kSide - 1);
  std::vector<double> height(size_t(kSide) * kSide);
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column)
      height[size_t(row) * kSide + size_t(column)] =
          rock_height(noise, column * step - kExtent / 2, row * step - kExtent / 2);
  for (int k = 0; k < 3; ++k) {
    mesh.position[size_t(k)].reserve(height.size());
    mesh.normal[size_t(k)].reserve(height.size());
  }
  const auto h = [&](int column, int row) {
    return height[size_t(row < 0        ? 0
                         : row >= kSide ? kSide - 1
                                        : row) *
                      kSide +
                  size_t(column < 0        ? 0
                         : column >= kSide ? kSide - 1
                                           : column)];
  };
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column)
      add_vertex(mesh, {column * step - kExtent / 2, h(column, row), row * step - kExtent / 2},
                 unit({h(column - 1, row) - h(column + 1, row), 2.0 * step, h(column, row - 1) - h(column, row + 1)}));
  mesh.indices.reserve(size_t(kSide - 1) * (kSide - 1) * 6);
  for_each_quad_in_patches(kSide - 1, kSide - 1, [&](int column, int row) {
    const uint32_t a = uint32_t(row * kSide + column), d = a + kSide;
    add_quad(mesh, a, d, d + 1, a + 1);
  });
  return mesh;
}

Light spot_light(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& color, double range) {
  Light light = point_light(from, color, range);
  light.type = LightType::spot;
  light.direction = glm::vec3(unit(to - from));
  light.cone_rad = 0.45f;
  light.penumbra_rad = 0.2f;
  return light;
}

}  // namespace

Scene red(const Parameters& parameters) {
  Scene scene;
  scene.clear = {0.035f, 0.014f, 0.03f, 1.0f};
  scene.materials = {{"rock", {0.80f, 0.44f, 0.31f, 1.0f}}};
  const Noise noise(parameters.seed);
  scene.meshes.push_back(rock_mesh(noise));
  scene.instances.push_back({});

  Pcg32 random(parameters.seed, 4);
  const uint32_t lights = parameters.lights_or(kRedLights);
  const double reach = parameters.reach(kRedLights);
  Pcg32 drift(parameters.seed, 24);
  for (uint32_t i = 0; i < lights; ++i) {
    if (i == 0) {
      scene.lights.push_back(ambient_light({0.04f, 0.045f, 0.09f}));
      continue;
    }
    const glm::dvec2 even = even_point(i);
    const double x = (even.x - 0.5) * 0.96 * kExtent, z = (even.y - 0.5) * 0.96 * kExtent;
    const glm::dvec3 ground(x, rock_height(noise, x, z), z);
    const double pick = random.real();
    const glm::dvec3 color = pick < 0.5    ? glm::dvec3(1.0, 0.72, 0.42)
                             : pick < 0.85 ? glm::dvec3(0.45, 0.62, 1.0)
                                           : glm::dvec3(1.0, 0.32, 0.5);
    if (i % 3 == 0) {
      const glm::dvec3 above = ground + glm::dvec3{random.between(-2.0, 2.0), 5.0, random.between(-2.0, 2.0)} * reach;
      add_moving(scene, spot_light(above, ground, color * 0.65, 12.0 * reach), {1.5 * reach, 0.0, 0.0},
                 {0.0, 0.0, 1.5 * reach}, 11.0, drift.real());
    } else {
      const double period = drift.between(5.0, 9.0);
      add_moving(scene, point_light(ground + glm::dvec3(0.0, 1.3 * reach, 0.0), color * 0.5, 6.5 * reach),
                 {0.7 * reach, 0.0, 0.0}, {0.0, 0.25 * reach, 0.7 * reach}, period, drift.real());
    }
  }
  scene.camera.eye = {1.0f, 11.0f, 23.0f};
  scene.camera.target = {0.0f, 1.0f, 0.0f};
  scene.camera.fov_y_rad = 0.8f;
  scene.camera.near = 0.1f;
  scene.camera.far = 200.0f;
  return scene;
}

}  // namespace trueshade::builtin
