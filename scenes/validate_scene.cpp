#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "core/error.h"
#include "core/fp_env.h"
#include "scenes/json/json_value.h"
#include "scenes/light_fields.h"
#include "scenes/material_fields.h"
#include "scenes/scene.h"
#include "scenes/trig.h"

namespace trueshade {
namespace {

constexpr float kMostReach = 1e18f;  // squares of lengths stay finite in float32

/// One part of a scene being checked. Its name, such as `builtin:city: light 3`, is made only for an error: there may
/// be millions of parts.
struct Part {
  const std::string& spec;
  const char* kind;
  std::optional<size_t> index;
  [[noreturn]] void fail(const std::string& reason, const std::string& remedy) const {
    const std::string number = index ? " " + std::to_string(*index) : std::string();
    throw Error(ErrorKind::bad_input, spec + ": " + kind + number, reason, remedy);
  }
  void require(bool holds, const char* reason, const char* remedy) const {
    if (!holds) fail(reason, remedy);
  }
};

bool all_within(std::span<const float> values, float most) {
  return std::all_of(values.begin(), values.end(), [most](float v) { return std::fabs(v) <= most; });  // false for NaN
}

bool within(float v, float least, float most) { return v >= least && v <= most; }
bool within(const glm::vec3& v, float least, float most) {
  for (int k = 0; k < 3; ++k)
    if (!(v[k] >= least && v[k] <= most)) return false;
  return true;
}

void check_mesh(const Mesh& mesh, const Part& part) {
  const size_t count = mesh.vertex_count();
  const auto check = [&](std::span<const FloatStream> streams, bool optional, const char* name) {
    for (const FloatStream& stream : streams) {
      if (optional && streams[0].empty() && stream.empty()) continue;
      if (stream.size() != count) part.fail(std::string(name) + " streams differ in length", "one value a vertex");
      if (!all_within(stream, kMostReach))
        part.fail(std::string(name) + " has a value that is not finite or over 1e18", "finite numbers");
    }
  };
  check(mesh.position, false, "position");
  check(mesh.normal, false, "normal");
  check(mesh.uv, true, "uv");
  part.require(mesh.more_uv.size() < kMaxUvSets, "the mesh has too many sets of texture coordinates", "at most 6");
  for (const UvStreams& set : mesh.more_uv) check(set, true, "uv");
  check(mesh.color, true, "color");
  check(mesh.tangent, true, "tangent");
  for (const float side : mesh.tangent[3])
    part.require(side == 1.0f || side == -1.0f, "the w of a tangent is out of range", "1 or -1");
  part.require(mesh.indices.size() % 3 == 0, "the number of indices is no multiple of 3", "3 a triangle");
  for (const uint32_t index : mesh.indices)
    if (index >= count)
      part.fail("index " + std::to_string(index) + " is beyond the vertices", "below " + std::to_string(count));
}

/// Checks a texture; returns its largest R, G or B.
float check_texture(const Texture& texture, const Part& part) {
  part.require(!texture.levels.empty() && texture.levels.size() <= size_t(kMaxTextureLevels),
               "the texture has no level, or too many", "1 to 15 levels");
  const int width = texture.levels[0].width, height = texture.levels[0].height;
  part.require(width >= 1 && height >= 1 && width <= kMaxTextureSide && height <= kMaxTextureSide &&
                   uint64_t(width) * uint64_t(height) <= kMaxTextureTexels,
               "a side of the texture is 0 or over 16384 texels", "1 to 16384 texels a side");
  float largest = 1.0f;
  for (size_t k = 0; k < texture.levels.size(); ++k) {
    const TextureLevel& level = texture.levels[k];
    part.require(level.width == std::max(1, width >> k) && level.height == std::max(1, height >> k),
                 "a level has the wrong size", "half the sides of the level before it, rounded down, at least 1");
    part.require(
        level.bytes.size() == size_t(level.width) * size_t(level.height) * size_t(bytes_per_texel(texture.format)),
        "a level has too many or too few bytes", "width * height texels");
    if (bytes_per_texel(texture.format) == 4) continue;  // every code is a number in [0, 1]
    for (int y = 0; y < level.height; ++y)
      for (int x = 0; x < level.width; ++x) {
        const std::array<float, 4> texel = texel_value(texture, k, x, y);
        for (size_t c = 0; c < 4; ++c) {
          part.require(texel[c] >= 0.0f && texel[c] <= (c == 3 ? 1.0f : kMostReach), "a texel is out of range",
                       "RGB in [0, 1e18], alpha in [0, 1]");
          if (c < 3) largest = std::max(largest, texel[c]);
        }
      }
  }
  return largest;
}

bool is_color(const glm::vec4& color) {
  return within(glm::vec3(color), 0.0f, kMostReach) && color.w >= 0.0f && color.w <= 1.0f;
}

void check_map(const TextureSlot& slot, std::span<const float> largest, float factor, const Part& part) {
  if (!slot.used()) return;
  const Sampler& s = slot.sampler;
  part.require(size_t(slot.texture) < largest.size(), "a texture index is beyond the textures", "an existing texture");
  part.require(s.lod_bias >= -16.0f && s.lod_bias <= 16.0f && s.lod_min >= -1000.0f && s.lod_max <= 1000.0f &&
                   s.lod_min <= s.lod_max,
               "a level of detail is out of range", "a bias in [-16, 16], -1000 <= lod_min <= lod_max <= 1000");
  part.require(is_color(s.border), "the border colour is out of range", "RGB in [0, 1e18], alpha in [0, 1]");
  part.require(slot.uv_set < kMaxUvSets, "a set of texture coordinates is out of range", "0 to 5");
  const float most = std::max({largest[size_t(slot.texture)], s.border.x, s.border.y, s.border.z});
  part.require(double(factor) * double(most) <= double(kMostReach), "colour times texture is over 1e18",
               "a smaller colour, or smaller texels");
}

/// A map whose channels are shares of one.
void check_share_map(const TextureSlot& slot, std::span<const float> largest, const Part& part) {
  check_map(slot, largest, 1.0f, part);
  if (!slot.used()) return;
  const glm::vec4& border = slot.sampler.border;
  part.require(std::max({largest[size_t(slot.texture)], border.x, border.y, border.z}) <= 1.0f,
               "a texel of a metallic-roughness or occlusion map is over 1", "texels in [0, 1]");
}

std::string bounds_of(double least, double most) {
  return "[" + json::number_text(least) + ", " + json::number_text(most) + "]";
}

/// A number, or each of several, against the bounds of its row.
template <class Row, typename T>
void check_field(const Row& row, const T& value, const Part& part) {
  if (within(value, float(row.least), float(row.most))) return;
  part.fail("'" + std::string(row.member) + "' is out of range",
            (std::is_same_v<T, float> ? "in " : "each in ") + bounds_of(row.least, row.most));
}
void check_field(const MaterialField& row, const glm::vec4& value, const Part& part) {
  if (!is_color(value))
    part.fail("'" + std::string(row.member) + "' is out of range",
              "RGB in " + bounds_of(row.least, row.most) + ", alpha in [0, 1]");
}
void check_field(const MaterialField&, bool, const Part&) {}
void check_field(const MaterialField& row, float value, const Part& part) {
  const bool is_right =
      within(value, float(row.least), float(row.most)) && (!row.integer || value == std::nearbyint(value));
  if (!is_right)
    part.fail("'" + std::string(row.member) + "' is out of range",
              (row.integer ? "an integer in " : "in ") + bounds_of(row.least, row.most));
}

void check_material(const Material& material, std::span<const float> largest, const Part& part) {
  visit_fields(material, [&](const MaterialField& row, auto& value) { check_field(row, value, part); });
  const glm::vec4& base = material.base_color;
  const glm::vec3& specular = material.specular_color;
  check_map(material.color_map, largest, std::max({base.x, base.y, base.z}), part);
  check_map(material.specular_map, largest, std::max({specular.x, specular.y, specular.z}), part);
  check_map(material.normal_map, largest, 1.0f, part);
  check_share_map(material.metallic_roughness_map, largest, part);
  const glm::vec3& emission = material.emission;
  check_map(material.emission_map, largest, std::max({emission.x, emission.y, emission.z}), part);
  check_share_map(material.occlusion_map, largest, part);
}

bool is_unit(const glm::vec3& v) {
  const double length2 = (double(v.x) * v.x + double(v.y) * v.y) + double(v.z) * v.z;
  return length2 > 0.9999 && length2 < 1.0001;
}

/// Whether unit vectors are at right angles, as far as floats of them can be.
bool is_right_angle(double cosine) { return std::fabs(cosine) <= 1e-4; }

void check_area(const Light& light, const Part& part) {
  const glm::dvec3 right(light.right), up(light.up);
  if (light.type == LightType::sphere || light.type == LightType::tube) {
    part.require(light.type == LightType::sphere ? light.right.x > 0.0f : light.up.x > 0.0f,
                 "the radius is not above 0", "a radius above 0");
    part.require(right != glm::dvec3(0.0), "right has no length", "half of the tube's axis");
    return;
  }
  const double sides = std::sqrt(dot(right, right) * dot(up, up));
  part.require(sides > 0.0 && std::isfinite(sides), "right or up has no length", "two half extents");
  part.require(is_right_angle(dot(right, up) / sides), "right and up are not at right angles",
               "up at right angles to right");
  part.require(light.type != LightType::disk || std::fabs(dot(right, right) / dot(up, up) - 1.0) <= 1e-4,
               "right and up of the disk are not of one length", "two radii");
  const glm::dvec3 facing = cross(up, right) / sides;
  part.require(dot(facing, glm::dvec3(light.direction)) > 0.999, "the direction is not that of cross(up, right)",
               "the unit vector of cross(up, right)");
}

/// Whether lights of a type have the field's value in use: an area light all of them, as its extents are in two.
bool is_read(const LightField& row, LightType type) { return contains(row.types, type) || has_area(type); }

void check_light(const Light& light, const Part& part) {
  visit_members(light, [&](const LightField& row, auto& value) {
    const bool is_plain = row.kind == LightValueKind::number || row.kind == LightValueKind::three_numbers;
    if (is_plain && row.property != LightProperty::range && is_read(row, light.type)) check_field(row, value, part);
  });
  if (row_of(light.type).is_aimed)
    part.require(is_unit(light.direction), "the direction is not of unit length", "length 1");
  if (!is_placed(light.type)) return;
  part.require(light.range > 0.0f, "the range is not above 0", "above 0, or infinite");
  if (has_area(light.type)) check_area(light, part);
  if (!is_spot(light.type)) return;
  part.require(light.cone_rad >= 0.0f && light.penumbra_rad >= 0.0f && light.cone_rad + light.penumbra_rad <= 3.1416f,
               "cone and penumbra are out of range", "each at least 0, their sum at most pi");
}

/// `part`: a Part, or what fails and requires as one does.
template <class Named>
void check_camera(const Camera& camera, const Named& part) {
  part.require(within(camera.eye, -kMostReach, kMostReach), "the eye is not finite or over 1e18", "finite numbers");
  if (camera.clip_from_world) {
    part.require(all_within(*camera.clip_from_world, 3e38f), "clip_from_world has a number that is not finite",
                 "16 finite numbers");
    return;
  }
  const float fov = camera.fov_x_rad.value_or(camera.fov_y_rad);
  part.require(fov > 0.0f && fov < 3.1415926f, "the field of view is out of range", "in (0, pi)");
  part.require(camera.near > 0.0f && camera.far > camera.near && camera.far <= kMostReach,
               "near and far are out of order", "0 < near < far <= 1e18");
  part.require(within(camera.target, -kMostReach, kMostReach) && within(camera.up, -kMostReach, kMostReach),
               "target or up is not finite or over 1e18", "finite numbers");
  const glm::dvec3 f(camera.target - camera.eye), up(camera.up);
  const glm::dvec3 side(f.y * up.z - f.z * up.y, f.z * up.x - f.x * up.z, f.x * up.y - f.y * up.x);
  part.require(side.x != 0.0 || side.y != 0.0 || side.z != 0.0, "eye, target and up leave no direction to the side",
               "a target away from the eye and an up that is not along the view");
}

std::vector<glm::dvec3> mesh_reaches(const Scene& scene) {
  std::vector<glm::dvec3> reaches;
  for (const Mesh& mesh : scene.meshes) reaches.push_back(reach_of(mesh));
  return reaches;
}

/// World positions stay within 1e18, so that no squared distance overflows: a bound over the mesh's box, which may
/// refuse a little less than the limit.
void check_world_reach(const Instance& instance, const glm::dvec3& reach, const Part& part) {
  const glm::mat4x3& m = instance.world_from_object;
  for (int row = 0; row < 3; ++row) {
    double far = std::abs(double(m[3][row]));
    for (int c = 0; c < 3; ++c) far += std::abs(double(m[c][row])) * reach[c];
    part.require(far <= double(kMostReach), "the transform takes vertices beyond 1e18", "a smaller scale");
  }
}

void check_transform(const Instance& instance, const Part& part) {
  for (int column = 0; column < 4; ++column)
    part.require(within(instance.world_from_object[column], -kMostReach, kMostReach),
                 "the transform is not finite or over 1e18", "finite numbers");
}

void check_instance(const Scene& scene, const Instance& instance, const Part& part) {
  part.require(instance.mesh < scene.meshes.size(), "the mesh index is beyond the meshes", "an existing mesh");
  part.require(instance.material < scene.materials.size(), "the material index is beyond the materials",
               "an existing material");
  check_transform(instance, part);
}

void check_limit(const std::string& spec, const char* what, uint64_t count, uint64_t limit, const char* option) {
  if (count > limit)
    throw Error(ErrorKind::limit, spec, std::to_string(count) + " " + what + " are over the limit",
                within_limit(limit, "", option));
}

}  // namespace

void validate(const Scene& scene, const SceneLimits& limits) {
  const FpScope fp;
  const std::string& spec = scene.spec;
  const auto part = [&](const char* kind, size_t index) { return Part{spec, kind, index}; };
  check_limit(spec, "lights", scene.lights.size(), limits.lights, "--max-lights");
  check_limit(spec, "instances", scene.instances.size(), limits.instances, "--max-instances");
  for (size_t i = 0; i < scene.meshes.size(); ++i) check_mesh(scene.meshes[i], part("mesh", i));
  std::vector<float> largest_texels;
  for (size_t i = 0; i < scene.textures.size(); ++i)
    largest_texels.push_back(check_texture(scene.textures[i], part("texture", i)));
  for (size_t i = 0; i < scene.materials.size(); ++i)
    check_material(scene.materials[i], largest_texels, part("material", i));
  const std::vector<glm::dvec3> reaches = mesh_reaches(scene);
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    check_instance(scene, scene.instances[i], part("instance", i));
    check_world_reach(scene.instances[i], reaches[scene.instances[i].mesh], part("instance", i));
  }
  for (size_t i = 0; i < scene.lights.size(); ++i) check_light(scene.lights[i], part("light", i));
  check_camera(scene.camera, Part{spec, "camera", {}});
  Part{spec, "clear", {}}.require(is_color(scene.clear), "the colour is out of range",
                                  "RGB in [0, 1e18], alpha in [0, 1]");
}

void validate_camera(const Camera& camera, const std::string& where, ErrorKind kind) {
  const FpScope fp;
  struct Named {
    const std::string& where;
    ErrorKind kind;
    void require(bool holds, const char* reason, const char* remedy) const {
      if (!holds) throw Error(kind, where, reason, remedy);
    }
  };
  check_camera(camera, Named{where, kind});
}

void validate_moving(const Scene& scene, double time) {
  const FpScope fp;
  const Timeline& timeline = scene.timeline;
  const std::string spec = scene.spec + ": time " + json::number_text(time);
  const auto part = [&](const char* kind, size_t index) { return Part{spec, kind, index}; };
  for (const MovingInstance& moving : timeline.instances) {
    check_transform(scene.instances[moving.instance], part("instance", moving.instance));
    check_world_reach(scene.instances[moving.instance], moving.reach, part("instance", moving.instance));
  }
  std::vector<std::optional<glm::dvec3>> posed_reaches(scene.meshes.size());  // a mesh may have millions of instances
  for (const PosedMesh& posed : timeline.posed) posed_reaches[posed.mesh] = reach_of(scene.meshes[posed.mesh]);
  for (const NodeInstance& hung : timeline.node_instances) {
    const Instance& instance = scene.instances[hung.instance];
    check_transform(instance, part("instance", hung.instance));
    check_world_reach(instance, posed_reaches[instance.mesh].value_or(hung.reach), part("instance", hung.instance));
  }
  for (const NodeLight& hung : timeline.node_lights) check_light(scene.lights[hung.light], part("light", hung.light));
  for (const MaterialMotion& motion : timeline.materials)
    check_material(scene.materials[motion.material], {}, part("material", motion.material));
  for (const LightMotion& motion : timeline.lights)
    check_light(scene.lights[motion.light], part("light", motion.light));
  for (const Orbit& orbit : timeline.orbits) check_light(scene.lights[orbit.light], part("light", orbit.light));
  if (!timeline.camera.empty() || timeline.node_camera) check_camera(scene.camera, Part{spec, "camera", {}});
}

}  // namespace trueshade
