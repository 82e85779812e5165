#include "cli/scene_facts.h"

#include <algorithm>
#include <limits>
#include <span>

#include "bands/large_picture.h"
#include "cli/preparation.h"
#include "core/memory_cap.h"
#include "shading/frame_memory.h"

namespace trueshade {
namespace {

constexpr uint64_t kMostVertices = 100'000'000;  // that are placed, in a second or so
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct GrowingBox {
  glm::dvec3 least{kInfinity}, most{-kInfinity};

  void add(const glm::dvec3& point) {
    for (int k = 0; k < 3; ++k) least[k] = std::min(least[k], point[k]), most[k] = std::max(most[k], point[k]);
  }
  bool is_empty() const { return !(least.x <= most.x); }
  bool contains(const GrowingBox& other) const {
    for (int k = 0; k < 3; ++k)
      if (other.least[k] < least[k] || other.most[k] > most[k]) return false;
    return true;
  }
};

glm::dvec3 vertex_of(const Mesh& mesh, uint32_t index) {
  return {mesh.position[0][index], mesh.position[1][index], mesh.position[2][index]};
}

glm::dvec3 in_world(const Instance& instance, const glm::dvec3& point) {
  glm::dvec3 at(instance.world_from_object[3]);
  for (int k = 0; k < 3; ++k) at += glm::dvec3(instance.world_from_object[k]) * point[k];
  return at;
}

GrowingBox placed(const GrowingBox& box, const Instance& instance) {
  GrowingBox out;
  for (int corner = 0; corner < 8; ++corner)
    out.add(in_world(instance, {(corner & 1 ? box.most : box.least).x, (corner & 2 ? box.most : box.least).y,
                                (corner & 4 ? box.most : box.least).z}));
  return out;
}

std::vector<std::pair<std::string_view, uint64_t>> lights_by_type(const Scene& scene) {
  std::vector<std::pair<std::string_view, uint64_t>> out;
  for (const LightTypeRow& row : kLightTypes) {
    const auto count = std::count_if(scene.lights.begin(), scene.lights.end(),
                                     [&row](const Light& light) { return &row_of(light.type) == &row; });
    if (count != 0) out.emplace_back(row.name, uint64_t(count));
  }
  return out;
}

std::vector<MapUses> uses_of_textures(const Scene& scene) {
  std::vector<MapUses> uses(scene.textures.size());
  for (const Material& material : scene.materials) {
    const auto maps = maps_of(material);
    for (size_t m = 0; m < maps.size(); ++m)
      if (maps[m]->used()) ++uses[size_t(maps[m]->texture)][m];
  }
  return uses;
}

RenderMemory memory_of(const Scene& scene, const Pipeline& pipeline) {
  RenderMemory memory{resident_memory(), {}, memory_cap()};
  if (is_large(pipeline, {})) return memory;
  const std::string picture = "picture.png";
  memory.needed = predicted_memory(scene, pipeline, {}, {}) + file_memory(pipeline, {}, std::span(&picture, 1), {});
  return memory;
}

}  // namespace

std::optional<WorldBox> drawn_box(const Scene& scene) {
  std::vector<GrowingBox> boxes(scene.meshes.size());
  for (size_t m = 0; m < scene.meshes.size(); ++m)
    for (const uint32_t index : scene.meshes[m].indices) boxes[m].add(vertex_of(scene.meshes[m], index));
  GrowingBox all;
  uint64_t left = kMostVertices;
  const size_t count = scene.instances.size() - (scene.ground_of_ours && !scene.instances.empty() ? 1 : 0);
  for (const Instance& instance : std::span(scene.instances).first(count)) {
    if (boxes[instance.mesh].is_empty()) continue;
    const GrowingBox around = placed(boxes[instance.mesh], instance);
    if (all.contains(around)) continue;  // and so all of its vertices
    const Mesh& mesh = scene.meshes[instance.mesh];
    if (left < mesh.indices.size()) {
      all.add(around.least), all.add(around.most);
      continue;
    }
    left -= mesh.indices.size();
    for (const uint32_t index : mesh.indices) all.add(in_world(instance, vertex_of(mesh, index)));
  }
  return all.is_empty() ? std::nullopt : std::optional(WorldBox{all.least, all.most});
}

SceneFacts facts_of(Scene& scene, const Pipeline& pipeline, double time) {
  SceneFacts facts;
  facts.hash = scene_hash(scene);
  set_time(scene, time);
  facts.box = drawn_box(scene);
  for (const Mesh& mesh : scene.meshes) {
    facts.vertices += mesh.vertex_count();
    facts.triangles += mesh.triangle_count();
  }
  facts.lights = lights_by_type(scene);
  facts.textures = uses_of_textures(scene);
  facts.width = pipeline.width, facts.height = pipeline.height;
  facts.memory = memory_of(scene, pipeline);
  return facts;
}

}  // namespace trueshade
