#include <cmath>

#include "scenes/builtin/builtin_scenes.h"
#include "scenes/builtin/pcg32.h"
#include "scenes/builtin/texture_pattern.h"
#include "scenes/light_fields.h"
#include "scenes/shapes.h"
#include "scenes/trig.h"

// After the lecture on forward and deferred lighting: a textured room, things on plinths, and spot lights under the
// ceiling whose cones sweep over walls and floor. Textures are patterns of ours, so that they have one hash too.
namespace trueshade::builtin {
namespace {

constexpr uint32_t kLectureLights = 15, kSweeping = 64;  // a little ambient light, and spots
constexpr double kWide = 6.0, kDeep = 4.5, kHigh = 5.0;  // half the width, half the depth, the height

enum RoomMesh : uint32_t { kRoomFloor, kRoomWall, kBlock, kSphere, kKnot, kRabbit };
enum RoomMaterial : uint32_t { kTiles, kBricks, kCeiling, kPlinth, kClay, kBronze, kFur };

/// A unit square as plane_mesh(), its texture repeated u and v times.
Mesh textured_plane(double u, double v) {
  Mesh mesh = plane_mesh(14);
  for (size_t i = 0; i < mesh.vertex_count(); ++i) {
    mesh.uv[0].push_back(float((double(mesh.position[0][i]) + 0.5) * u));
    mesh.uv[1].push_back(float((0.5 - double(mesh.position[2][i])) * v));
  }
  return mesh;
}

Texture with_levels(const TexturePattern& pattern, const char* name) {
  Texture texture = texture_of(pattern);
  texture.name = name;
  build_mip_chain(texture);
  return texture;
}

void add_surfaces(Scene& scene, uint64_t seed) {
  TexturePattern tiles{Pattern::checker, 256, 256, TextureFormat::srgb8_a8, {}, 8, 8, seed};
  tiles.colors = {glm::vec4(0.78f, 0.74f, 0.66f, 1.0f), glm::vec4(0.20f, 0.22f, 0.26f, 1.0f)};
  TexturePattern bricks{Pattern::brick, 512, 512, TextureFormat::srgb8_a8, {}, 8, 16, seed};
  bricks.colors = {glm::vec4(0.62f, 0.34f, 0.25f, 1.0f), glm::vec4(0.70f, 0.67f, 0.62f, 1.0f)};
  scene.textures = {with_levels(tiles, "tiles"), with_levels(bricks, "bricks")};
  const glm::vec4 colors[] = {{1.0f, 1.0f, 1.0f, 1.0f},    {1.0f, 1.0f, 1.0f, 1.0f},    {0.70f, 0.70f, 0.72f, 1.0f},
                              {0.55f, 0.54f, 0.52f, 1.0f}, {0.80f, 0.76f, 0.70f, 1.0f}, {0.72f, 0.52f, 0.28f, 1.0f},
                              {0.84f, 0.80f, 0.74f, 1.0f}};
  const char* names[] = {"tiles", "bricks", "ceiling", "plinth", "clay", "bronze", "fur"};
  for (size_t i = 0; i < std::size(colors); ++i) {
    scene.materials.push_back({names[i], colors[i]});
    if (i <= kBricks) scene.materials[i].color_map.texture = int32_t(i);
  }
}

/// A side of the room: the plane mesh turned so that its normal becomes `up` and its x axis `side`.
void add_side(Scene& scene, RoomMesh mesh, RoomMaterial material, const glm::vec3& centre, const glm::vec3& side,
              const glm::vec3& up, const glm::vec3& front) {
  scene.instances.push_back({mesh, material, glm::mat4x3(side, up, front, centre)});
}

void add_room(Scene& scene) {
  const float w = float(2.0 * kWide), d = float(2.0 * kDeep), h = float(kHigh);
  const glm::vec3 x(1.0f, 0.0f, 0.0f), y(0.0f, 1.0f, 0.0f), z(0.0f, 0.0f, 1.0f), middle(0.0f, 0.5f * h, 0.0f);
  add_side(scene, kRoomFloor, kTiles, glm::vec3(0.0f), w * x, y, d * z);
  add_side(scene, kRoomWall, kCeiling, h * y, w * x, -y, -d * z);
  add_side(scene, kRoomWall, kBricks, middle - 0.5f * d * z, w * x, z, -h * y);
  add_side(scene, kRoomWall, kBricks, middle - 0.5f * w * x, -d * z, x, -h * y);
  add_side(scene, kRoomWall, kBricks, middle + 0.5f * w * x, d * z, -x, -h * y);
}

void add_things(Scene& scene) {
  const double x[] = {-3.0, 0.0, 3.0}, z[] = {-1.2, -2.0, -1.2};
  for (int i = 0; i < 3; ++i) scene.instances.push_back({kBlock, kPlinth, placed({x[i], 0.4, z[i]}, {1.3, 0.8, 1.3})});
  scene.instances.push_back({kRabbit, kFur, placed({x[0], 0.8, z[0]}, glm::dvec3(1.5), 0.5)});
  scene.instances.push_back({kKnot, kBronze, placed({x[1], 1.65, z[1]}, glm::dvec3(0.75))});
  scene.instances.push_back({kSphere, kClay, placed({x[2], 1.5, z[2]}, glm::dvec3(0.7))});
  scene.instances.push_back({kBlock, kClay, placed({-1.7, 0.35, 1.2}, glm::dvec3(0.7), 0.5)});
  scene.instances.push_back({kSphere, kBronze, placed({1.6, 0.45, 1.0}, glm::dvec3(0.45))});
}

/// A spot light from `from` to `to` that goes round the point it shines at.
void add_spot(Scene& scene, const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& color, double reach,
              Pcg32& drift) {
  Light light = point_light(from, color, 8.0 * reach);
  light.type = LightType::spot;
  light.direction = glm::vec3(unit(to - from));
  light.cone_rad = 0.34f;
  light.penumbra_rad = 0.12f;
  const uint32_t index = uint32_t(scene.lights.size());
  const double period = drift.between(6.0, 12.0);
  if (index < kSweeping) {
    Track track;
    track.repeats = true;
    track.end = period;
    for (int i = 0; i <= 8; ++i) {
      const double angle = 2.0 * kPi * i / 8;
      const glm::dvec3 at = to + glm::dvec3(1.0 - cosine(angle), 0.0, sine(angle)) * 0.7;
      track.times.push_back(period * i / 8);
      track.values.emplace_back(i % 8 == 0 ? glm::dvec3(light.direction) : unit(at - from), 0.0);
    }
    scene.timeline.lights.push_back({index, LightProperty::direction, std::move(track)});
  }
  scene.lights.push_back(light);
}

}  // namespace

Scene lecture(const Parameters& parameters) {
  Scene scene;
  scene.clear = {0.01f, 0.01f, 0.015f, 1.0f};
  add_surfaces(scene, parameters.seed);
  scene.meshes = {
      textured_plane(3.0, 2.25), textured_plane(5.0, 2.5), cube_mesh(), sphere_mesh(28), knot_mesh(), rabbit_mesh()};
  add_room(scene);
  add_things(scene);
  Pcg32 random(parameters.seed, 8), drift(parameters.seed, 28);
  const uint32_t lights = parameters.lights_or(kLectureLights);
  const double reach = parameters.reach(kLectureLights);
  const glm::dvec3 things[] = {{-3.0, 1.4, -1.2}, {0.0, 1.6, -2.0}, {3.0, 1.4, -1.2}};
  for (uint32_t i = 0; i < lights; ++i) {
    if (i == 0) {
      scene.lights.push_back(ambient_light({0.07f, 0.07f, 0.09f}));
      continue;
    }
    // A third shines at the things, a third at the floor, a third at the wall behind.
    const glm::dvec2 even = even_point(i);
    const glm::dvec3 from((even.x - 0.5) * 1.6 * kWide, kHigh - 0.3, (even.y - 0.35) * 1.5 * kDeep);
    const double aside = random.between(-1.5, 1.5), high = random.between(1.0, 2.8);
    const glm::dvec3 to = i % 3 == 0   ? things[i / 3 % 3]
                          : i % 3 == 1 ? glm::dvec3(0.8 * from.x + aside, 0.0, from.z - 1.0)
                                       : glm::dvec3(from.x + aside, high, -kDeep);
    const glm::dvec3 color = i % 3 == 0 ? glm::dvec3(1.0, 0.88, 0.70) : color_of_hue(0.381966 * i + 0.05, 0.6);
    add_spot(scene, from, to, color * random.between(0.32, 0.50), reach, drift);
  }
  scene.camera.eye = {0.6f, 2.4f, 8.6f};
  scene.camera.target = {0.0f, 1.55f, -1.5f};
  scene.camera.fov_y_rad = 0.80f;
  scene.camera.near = 0.1f;
  scene.camera.far = 60.0f;
  return scene;
}

}  // namespace trueshade::builtin
