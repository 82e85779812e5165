#include <algorithm>
#include <bit>
#include <span>

#include "core/sha256.h"
#include "scenes/scene.h"

// Layout of the hashed bytes: every number little-endian, counts as 64-bit before what they count, floats by their bits
// except that -0 counts as 0. Names and the spec are left out: they change no pixel.
namespace trueshade {
namespace {

static_assert(std::endian::native == std::endian::little);

class SceneHasher {
 public:
  void count(size_t n) { add(uint64_t(n)); }
  void add(uint64_t value) { sha_.update(&value, sizeof value); }
  void add(float value) { add(std::span<const float>(&value, 1)); }
  void add(const glm::vec3& v) { add(std::span<const float>(&v.x, 3)); }
  void add(const glm::vec4& v) { add(std::span<const float>(&v.x, 4)); }

  void add(std::span<const float> values) {
    uint32_t bits[1024];
    for (size_t first = 0; first < values.size(); first += std::size(bits)) {
      const size_t n = std::min(std::size(bits), values.size() - first);
      for (size_t i = 0; i < n; ++i)
        bits[i] = std::bit_cast<uint32_t>(values[first + i] == 0.0f ? 0.0f : values[first + i]);
      sha_.update(bits, n * sizeof bits[0]);
    }
  }

  void add(const Mesh& mesh) {
    count(mesh.vertex_count());
    count(mesh.has_uv());
    count(mesh.has_color());
    for (const auto& stream : mesh.position) add(stream);
    for (const auto& stream : mesh.normal) add(stream);
    for (const auto& stream : mesh.uv) add(stream);
    for (const auto& stream : mesh.color) add(stream);
    count(mesh.indices.size());
    sha_.update(mesh.indices.data(), mesh.indices.size() * sizeof mesh.indices[0]);
  }

  void add(const Light& light) {
    add(uint64_t(light.type));
    add(light.position);
    add(light.direction);
    add(light.color);
    add(light.range);
    add(light.attenuation);
    add(light.cone_rad);
    add(light.penumbra_rad);
  }

  /// What scenes of the first layout did not have: absent where it is the default, else behind its place.
  void add_if_set(uint64_t place, const Light& light) {
    if (light.ambient == glm::vec3(0.0f) && light.spot_exponent == 0.0f) return;
    add(place);
    add(light.ambient);
    add(light.spot_exponent);
  }

  void add_if_set(uint64_t place, const Material& material) {
    const Material absent;
    if (material.specular_color == absent.specular_color && material.shininess == absent.shininess &&
        material.emission == absent.emission && material.metallic == absent.metallic &&
        material.roughness == absent.roughness)
      return;
    add(place);
    add(material.specular_color);
    add(material.shininess);
    add(material.emission);
    add(material.metallic);
    add(material.roughness);
  }

  void add(const Camera& camera) {
    add(camera.eye);
    add(camera.target);
    add(camera.up);
    count(camera.fov_x_rad.has_value());
    add(camera.fov_x_rad.value_or(camera.fov_y_rad));
    add(camera.near);
    add(camera.far);
    count(camera.clip_from_world.has_value());
    if (camera.clip_from_world) add(*camera.clip_from_world);
  }

  std::string hex() { return sha_.hex(); }

 private:
  Sha256 sha_;
};

}  // namespace

std::string scene_hash(const Scene& scene) {
  SceneHasher hasher;
  hasher.count(scene.meshes.size());
  for (const Mesh& mesh : scene.meshes) hasher.add(mesh);
  hasher.count(scene.materials.size());
  for (const Material& material : scene.materials) hasher.add(material.base_color);
  hasher.count(scene.instances.size());
  for (const Instance& instance : scene.instances) {
    hasher.add(uint64_t(instance.mesh));
    hasher.add(uint64_t(instance.material));
    for (int column = 0; column < 4; ++column) hasher.add(instance.world_from_object[column]);
  }
  hasher.count(scene.lights.size());
  for (const Light& light : scene.lights) hasher.add(light);
  hasher.add(scene.camera);
  hasher.add(scene.clear);
  constexpr uint64_t kMaterials = uint64_t(1) << 62, kLights = uint64_t(1) << 63;  // no count is as large
  for (size_t i = 0; i < scene.materials.size(); ++i) hasher.add_if_set(kMaterials + i, scene.materials[i]);
  for (size_t i = 0; i < scene.lights.size(); ++i) hasher.add_if_set(kLights + i, scene.lights[i]);
  return hasher.hex();
}

}  // namespace trueshade
