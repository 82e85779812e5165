#include "scenes/files/object_json.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/memory_cap.h"
#include "scenes/builtin/builtin_scenes.h"
#include "scenes/builtin/pcg32.h"
#include "scenes/files/gltf/gltf_geometry.h"
#include "scenes/files/gltf_scene.h"
#include "scenes/files/load_geometry.h"
#include "scenes/files/obj/obj_scene.h"
#include "scenes/shapes.h"
#include "scenes/trig.h"

namespace trueshade {
namespace {

constexpr glm::vec4 kGrey{0.8f, 0.8f, 0.8f, 1.0f};

constexpr std::string_view kObjectKeys[] = {"geometry", "mesh",          "normals",      "color", "material",
                                            "position", "rotation",      "rotation_deg", "scale", "grid",
                                            "steps",    "interpolation", "repeat"};
constexpr std::string_view kStepKeys[] = {"time", "color", "position", "rotation", "rotation_deg", "scale"};
constexpr std::string_view kGridKeys[] = {"count", "spacing", "jitter", "turn_deg", "shrink", "colors", "seed"};

enum : size_t { kObject, kStep, kGrid };
constexpr json::ObjectKeys kObjectJsonKeys[] = {
    {"object", kObjectKeys},   {"object_step", kStepKeys}, {"grid", kGridKeys},        {"texture", kTextureKeys},
    {"pattern", kPatternKeys}, {"map", kMapKeys},          {"material", kMaterialKeys}};

std::optional<glm::dvec4> read_color(const json::Node& object) {
  const auto node = object.find("color");
  if (!node) return std::nullopt;
  return glm::dvec4(node->color());
}

/// One number for all axes, or three.
glm::dvec3 number_or_three(const json::Node& node, double least, double most) {
  return node.is_array() ? glm::dvec3(node.vec3(least, most)) : glm::dvec3(double(node.real(least, most)));
}

std::optional<glm::dvec4> read_scale(const json::Node& object) {
  const auto node = object.find("scale");
  if (!node) return std::nullopt;
  return glm::dvec4(number_or_three(*node, -json::kLargest, json::kLargest), 0.0);
}

/// Unit quaternion from `rotation` or `rotation_deg`.
std::optional<glm::dvec4> read_rotation(const json::Node& object) {
  const auto quaternion = object.find("rotation"), degrees = object.find("rotation_deg");
  if (quaternion && degrees) object.fail("'rotation' and 'rotation_deg' exclude each other", "one of them");
  if (quaternion) {
    quaternion->array(4, 4);
    glm::dvec4 q(0.0);
    for (int i = 0; i < 4; ++i) q[i] = quaternion->element(size_t(i)).number(-2.0, 2.0);
    const double length = std::sqrt(((q.x * q.x + q.y * q.y) + q.z * q.z) + q.w * q.w);
    if (!(std::fabs(length - 1.0) <= 0.00769))
      quaternion->fail("the quaternion is not of unit length", "x, y, z, w of length 1");
    return unit(q);
  }
  if (!degrees) return std::nullopt;
  degrees->array(3, 3);
  glm::dvec4 q(0.0, 0.0, 0.0, 1.0);
  for (int axis = 0; axis < 3; ++axis)
    q = turned(q, turn_about(axis, degrees->element(size_t(axis)).number(-36000.0, 36000.0) * (kPi / 180.0)));
  return q;
}

ObjectMotion read_motion(const StepReader& steps) {
  ObjectMotion motion;
  Said position = steps.said("position", numbers("position", 3, -json::kLargest, json::kLargest));
  Said rotation = steps.said("rotation", read_rotation), scale = steps.said("scale", read_scale);
  if (position.value) motion.rest.position = glm::dvec3(*position.value);
  if (rotation.value) motion.rest.rotation = *rotation.value;
  if (scale.value) motion.rest.scale = glm::dvec3(*scale.value);
  motion.position = std::move(position.track);
  motion.rotation = std::move(rotation.track);
  motion.scale = std::move(scale.track);
  return motion;
}

/// Copies side by side along x, y and z, around the object's own place.
struct Grid {
  uint32_t count[3];
  glm::dvec3 spacing{1.0};
  double jitter = 0.0, turn_rad = 0.0, shrink = 0.0;
  std::vector<glm::vec4> colors;
  uint64_t seed = 0;
};

Grid read_grid(const json::Node& node) {
  node.check_keys(kObjectJsonKeys[kGrid]);
  Grid grid{};
  const json::Node count = node.member("count");
  count.array(3, 3);
  for (size_t k = 0; k < 3; ++k) grid.count[k] = uint32_t(count.element(k).integer(1, 1 << 24));
  grid.spacing = number_or_three(node.member("spacing"), -json::kLargest, json::kLargest);
  if (const auto jitter = node.find("jitter")) grid.jitter = jitter->number(0.0, 1.0);
  if (const auto turn = node.find("turn_deg")) grid.turn_rad = turn->number(0.0, 360.0) * (kPi / 180.0);
  if (const auto shrink = node.find("shrink")) grid.shrink = shrink->number(0.0, 1.0);
  if (const auto seed = node.find("seed")) grid.seed = uint64_t(seed->integer(0, 9007199254740991));
  if (const auto colors = node.find("colors"))
    for (size_t i = 0; i < colors->array(1, 64).size(); ++i) grid.colors.push_back(colors->element(i).color());
  return grid;
}

uint64_t copies_of(const Grid& grid) {
  const uint64_t layer = uint64_t(grid.count[0]) * grid.count[1];  // at most 2^48
  return layer > UINT64_MAX / grid.count[2] ? UINT64_MAX : layer * grid.count[2];
}

/// Place of one copy; draws five numbers.
Placement copy_place(const Grid& grid, const uint32_t (&cell)[3], Pcg32& random) {
  Placement copy;
  for (int k = 0; k < 3; ++k) {
    const double steps = double(cell[k]) - 0.5 * (double(grid.count[k]) - 1.0);
    copy.position[k] = grid.spacing[k] * (steps + grid.jitter * (random.real() - 0.5));
  }
  copy.rotation = turn_about(1, grid.turn_rad * random.real());
  copy.scale = glm::dvec3(1.0 - grid.shrink * random.real());
  return copy;
}

}  // namespace

std::span<const json::ObjectKeys> object_json_keys() { return kObjectJsonKeys; }

void ObjectReader::read_materials(const json::Node& list) {
  const size_t count = list.array(0, SIZE_MAX).size();
  for (size_t i = 0; i < count; ++i) {
    const json::Node node = list.element(i);
    UvSources uv;
    Material material = surfaces_.read_material(node, uv);
    if (!named_.emplace(material.name, uint32_t(scene_.materials.size())).second)
      node.fail("a material of this name exists", "another name");
    uv_sources_.resize(scene_.materials.size());
    uv_sources_.push_back(uv);
    scene_.materials.push_back(std::move(material));
  }
  surfaces_.complete_mip_chains(list);
}

void ObjectReader::read_objects(const json::Node& list) {
  const size_t count = list.array(0, SIZE_MAX).size();
  check_grids(list);
  for (size_t i = 0; i < count; ++i) read_object(list.element(i));
}

/// Refuses grids that are over the limits together before the first copy is made. An object draws at least one mesh.
void ObjectReader::check_grids(const json::Node& list) const {
  const size_t count = list.array(0, SIZE_MAX).size();
  uint64_t instances = 0, bytes = 0;
  for (size_t i = 0; i < count; ++i) {
    const json::Node object = list.element(i);
    const auto grid = object.find("grid");
    const uint64_t copies = grid ? copies_of(read_grid(*grid)) : 1;
    if (copies > limits_.instances - std::min(limits_.instances, instances))
      (grid ? *grid : object)
          .fail("the objects are over the limit", within_limit(limits_.instances, "", "--max-instances"),
                ErrorKind::limit);
    instances += copies;
    bytes += copies * (kDrawnInstanceBytes + (object.find("steps") ? sizeof(MovingInstance) : 0));
    if (grid) require_memory(bytes, path_ + ": " + grid->pointer(), "drawing the objects");
  }
}

void ObjectReader::finish() {
  surfaces_.make_patterns();
  surfaces_.lose_pictures();
  uv_sources_.resize(scene_.materials.size());
  uint64_t bytes = 0;
  bake_uv(scene_, uv_sources_, [&](uint64_t more) {
    bytes += more;
    if (bytes > limits_.geometry_bytes)
      throw Error(ErrorKind::limit, path_ + ": /objects",
                  "the meshes with texture coordinates of their own for each material are over the limit",
                  "fewer materials that transform texture coordinates");
  });
}

void ObjectReader::read_object(const json::Node& node) {
  node.check_keys(kObjectJsonKeys[kObject]);
  const StepReader steps(node, kObjectJsonKeys[kStep]);
  std::vector<Instance> instances;
  bool has_materials = true;
  for (const Part& part : parts(node)) {
    instances.push_back({part.mesh, part.material.value_or(0)});
    has_materials = has_materials && part.material.has_value();
  }
  const ObjectMotion placed = read_motion(steps);
  std::optional<uint32_t> motion;
  if (placed.position || placed.rotation || placed.scale) {
    motion = uint32_t(scene_.timeline.motions.size());
    scene_.timeline.motions.push_back(placed);
  }
  const auto grid = node.find("grid");
  const bool says = node.find("material") || steps.said("color", read_color).at_all();
  if (grid && grid->find("colors")) {
    if (says) grid->fail("the object has a colour, and the grid has too", "one of them");
  } else if (says || !has_materials) {
    const uint32_t index = material(node, steps);
    for (Instance& instance : instances) instance.material = index;
  }
  if (grid) return add_grid(*grid, std::move(instances), motion, placed);
  for (const Instance& instance : instances) add(instance, {}, motion, placed);
}

/// Adds an instance at its place at time 0.
void ObjectReader::add(const Instance& instance, const Placement& copy, std::optional<uint32_t> motion,
                       const ObjectMotion& placed) {
  const uint32_t index = uint32_t(scene_.instances.size());
  scene_.instances.push_back(instance);
  if (motion)
    scene_.timeline.instances.push_back({index, *motion, copy, reach(instance.mesh)});
  else
    scene_.instances.back().world_from_object = world_from_object(copied(placed.rest, copy));
}

void ObjectReader::add_grid(const json::Node& node, std::vector<Instance> instances, std::optional<uint32_t> motion,
                            const ObjectMotion& placed) {
  const Grid grid = read_grid(node);
  const uint64_t copies = copies_of(grid), here = scene_.instances.size(),
                 room = limits_.instances - std::min(limits_.instances, here);
  if (copies > room / std::max<size_t>(instances.size(), 1))
    node.fail("the objects are over the limit", within_limit(limits_.instances, "", "--max-instances"),
              ErrorKind::limit);
  const uint64_t more = copies * instances.size();
  require_memory(more * (kDrawnInstanceBytes + (motion ? sizeof(MovingInstance) : 0)), path_ + ": " + node.pointer(),
                 "drawing the objects");
  scene_.instances.reserve(size_t(here + more));
  if (motion) scene_.timeline.instances.reserve(scene_.timeline.instances.size() + size_t(more));
  Pcg32 random(grid.seed, 10);
  uint32_t cell[3];
  for (cell[2] = 0; cell[2] < grid.count[2]; ++cell[2])
    for (cell[1] = 0; cell[1] < grid.count[1]; ++cell[1])
      for (cell[0] = 0; cell[0] < grid.count[0]; ++cell[0]) {
        const Placement copy = copy_place(grid, cell, random);
        if (!grid.colors.empty()) {
          const uint32_t index = material_of(grid.colors[random.below(uint32_t(grid.colors.size()))]);
          for (Instance& instance : instances) instance.material = index;
        }
        for (const Instance& instance : instances) add(instance, copy, motion, placed);
      }
}

const std::vector<ObjectReader::Part>& ObjectReader::parts(const json::Node& node) {
  const auto geometry = node.find("geometry"), generated = node.find("mesh"), normals = node.find("normals");
  if (geometry.has_value() == generated.has_value())
    node.fail("an object has 'geometry' or 'mesh', one of them", "name a file or a mesh of ours");
  if (generated) {
    if (normals) normals->fail("a mesh of ours has normals", "remove it");
    return generated_mesh(*generated);
  }
  constexpr std::string_view kNormals[] = {"flat", "smooth"};
  const MissingNormals missing = normals ? MissingNormals(normals->choice(kNormals)) : MissingNormals::flat;
  const std::string where = path_ + ": " + geometry->pointer();
  const std::string file = path_from_uri(geometry->string(), where, limits_.named_paths);
  const bool is_ply = is_geometry_name(file);
  if (!is_ply && !is_gltf_name(file) && !is_obj_name(file))
    geometry->fail("the ending names no geometry format", ".gltf, .glb, .obj, .obj.gz, .ply or .ply.gz");
  if (normals && is_gltf_name(file)) normals->fail("missing normals of a glTF file are flat", "remove it");
  const auto [found, is_new] = files_.try_emplace(std::tuple(file, missing));
  if (is_new) found->second = is_ply ? parts_of_ply(file, missing, where) : parts_of_models(file, missing, where);
  return found->second;
}

std::vector<ObjectReader::Part> ObjectReader::parts_of_ply(const std::string& file, MissingNormals missing,
                                                           const std::string& where) {
  const Bytes bytes = folder_.read(file, limits_.file_bytes, where);
  Faults faults(limits_.leniency);
  scene_.meshes.push_back(mesh_from_file(bytes, file, limits_, missing, faults));
  faults.tell(scene_);
  return {{uint32_t(scene_.meshes.size() - 1), std::nullopt}};
}

/// What a glTF or OBJ file draws at its time 0, a mesh a material. Its materials and textures are added behind those
/// that there are.
std::vector<ObjectReader::Part> ObjectReader::parts_of_models(const std::string& file, MissingNormals missing,
                                                              const std::string& where) {
  const Bytes bytes = folder_.read(file, limits_.file_bytes, where);
  const std::string path = path_below(path_.substr(0, path_.rfind('/') + 1), file);  // npos + 1 is 0
  SceneLimits left = limits_;
  left.texture_bytes -= std::min(left.texture_bytes, surfaces_.bytes());
  Scene model = is_gltf_name(file) ? scene_from_gltf(bytes, path, left, decode_, {}, GltfTangents::left_out)
                                   : scene_from_obj(bytes, path, left, decode_, missing);
  tell_passed_over(model.passed_over, scene_);
  if (is_gltf_name(file) && std::any_of(model.materials.begin(), model.materials.end(),
                                        [](const Material& material) { return material.normal_map.used(); }))
    scene_.notes.push_back("Normal maps of " + file +
                           " follow the texture coordinates, because a scene file draws it without its tangents; "
                           "drawn by itself, it has them");
  GltfGeometry geometry = geometry_of(std::move(model));
  const uint32_t first_material = uint32_t(scene_.materials.size());
  const int32_t first_texture = int32_t(scene_.textures.size());
  for (Material& material : geometry.materials) {
    UvSources uv;
    const auto maps = maps_of(material);
    for (size_t i = 0; i < maps.size(); ++i) {
      if (maps[i]->used()) maps[i]->texture += first_texture;
      uv[i].set = maps[i]->uv_set;
    }
    uv_sources_.resize(scene_.materials.size());
    uv_sources_.push_back(uv);
    scene_.materials.push_back(std::move(material));
  }
  for (Texture& texture : geometry.textures) {
    for (const TextureLevel& level : texture.levels) surfaces_.count(level.bytes.size());
    scene_.textures.push_back(std::move(texture));
  }
  std::vector<Part> parts;
  for (GltfGeometry::Part& part : geometry.parts) {
    parts.push_back({uint32_t(scene_.meshes.size()), first_material + part.material});
    part.mesh.name = file;
    scene_.meshes.push_back(std::move(part.mesh));
  }
  return parts;
}

const std::vector<ObjectReader::Part>& ObjectReader::generated_mesh(const json::Node& node) {
  constexpr std::string_view kNames[] = {"cube", "plane", "sphere", "knot", "rabbit"};
  const size_t which = node.choice(kNames);
  const auto [found, is_new] = generated_.try_emplace(which);
  if (!is_new) return found->second;
  found->second.push_back({uint32_t(scene_.meshes.size()), std::nullopt});
  scene_.meshes.push_back(which == 0   ? cube_mesh()
                          : which == 1 ? plane_mesh(14)
                          : which == 2 ? sphere_mesh(28)
                          : which == 3 ? builtin::knot_mesh()
                                       : builtin::rabbit_mesh());
  if (which < 2) add_face_uv(scene_.meshes.back());
  return found->second;
}

/// A colour that moves has a material of its own.
uint32_t ObjectReader::material(const json::Node& node, const StepReader& steps) {
  Said color = steps.said("color", read_color);
  const auto name = node.find("material");
  if (color.at_all() && name) node.fail("'color' and 'material' exclude each other", "one of them");
  if (name) {
    const auto found = named_.find(name->string());
    if (found == named_.end()) name->fail("no material has this name", "a name from /materials");
    return found->second;
  }
  if (!color.track) return material_of(color.value ? glm::vec4(*color.value) : kGrey);
  const uint32_t index = uint32_t(scene_.materials.size());
  scene_.materials.push_back({"", kGrey});
  scene_.timeline.materials.push_back({index, std::move(*color.track)});
  return index;
}

uint32_t ObjectReader::material_of(const glm::vec4& color) {
  const auto [found, is_new] =
      colored_.emplace(std::tuple(color.x, color.y, color.z, color.w), uint32_t(scene_.materials.size()));
  if (is_new) scene_.materials.push_back({"", color});
  return found->second;
}

const glm::dvec3& ObjectReader::reach(uint32_t mesh) {
  const auto [found, is_new] = reaches_.emplace(mesh, glm::dvec3(0.0));
  if (is_new) found->second = reach_of(scene_.meshes[mesh]);
  return found->second;
}

}  // namespace trueshade
