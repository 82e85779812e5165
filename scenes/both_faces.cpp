#include "scenes/both_faces.h"

#include <glm/geometric.hpp>
#include <vector>

#include "core/fp_env.h"
#include "scenes/placement.h"

namespace trueshade {
bool is_wound_by_normals(const Mesh& mesh) {
  constexpr size_t kMost = 65536, kFew = 50;  // triangles looked at; one in so many may be otherwise
  const size_t triangles = mesh.indices.size() / 3, step = triangles / kMost + 1;
  size_t looked_at = 0, otherwise = 0;
  const FpScope fp;
  for (size_t t = 0; t < triangles; t += step, ++looked_at) {
    glm::dvec3 corner[3], normal(0.0);
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t v = mesh.indices[3 * t + k];
      corner[k] = {mesh.position[0][v], mesh.position[1][v], mesh.position[2][v]};
      normal += glm::dvec3(mesh.normal[0][v], mesh.normal[1][v], mesh.normal[2][v]);
    }
    otherwise += glm::dot(glm::cross(corner[1] - corner[0], corner[2] - corner[0]), normal) < 0.0;
  }
  return otherwise * kFew <= looked_at;
}

size_t light_both_faces(Scene& scene, std::span<const uint8_t> is_wound) {
  std::vector<uint8_t> found, keeps(scene.materials.size());
  if (is_wound.size() != scene.meshes.size()) {
    for (const Mesh& mesh : scene.meshes) found.push_back(is_wound_by_normals(mesh));
    is_wound = found;
  }
  for (const Instance& drawn : scene.instances)
    if (is_wound[drawn.mesh] == 0 || mirrors(drawn.world_from_object) != drawn.mirrored) keeps[drawn.material] = 1;
  size_t kept = 0;
  for (size_t m = 0; m < scene.materials.size(); ++m)
    if (keeps[m] == 0)
      scene.materials[m].double_sided = true;
    else
      kept += scene.materials[m].double_sided ? 0 : 1;
  return kept;
}

}  // namespace trueshade
