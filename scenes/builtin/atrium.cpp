#include "scenes/builtin/architecture.h"
#include "scenes/builtin/builtin_scenes.h"
#include "scenes/builtin/pcg32.h"
#include "scenes/trig.h"

// A hall with a fountain, for looks: two rows of fluted columns under arches, a gallery above them, a coffered vault;
// warm lanterns in the arcades, cool light in the water and from outside, and small lamps that drift through the air.
namespace trueshade::builtin {
namespace {

constexpr uint32_t kLights = 256;
constexpr int kBays = 8;
constexpr double kBay = 3.2, kLength = kBays * kBay;  // along z
constexpr double kRow = 4.6, kWall = 8.2;             // x of the columns, x of the outer walls
constexpr double kSpring = 3.6, kArchTop = 5.9;       // heights of the lower arcade
constexpr double kGallerySpring = 7.3, kVault = 8.9;

enum MeshId : uint32_t { kCube, kColumn, kArch, kSmallColumn, kSmallArch, kVaultMesh, kBasin, kBowl, kWater, kBall };
enum MaterialId : uint32_t {
  kStone,
  kMarble,
  kDark,
  kTileLight,
  kTileDark,
  kTileRed,
  kPlaster,
  kWaterBlue,
  kBrass,
  kPainted,
  kClearGlass,  // and six tinted ones; of glass=1
  kTintedGlass
};
constexpr int kTints = 6;

/// Base, fluted shaft with a little swelling, and capital; 1 high, for a shaft of radius 0.1.
Profile column_profile() {
  std::vector<glm::dvec2> shaft;
  for (int i = 0; i <= 20; ++i) {
    const double t = i / 20.0;
    shaft.emplace_back(0.082 - 0.014 * t + 0.006 * sine(kPi * t), 0.09 + 0.76 * t);
  }
  return {{{0.13, 0.0}, {0.13, 0.03}},
          rounded({0.130, 0.03}, {0.118, 0.05}, false),
          rounded({0.090, 0.05}, {0.104, 0.062}, true),
          rounded({0.104, 0.062}, {0.088, 0.09}, false),
          shaft,
          rounded({0.070, 0.85}, {0.082, 0.862}, true),
          rounded({0.072, 0.872}, {0.115, 0.94}, false),
          {{0.125, 0.945}, {0.125, 0.965}},
          rounded({0.125, 0.965}, {0.135, 1.0}, true)};
}

Profile basin_profile() {
  return {{{2.05, 0.0}, {2.05, 0.12}},  rounded({2.05, 0.12}, {1.92, 0.20}, false),
          {{1.92, 0.20}, {1.90, 0.45}}, rounded({1.90, 0.45}, {2.06, 0.56}, false),
          {{2.06, 0.56}, {2.06, 0.64}}, {{2.06, 0.64}, {1.80, 0.66}},
          {{1.80, 0.66}, {1.74, 0.30}}};
}

/// A stem and a bowl on it; of radius 1, 1 high to the rim.
Profile bowl_profile() {
  return {rounded({0.42, 0.0}, {0.17, 0.16}, false),
          {{0.17, 0.16}, {0.14, 0.4}, {0.15, 0.55}},
          rounded({0.15, 0.55}, {0.24, 0.62}, true),
          rounded({0.24, 0.62}, {1.0, 0.96}, true, 10),
          {{1.0, 0.96}, {1.02, 1.0}},
          {{1.02, 1.0}, {0.94, 1.0}},
          {{0.94, 1.0}, {0.88, 0.9}}};
}

/// Places the parts of the hall.
class Builder {
 public:
  explicit Builder(Scene& scene) : scene_(scene) {}

  void build(bool glass) {
    floor();
    for (const double side : {-1.0, 1.0}) {
      arcade(side);
      wall(side);
    }
    add(kVaultMesh, kPainted, {0.0, kVault, 0.0}, {kRow, kRow * 0.8, 1.0});
    ends();
    fountain();
    if (glass) glazing();
  }

 private:
  void add(MeshId mesh, MaterialId material, const glm::dvec3& at, const glm::dvec3& scale, double turn_rad = 0.0) {
    scene_.instances.push_back({mesh, material, placed(at, scale, turn_rad)});
  }
  void box(MaterialId material, const glm::dvec3& at, const glm::dvec3& size) { add(kCube, material, at, size); }

  void floor() {
    box(kDark, {0.0, -0.16, 0.0}, {2.0 * kWall, 0.2, kLength});
    const int across = 16, along = int(kLength);
    for (int row = 0; row <= along; ++row)
      for (int column = 0; column <= across; ++column) {
        const double x = column - across / 2, z = row - along / 2.0;
        const bool border = std::abs(column - across / 2) == 5;
        const MaterialId material = border ? kTileRed : (row + column) % 2 == 0 ? kTileLight : kTileDark;
        box(material, {x, -0.05, z}, {0.97, 0.1, 0.97});
      }
  }

  void arcade(double side) {
    const double x = side * kRow;
    for (int i = 0; i <= kBays; ++i) {
      const double z = (i - kBays / 2.0) * kBay;
      box(kDark, {x, 0.09, z}, {1.1, 0.18, 1.1});
      add(kColumn, kMarble, {x, 0.18, z}, {4.1, kSpring - 0.38, 4.1});
      box(kStone, {x, kSpring - 0.1, z}, {1.16, 0.2, 1.0});
      for (const double half : {-0.5, 0.5})
        if (i < kBays)
          add(kSmallColumn, kMarble, {x, 6.25, z + (0.5 + half * 0.94) * kBay}, {1.5, kGallerySpring - 6.25, 1.5});
      if (i == kBays) continue;
      add(kSmallColumn, kMarble, {x, 6.25, z + 0.5 * kBay}, {1.5, kGallerySpring - 6.25, 1.5});
      add(kArch, kStone, {x, kSpring, z + 0.5 * kBay}, glm::dvec3(1.0), 0.5 * kPi);
      for (const double quarter : {0.25, 0.75})
        add(kSmallArch, kStone, {x, kGallerySpring, z + quarter * kBay}, glm::dvec3(1.0), 0.5 * kPi);
    }
    box(kMarble, {x, kArchTop + 0.08, 0.0}, {1.0, 0.16, kLength});  // cornice under the gallery
    box(kStone, {x, kArchTop + 0.24, 0.0}, {0.84, 0.16, kLength});
    box(kMarble, {x, kVault - 0.16, 0.0}, {0.9, 0.14, kLength});
    box(kStone, {x, kVault - 0.05, 0.0}, {1.06, 0.12, kLength});
  }

  void wall(double side) {
    box(kPlaster, {side * (kWall + 0.1), 4.5, 0.0}, {0.2, 9.0, kLength});
    box(kDark, {side * (kWall - 0.03), 0.35, 0.0}, {0.1, 0.7, kLength});
    box(kPlaster, {side * (kRow + kWall) / 2, kArchTop + 0.1, 0.0}, {kWall - kRow, 0.24, kLength});  // aisle's ceiling
    for (int i = 0; i <= kBays; ++i)
      box(kStone, {side * (kWall - 0.1), 2.95, (i - kBays / 2.0) * kBay}, {0.3, 5.9, 0.6});
  }

  void ends() {
    const double z = -kLength / 2;
    for (const double side : {-1.0, 1.0}) {
      box(kPlaster, {side * 5.6, 4.5, z - 0.3}, {5.4, 9.0, 0.6});
      box(kStone, {side * 2.75, 2.3, z - 0.1}, {0.5, 4.6, 0.8});
      add(kColumn, kMarble, {side * 2.3, 0.0, z + 0.35}, {3.6, 4.4, 3.6});
    }
    add(kArch, kStone, {0.0, 4.6, z - 0.2}, {1.78, 1.78, 1.0});
    box(kPlaster, {0.0, 10.9, z - 0.3}, {16.0, 4.4, 0.6});
    box(kDark, {0.0, 0.06, z}, {5.0, 0.24, 1.6});
    box(kPlaster, {0.0, 5.5, kLength / 2 + 0.3}, {16.8, 15.0, 0.6});
  }

  void fountain() {
    const double z = -2.2;
    box(kDark, {0.0, 0.05, z}, {5.2, 0.1, 5.2});
    add(kBasin, kMarble, {0.0, 0.08, z}, glm::dvec3(1.0));
    add(kWater, kWaterBlue, {0.0, 0.60, z}, {1.78, 1.0, 1.78});
    add(kBowl, kMarble, {0.0, 0.4, z}, {1.05, 1.25, 1.05});
    add(kWater, kWaterBlue, {0.0, 1.60, z}, {0.95, 0.8, 0.95}, 1.0);
    add(kBowl, kMarble, {0.0, 1.45, z}, {0.55, 0.85, 0.55});
    add(kWater, kWaterBlue, {0.0, 2.27, z}, {0.50, 0.6, 0.50}, 2.0);
    add(kBall, kBrass, {0.0, 2.42, z}, glm::dvec3(0.2));
    for (int i = 0; i < 8; ++i) {
      const double angle = 2.0 * kPi * (i + 0.5) / 8;
      add(kBall, kBrass, {1.93 * cosine(angle), 0.83, z + 1.93 * sine(angle)}, glm::dvec3(0.11));
    }
  }

  /// From far to near as the camera looks, so that drawing in order is drawing back to front.
  void glazing() {
    const auto tinted = [](int i) { return MaterialId(int(kTintedGlass) + (i + kTints) % kTints); };
    for (int i = 0; i < kBays; ++i) {
      const double z = (i + 0.5 - kBays / 2.0) * kBay;
      for (const double side : {-1.0, 1.0}) box(tinted(i + int(side)), {side * kRow, 2.0, z}, {0.03, 3.0, kBay - 1.5});
      if (i != 2) continue;
      for (int k = -3; k <= 3; ++k) box(tinted(k), {0.98 * k, 1.75, z}, {0.9, 3.3, 0.04});  // a screen across the nave
    }
    add(kBall, kClearGlass, {0.0, 3.25, -2.2}, glm::dvec3(0.62));
    add(kBall, tinted(2), {-1.7, 1.0, 3.4}, glm::dvec3(0.55));
    add(kBall, tinted(4), {2.3, 0.75, 4.6}, glm::dvec3(0.4));
  }

  Scene& scene_;
};

Light lamp(const glm::dvec3& at, const glm::dvec3& color, double range) { return point_light(at, color, range); }

/// The hall's own lights, the most telling first, until there are `count`.
void add_lights(Scene& scene, uint32_t count, double reach, Pcg32& random) {
  const auto full = [&] { return scene.lights.size() >= count; };
  const auto put = [&](const Light& light) {
    if (!full()) scene.lights.push_back(light);
  };
  put(ambient_light({0.050f, 0.052f, 0.075f}));
  put(lamp({0.0, 5.4, -kLength / 2 - 2.4}, {0.34, 0.52, 0.95}, 15.0));  // the night outside
  put(lamp({0.0, 7.4, 5.5}, {0.30, 0.26, 0.22}, 13.0));                 // behind the viewer
  for (int i = 0; i < 10; ++i) {                                        // in the water
    const double angle = 2.0 * kPi * i / 10;
    put(lamp({1.35 * cosine(angle), 0.95, -2.2 + 1.35 * sine(angle)}, {0.08, 0.30, 0.35}, 2.9));
  }
  put(lamp({0.0, 3.6, -2.2}, {0.42, 0.52, 0.62}, 5.0));
  for (int i = 0; i < 5; ++i)  // chandeliers
    put(lamp({0.0, 6.1, 8.0 - 4.6 * i}, {0.50, 0.42, 0.34}, 7.0));
  for (int i = 0; i < kBays; ++i)  // lanterns under the arches
    for (const double side : {-1.0, 1.0}) {
      const double z = (kBays / 2.0 - 0.5 - i) * kBay;
      put(lamp({side * (kRow + 1.7), 3.3, z}, {0.95, 0.52, 0.22}, 5.2));
      put(lamp({side * kRow, 4.2, z}, {0.55, 0.33, 0.15}, 3.0));
    }
  for (int i = 0; i < kBays; ++i)  // up on the gallery, towards the vault
    for (const double side : {-1.0, 1.0}) {
      const double z = (kBays / 2.0 - 0.5 - i) * kBay;
      put(lamp({side * (kRow - 0.75), kVault + 0.25, z}, {0.50, 0.34, 0.26}, 4.4));
      put(lamp({side * (kRow + 1.3), 7.0, z}, {0.40, 0.25, 0.40}, 3.4));
    }
  for (int i = 0; i <= kBays; ++i)  // at the columns' feet
    for (const double side : {-1.0, 1.0})
      put(lamp({side * (kRow - 0.95), 0.35, (kBays / 2.0 - i) * kBay}, {0.60, 0.30, 0.12}, 2.2));
  Pcg32 drift(random.next(), 27);
  for (uint32_t i = 0; !full(); ++i) {  // fireflies
    const glm::dvec2 even = even_point(i);
    const glm::dvec3 at{(even.x - 0.5) * 2.0 * (kRow - 0.9), 0.3 + 5.6 * random.real() * random.real(),
                        (even.y - 0.5) * (kLength - 2.0)};
    const double pick = random.real();
    const glm::dvec3 color = color_of_hue(pick < 0.6 ? 0.09 + 0.06 * random.real() : 0.48 + 0.36 * random.real(), 0.75);
    const double wide = drift.between(0.2, 0.7), period = drift.between(5.0, 12.0);
    add_moving(scene, lamp(at, color * random.between(0.16, 0.40), 1.7 * reach), {wide, 0.0, 0.0},
               {0.0, 0.3 * wide, wide}, period, drift.real());
  }
}

}  // namespace

Scene atrium(const Parameters& parameters) {
  Scene scene;
  scene.clear = {0.03f, 0.05f, 0.12f, 1.0f};
  const glm::vec4 colors[] = {{0.74f, 0.68f, 0.59f, 1.0f}, {0.86f, 0.84f, 0.80f, 1.0f}, {0.30f, 0.28f, 0.29f, 1.0f},
                              {0.74f, 0.69f, 0.60f, 1.0f}, {0.34f, 0.30f, 0.29f, 1.0f}, {0.52f, 0.26f, 0.20f, 1.0f},
                              {0.66f, 0.56f, 0.47f, 1.0f}, {0.25f, 0.52f, 0.58f, 1.0f}, {0.85f, 0.62f, 0.28f, 1.0f},
                              {1.0f, 1.0f, 1.0f, 1.0f}};
  const char* names[] = {"stone",    "marble",  "dark",  "tile",  "dark tile",
                         "red tile", "plaster", "water", "brass", "painted"};
  for (size_t i = 0; i < std::size(colors); ++i) {
    scene.materials.push_back({names[i], colors[i]});
  }
  if (parameters.glass) {
    const glm::vec4 tints[kTints] = {{0.95f, 0.55f, 0.15f, 0.4f},  {0.20f, 0.45f, 0.95f, 0.45f},
                                     {0.25f, 0.80f, 0.40f, 0.4f},  {0.90f, 0.25f, 0.35f, 0.45f},
                                     {0.55f, 0.35f, 0.90f, 0.45f}, {0.95f, 0.85f, 0.35f, 0.35f}};
    scene.materials.push_back({"clear glass", {0.85f, 0.95f, 0.98f, 0.2f}});
    for (const glm::vec4& tint : tints) scene.materials.push_back({"tinted glass", tint});
    for (size_t i = kClearGlass; i < scene.materials.size(); ++i) scene.materials[i].transparent = true;
  }
  const double radius = 0.5 * kBay - 0.42, small = 0.25 * kBay - 0.16;
  scene.meshes = {cube_mesh(),
                  turned_mesh(column_profile(), 160, 20, 0.10),
                  arch_mesh(kBay, kArchTop - kSpring, 0.7, radius),
                  turned_mesh(column_profile(), 40),
                  arch_mesh(0.5 * kBay, kVault - 0.2 - kGallerySpring, 0.45, small),
                  vault_mesh(9, 16, kLength, 0.055, {0.80, 0.74, 0.62}, {0.22, 0.33, 0.58}),
                  turned_mesh(basin_profile(), 80),
                  turned_mesh(bowl_profile(), 80),
                  water_mesh(0.006),
                  sphere_mesh(14)};
  Builder(scene).build(parameters.glass);
  Pcg32 random(parameters.seed, 7);
  add_lights(scene, parameters.lights_or(kLights), parameters.reach(kLights), random);
  scene.camera.eye = {1.7f, 2.5f, 9.6f};
  scene.camera.target = {-0.45f, 3.75f, -4.0f};
  scene.camera.fov_y_rad = 1.12f;
  scene.camera.near = 0.1f;
  scene.camera.far = 80.0f;
  return scene;
}

}  // namespace trueshade::builtin
