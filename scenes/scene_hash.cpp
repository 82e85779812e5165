#include <algorithm>
#include <array>
#include <bit>
#include <span>

#include "core/fp_env.h"
#include "core/sha256.h"
#include "core/threads/parallel_for.h"
#include "scenes/light_fields.h"
#include "scenes/material_fields.h"
#include "scenes/scene.h"

// Layout of the hashed bytes: every number little-endian, counts as 64-bit before what they count, floats by their bits
// except that -0 counts as 0. Names and the spec are left out: they change no pixel. Textures and what materials do
// with them come last, and only where a material does something. Many texels count by a digest a texture, which all
// cores find together and for which four bytes a texel are read instead of four floats.
//
// What scenes of the first layout did not have counts only where it is not the default, so that no hash moves: behind a
// mark of 2^60 or more, as no count is, plus an index. scene_hash() has the marks; a later field takes one of its own.
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
    if (!mesh.has_tangents()) return;
    add(~uint64_t(0));  // no count is as large
    for (const auto& stream : mesh.tangent) add(stream);
  }

  void add(const Texture& texture) {
    count(texture.levels.size());
    const bool codes = bytes_per_texel(texture.format) == 4;
    std::vector<std::array<float, 4>> of_code;
    if (codes) of_code = values_of_codes(texture.format);
    for (size_t k = 0; k < texture.levels.size(); ++k) {
      const int width = texture.levels[k].width, height = texture.levels[k].height;
      count(size_t(width));
      count(size_t(height));
      std::vector<float> row(4 * size_t(width));
      for (int y = 0; y < height; ++y) {
        const uint8_t* at = texture.levels[k].bytes.data() + 4 * size_t(y) * size_t(width);
        for (int x = 0; codes && x < 4 * width; ++x) row[size_t(x)] = of_code[at[x]][size_t(x % 4)];
        for (int x = 0; !codes && x < width; ++x) {
          const std::array<float, 4> texel = texel_value(texture, k, x, y);
          std::copy(texel.begin(), texel.end(), row.begin() + 4 * ptrdiff_t(x));
        }
        add(row);
      }
    }
  }

  /// texel_value() of each code of 8 bits, in every channel.
  static std::vector<std::array<float, 4>> values_of_codes(TextureFormat format) {
    std::vector<std::array<float, 4>> values;
    Texture all{"", format, {{256, 1, {}}}};
    for (int code = 0; code < 256; ++code) all.levels[0].bytes.insert(all.levels[0].bytes.end(), 4, uint8_t(code));
    for (int code = 0; code < 256; ++code) values.push_back(texel_value(all, 0, code, 0));
    return values;
  }

  /// The texture as it is stored: of codes the bytes, of floats the values.
  void add_stored(const Texture& texture) {
    if (bytes_per_texel(texture.format) != 4) return add(texture);
    add(uint64_t(texture.format));
    count(texture.levels.size());
    for (const TextureLevel& level : texture.levels) {
      count(size_t(level.width));
      count(size_t(level.height));
      sha_.update(level.bytes.data(), level.bytes.size());
    }
  }

  void add(const TextureSlot& slot) {
    count(slot.used());
    if (!slot.used()) return;
    const Sampler& s = slot.sampler;
    count(size_t(slot.texture));
    for (const Wrap wrap : s.wrap) add(uint64_t(wrap));
    for (const Filter filter : {s.mag_filter, s.min_filter}) add(uint64_t(filter));
    add(uint64_t(s.mip_filter));
    for (const float lod : {s.lod_bias, s.lod_min, s.lod_max}) add(lod);
    add(s.border);
  }

  void add_fields(const Material& material, MaterialHash part) {
    visit_fields(material, [&]<typename T>(const MaterialField& row, const T& value) {
      if (row.hash != part) return;
      if constexpr (std::is_same_v<T, bool>)
        count(value);
      else
        add(value);
    });
  }

  void add_maps(const Material& material) {
    add(material.color_map);
    add(material.specular_map);
    add(material.normal_map);
    add_fields(material, MaterialHash::maps);
  }

  void add(const Light& light) {
    add(uint64_t(light.type));
    add_members(light, LightHash::first);
    if (has_area(light.type)) add_members(light, LightHash::area);
  }

  void add_members(const Light& light, LightHash part) {
    visit_members(light, [&](const LightField& row, auto& value) {
      if (row.hash == part) add(value);
    });
  }

  /// Members that scenes of the first layout did not have: absent where all of a part are their defaults, else behind
  /// the part's mark.
  void add_if_set(uint64_t mark, const Light& light, LightHash part) {
    const Light absent;
    bool is_set = false;
    visit_members(light, [&]<typename T>(const LightField& row, const T& value) {
      is_set = is_set || (row.hash == part && value != absent.*std::get<T Light::*>(row.at));
    });
    if (!is_set) return;
    add(mark);
    add_members(light, part);
  }

  void add_if_set(uint64_t mark, const Material& material, MaterialHash part) {
    if (!has_other_than_default(material, part)) return;
    add(mark);
    add_fields(material, part);
  }

  /// What materials and meshes of the second layout did not have.
  void add_newer(uint64_t place, const Material& material) {
    const std::array maps = {&material.metallic_roughness_map, &material.emission_map, &material.occlusion_map};
    if (std::none_of(maps.begin(), maps.end(), [](const TextureSlot* map) { return map->used(); }) &&
        !has_other_than_default(material, MaterialHash::newer))
      return;
    add(place);
    for (const TextureSlot* map : maps) add(*map);
    add_fields(material, MaterialHash::newer);
  }

  void add_placed_maps(uint64_t place, const Material& material) {
    constexpr float kAsBaked[] = {0.0f, 0.0f, 1.0f, 1.0f, 0.0f};  // the transform that the layout has a place for
    const auto maps = maps_of(material);
    for (size_t i = 0; i < maps.size(); ++i) {
      if (!maps[i]->used() || maps[i]->uv_set == 0) continue;
      add(place + i);
      count(maps[i]->uv_set);
      add(kAsBaked);
    }
  }

  void add_more_uv(uint64_t place, uint64_t step, const Mesh& mesh) {
    for (const UvStreams& set : mesh.more_uv) {
      if (!set[0].empty()) add(place);
      if (!set[0].empty())
        for (const auto& stream : set) add(stream);
      place += step;
    }
  }

  void add_transparent(uint64_t place, const Material& material) {
    if (material.transparent) add(place);
  }

  void add(const Camera& camera) {
    add(camera.eye);
    add(camera.target);
    add(camera.up);
    count(camera.fov_x_rad.has_value());
    add(camera.fov_x_rad.value_or(camera.fov_y_rad));
    add(camera.near);
    add(camera.far);
    count(!camera.clip_from_world ? 0 : camera.matrix_has_gl_range ? 2 : 1);
    if (camera.clip_from_world) add(*camera.clip_from_world);
  }

  const Sha256& state() const { return sha_; }
  void go_on_from(const Sha256& state) { sha_ = state; }
  void add_text(const std::string& text) { sha_.update(text.data(), text.size()); }
  std::string hex() { return sha_.hex(); }

 private:
  Sha256 sha_;
};

/// Scenes of more texels than this, smaller levels left out, count them by digests.
constexpr uint64_t kManyTexels = uint64_t(1) << 20;

bool has_many_texels(const Scene& scene) {
  uint64_t texels = 0;
  for (const Texture& texture : scene.textures)
    texels += uint64_t(texture.levels[0].width) * uint64_t(texture.levels[0].height);
  return texels > kManyTexels;
}

std::vector<std::string> texture_digests(const Scene& scene) {
  std::vector<std::string> digests(scene.textures.size());
  parallel_for(int(digests.size()), 0, [&](int i) {
    SceneHasher hasher;
    hasher.add_stored(scene.textures[size_t(i)]);
    digests[size_t(i)] = hasher.hex();
  });
  return digests;
}

}  // namespace

SceneDigests digests_of(const Scene& scene) {
  const FpScope fp;
  SceneHasher hasher;
  hasher.count(scene.meshes.size());
  for (const Mesh& mesh : scene.meshes) hasher.add(mesh);
  return {hasher.state(), has_many_texels(scene) ? texture_digests(scene) : std::vector<std::string>()};
}

std::string scene_hash(const Scene& scene) {
  const FpScope fp;
  const SceneDigests* const known = scene.digests.get();
  SceneHasher hasher;
  if (known != nullptr) {
    hasher.go_on_from(known->meshes);
  } else {
    hasher.count(scene.meshes.size());
    for (const Mesh& mesh : scene.meshes) hasher.add(mesh);
  }
  hasher.count(scene.materials.size());
  for (const Material& material : scene.materials) hasher.add_fields(material, MaterialHash::first);
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
  // No count is as large.
  constexpr uint64_t kMaterials = uint64_t(1) << 62, kLights = uint64_t(1) << 63, kTransparent = kLights | kMaterials;
  for (size_t i = 0; i < scene.materials.size(); ++i)
    hasher.add_if_set(kMaterials + i, scene.materials[i], MaterialHash::gloss);
  for (size_t i = 0; i < scene.lights.size(); ++i) hasher.add_if_set(kLights + i, scene.lights[i], LightHash::second);
  for (size_t i = 0; i < scene.materials.size(); ++i) hasher.add_transparent(kTransparent + i, scene.materials[i]);
  constexpr uint64_t kNewer = kLights | uint64_t(1) << 61, kPlacedMaps = kMaterials | uint64_t(1) << 60,
                     kSecondUv = kTransparent | uint64_t(1) << 60, kNextUv = uint64_t(1) << 56;
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    hasher.add_newer(kNewer + i, scene.materials[i]);
    hasher.add_placed_maps(kPlacedMaps + 8 * i, scene.materials[i]);
  }
  constexpr uint64_t kMirrored = kLights | uint64_t(1) << 60;
  for (size_t i = 0; i < scene.instances.size(); ++i)
    if (scene.instances[i].mirrored) hasher.add(kMirrored + i);
  constexpr uint64_t kLaterMaterials = kTransparent | uint64_t(1) << 61;
  for (size_t i = 0; i < scene.materials.size(); ++i)
    hasher.add_if_set(kLaterMaterials + i, scene.materials[i], MaterialHash::later);
  constexpr uint64_t kLaterLights = kMirrored | uint64_t(1) << 61;
  for (size_t i = 0; i < scene.lights.size(); ++i)
    hasher.add_if_set(kLaterLights + i, scene.lights[i], LightHash::later);
  for (size_t i = 0; i < scene.meshes.size(); ++i) hasher.add_more_uv(kSecondUv + i, kNextUv, scene.meshes[i]);
  const bool unmapped = std::none_of(scene.materials.begin(), scene.materials.end(),
                                     [](const Material& m) { return m.textured() || m.masked(); });
  if (unmapped) return hasher.hex();
  hasher.add(uint64_t(3) << 61);  // no count, and none of the above
  hasher.count(scene.textures.size());
  if (has_many_texels(scene))
    for (const std::string& digest : known != nullptr ? known->textures : texture_digests(scene))
      hasher.add_text(digest);
  else
    for (const Texture& texture : scene.textures) hasher.add(texture);
  for (const Material& material : scene.materials) hasher.add_maps(material);
  return hasher.hex();
}

}  // namespace trueshade
