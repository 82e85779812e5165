#include "scenes/baked_uv.h"

#include <algorithm>
#include <map>

#include "core/fp_env.h"

namespace trueshade {
namespace {

static_assert(kMaxUvSets == kMaterialMaps);

using Sources = std::vector<UvSource>;  ///< of the sets of a mesh, in order

/// The distinct sources of a material's maps. One that has no maps leaves set 0.
Sources distinct_sources(const Material& material, const UvSources& of_map) {
  Sources distinct;
  const auto maps = maps_of(material);
  for (size_t i = 0; i < maps.size(); ++i)
    if (maps[i]->used() && std::find(distinct.begin(), distinct.end(), of_map[i]) == distinct.end())
      distinct.push_back(of_map[i]);
  std::stable_sort(distinct.begin(), distinct.end(),
                   [](const UvSource& a, const UvSource& b) { return a.set < b.set; });
  if (distinct.empty()) distinct.emplace_back();
  return distinct;
}

void set_indices(Material& material, const UvSources& of_map, const Sources& distinct) {
  const auto maps = maps_of(material);
  for (size_t i = 0; i < maps.size(); ++i)
    if (maps[i]->used())
      maps[i]->uv_set = uint8_t(std::find(distinct.begin(), distinct.end(), of_map[i]) - distinct.begin());
}

bool are_sets_as_they_stand(const Sources& sources) {
  for (size_t k = 0; k < sources.size(); ++k)
    if (sources[k] != UvSource{uint32_t(k), {}}) return false;
  return true;
}

void bake(const Sources& sources, Mesh& mesh) {
  if (are_sets_as_they_stand(sources)) return;
  std::vector<UvStreams> sets;
  for (const UvSource& source : sources) sets.push_back(baked(mesh.uv_set(source.set), source.transform));
  mesh.uv = std::move(sets.front());
  sets.erase(sets.begin());
  mesh.more_uv = std::move(sets);
}

uint64_t bytes_of(const Mesh& mesh, size_t uv_sets) {
  return sizeof(Mesh) + 4 * (uint64_t(mesh.vertex_count()) * (10 + 2 * uv_sets) + mesh.indices.size());
}

}  // namespace

UvStreams baked(const UvStreams& from, const UvTransform& transform) {
  if (transform == UvTransform()) return from;
  const FpScope fp;
  UvStreams out;
  const UvMatrix matrix(transform);
  for (size_t v = 0; v < from[0].size(); ++v) {
    const glm::vec2 uv = matrix(from[0][v], from[1][v]);
    out[0].push_back(uv.x), out[1].push_back(uv.y);
  }
  return out;
}

void bake_uv(Scene& scene, std::span<const UvSources> sources, const std::function<void(uint64_t)>& take) {
  const FpScope fp;
  std::vector<Sources> of_material;
  for (size_t m = 0; m < scene.materials.size(); ++m) {
    of_material.push_back(distinct_sources(scene.materials[m], sources[m]));
    set_indices(scene.materials[m], sources[m], of_material.back());
  }
  if (std::all_of(of_material.begin(), of_material.end(), are_sets_as_they_stand)) return;
  struct Use {
    Sources sources;
    uint32_t mesh;
  };
  std::vector<std::vector<Use>> uses(scene.meshes.size());  // the first keeps its place
  for (Instance& instance : scene.instances) {
    std::vector<Use>& of_mesh = uses[instance.mesh];
    const Sources& wanted = of_material[instance.material];
    const auto known = std::find_if(of_mesh.begin(), of_mesh.end(), [&](const Use& u) { return u.sources == wanted; });
    if (known == of_mesh.end()) {
      const uint32_t mesh = of_mesh.empty() ? instance.mesh : uint32_t(scene.meshes.size());
      of_mesh.push_back({wanted, mesh});
      take(bytes_of(scene.meshes[instance.mesh], wanted.size()));
      if (mesh != instance.mesh) scene.meshes.push_back(Mesh(scene.meshes[instance.mesh]));
      instance.mesh = mesh;
    } else {
      instance.mesh = known->mesh;
    }
  }
  for (const std::vector<Use>& of_mesh : uses)
    for (const Use& use : of_mesh) bake(use.sources, scene.meshes[use.mesh]);
}

}  // namespace trueshade
