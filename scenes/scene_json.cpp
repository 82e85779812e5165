#include "scenes/scene_json.h"

#include <array>
#include <glm/mat3x3.hpp>
#include <map>
#include <tuple>

#include "core/error.h"
#include "scenes/builtin_scenes.h"
#include "scenes/load_geometry.h"
#include "scenes/material_json.h"
#include "scenes/pipeline_json.h"
#include "scenes/presets.h"
#include "scenes/scene_defaults.h"
#include "scenes/scene_files.h"
#include "scenes/shapes.h"
#include "scenes/trig.h"

namespace trueshade {
namespace {

constexpr double kLargest = 1e18;
constexpr double kRadPerDeg = kPi / 180.0;
constexpr double kSmallest = 1e-30;  // of lengths that must be above 0

constexpr std::string_view kRootKeys[] = {"version",   "camera",  "clear",  "textures",
                                          "materials", "objects", "lights", "pipeline"};
constexpr std::string_view kCameraKeys[] = {"eye",      "target", "up",  "fov_deg",
                                            "fov_axis", "near",   "far", "clip_from_world"};
constexpr std::string_view kMatrixCameraKeys[] = {"eye", "clip_from_world"};
constexpr std::string_view kObjectKeys[] = {"geometry", "mesh",     "normals",      "color", "material",
                                            "position", "rotation", "rotation_deg", "scale"};
constexpr std::string_view kAmbientKeys[] = {"type", "color", "intensity"};
constexpr std::string_view kDirectionalKeys[] = {"type", "direction", "color", "intensity", "ambient"};
constexpr std::string_view kPointKeys[] = {"type", "position", "color", "intensity", "range", "attenuation", "ambient"};
constexpr std::string_view kSpotKeys[] = {"type",        "position", "direction",    "color",   "intensity",    "range",
                                          "attenuation", "cone_deg", "penumbra_deg", "ambient", "spot_exponent"};
constexpr std::string_view kRingKeys[] = {"type",  "count", "center",    "radius", "height",     "colors",
                                          "noise", "seed",  "intensity", "range",  "attenuation"};

enum Object : size_t {
  kRoot,
  kCamera,
  kTexture,
  kPattern,
  kMap,
  kMaterial,
  kObject,
  kAmbient,
  kDirectional,
  kPoint,
  kSpot,
  kRing
};
constexpr std::array<json::ObjectKeys, 12> kObjects{{{"", kRootKeys},
                                                     {"camera", kCameraKeys},
                                                     {"texture", kTextureKeys},
                                                     {"pattern", kPatternKeys},
                                                     {"map", kMapKeys},
                                                     {"material", kMaterialKeys},
                                                     {"object", kObjectKeys},
                                                     {"ambient", kAmbientKeys},
                                                     {"directional", kDirectionalKeys},
                                                     {"point", kPointKeys},
                                                     {"spot", kSpotKeys},
                                                     {"ring", kRingKeys}}};

using Key = std::string_view;

glm::vec3 vec3_or(const json::Node& node, Key key, const glm::vec3& absent) {
  const auto found = node.find(key);
  return found ? found->vec3(-kLargest, kLargest) : absent;
}

float real_or(const json::Node& node, Key key, float absent, double least, double most) {
  const auto found = node.find(key);
  return found ? found->real(least, most) : absent;
}

// --- Camera --------------------------------------------------------------------------------------------------------

Camera read_camera(const json::Node& node) {
  Camera camera;
  node.check_keys(kObjects[kCamera]);
  if (const auto matrix = node.find("clip_from_world")) {
    node.check_keys({"camera", kMatrixCameraKeys});
    matrix->array(16, 16);
    camera.clip_from_world.emplace();
    for (size_t i = 0; i < 16; ++i) (*camera.clip_from_world)[i] = matrix->element(i).real(-kLargest, kLargest);
    camera.eye = node.member("eye").vec3(-kLargest, kLargest);
    return camera;
  }
  camera.eye = node.member("eye").vec3(-kLargest, kLargest);
  camera.target = vec3_or(node, "target", camera.target);
  camera.up = vec3_or(node, "up", camera.up);
  const auto fov = node.find("fov_deg");
  const double fov_rad = (fov ? fov->number(0.001, 179.99) : 45.0) * kRadPerDeg;
  camera.fov_y_rad = float(fov_rad);
  constexpr std::string_view kAxes[] = {"y", "x"};
  if (const auto axis = node.find("fov_axis"); axis && axis->choice(kAxes) == 1) camera.fov_x_rad = float(fov_rad);
  camera.near = real_or(node, "near", camera.near, kSmallest, kLargest);
  camera.far = real_or(node, "far", camera.far, kSmallest, kLargest);
  if (!(camera.near < camera.far)) node.fail("near is not below far", "0 < near < far");
  return camera;
}

// --- Objects -------------------------------------------------------------------------------------------------------

/// Columns of the rotation of a unit quaternion x, y, z, w.
glm::dmat3 rotation_of(double x, double y, double z, double w) {
  glm::dmat3 m(1.0);
  m[0] = {1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + z * w), 2.0 * (x * z - y * w)};
  m[1] = {2.0 * (x * y - z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + x * w)};
  m[2] = {2.0 * (x * z + y * w), 2.0 * (y * z - x * w), 1.0 - 2.0 * (x * x + y * y)};
  return m;
}

glm::dmat3 read_rotation(const json::Node& object) {
  const auto quaternion = object.find("rotation"), degrees = object.find("rotation_deg");
  if (quaternion && degrees) object.fail("'rotation' and 'rotation_deg' exclude each other", "one of them");
  if (quaternion) {
    quaternion->array(4, 4);
    double q[4];
    for (size_t i = 0; i < 4; ++i) q[i] = quaternion->element(i).number(-2.0, 2.0);
    const double length = std::sqrt(((q[0] * q[0] + q[1] * q[1]) + q[2] * q[2]) + q[3] * q[3]);
    if (!(std::fabs(length - 1.0) <= 0.00769))
      quaternion->fail("the quaternion is not of unit length", "x, y, z, w of length 1");
    return rotation_of(q[0] / length, q[1] / length, q[2] / length, q[3] / length);
  }
  glm::dmat3 m(1.0);
  if (!degrees) return m;
  degrees->array(3, 3);
  for (int axis = 0; axis < 3; ++axis) {
    const double half = 0.5 * degrees->element(size_t(axis)).number(-36000.0, 36000.0) * kRadPerDeg;
    double q[3] = {0.0, 0.0, 0.0};
    q[axis] = sine(half);
    const glm::dmat3 turn = rotation_of(q[0], q[1], q[2], cosine(half));
    glm::dmat3 product(0.0);
    for (int c = 0; c < 3; ++c) product[c] = (turn[0] * m[c][0] + turn[1] * m[c][1]) + turn[2] * m[c][2];
    m = product;
  }
  return m;
}

glm::mat4x3 read_transform(const json::Node& object) {
  glm::dvec3 scale(1.0);
  if (const auto node = object.find("scale"))
    scale =
        node->is_array() ? glm::dvec3(node->vec3(-kLargest, kLargest)) : glm::dvec3(node->real(-kLargest, kLargest));
  const glm::dmat3 rotation = read_rotation(object);
  const glm::vec3 position = vec3_or(object, "position", glm::vec3(0.0f));
  return glm::mat4x3(glm::vec3(rotation[0] * scale.x), glm::vec3(rotation[1] * scale.y),
                     glm::vec3(rotation[2] * scale.z), position);
}

/// Adds objects to a scene; each geometry file, generated mesh and colour once.
class ObjectReader {
 public:
  ObjectReader(Scene& scene, const std::string& path, const SceneLimits& limits, const ImageDecoder& decode)
      : scene_(scene), path_(path), folder_(path), limits_(limits), surfaces_(scene, path_, folder_, limits_, decode) {}

  void read_textures(const json::Node& list) { surfaces_.read_textures(list); }

  void read_materials(const json::Node& list) {
    const size_t count = list.array(0, SIZE_MAX).size();
    for (size_t i = 0; i < count; ++i) {
      const json::Node node = list.element(i);
      Material material = surfaces_.read_material(node);
      if (!named_.emplace(material.name, uint32_t(scene_.materials.size())).second)
        node.fail("a material of this name exists", "another name");
      scene_.materials.push_back(std::move(material));
    }
    surfaces_.complete_mip_chains();
  }

  void read_object(const json::Node& node) {
    node.check_keys(kObjects[kObject]);
    Instance instance;
    instance.mesh = mesh(node);
    instance.material = material(node);
    instance.world_from_object = read_transform(node);
    scene_.instances.push_back(instance);
  }

 private:
  uint32_t mesh(const json::Node& node) {
    const auto geometry = node.find("geometry"), generated = node.find("mesh"), normals = node.find("normals");
    if (geometry.has_value() == generated.has_value())
      node.fail("an object has 'geometry' or 'mesh', one of them", "name a file or a mesh of ours");
    if (generated) {
      if (normals) normals->fail("a mesh of ours has normals", "remove it");
      return generated_mesh(*generated);
    }
    constexpr std::string_view kNormals[] = {"flat", "smooth"};
    const MissingNormals missing = normals ? MissingNormals(normals->choice(kNormals)) : MissingNormals::flat;
    const std::string file = relative_path_from_uri(geometry->string(), path_ + ": " + geometry->pointer());
    const auto [found, is_new] = files_.emplace(std::tuple(file, missing), uint32_t(scene_.meshes.size()));
    if (is_new) {
      if (!is_geometry_name(file)) geometry->fail("the ending names no geometry format", ".ply or .ply.gz");
      const Bytes bytes = folder_.read(file, limits_.file_bytes, path_ + ": " + geometry->pointer());
      scene_.meshes.push_back(mesh_from_file(bytes, file, limits_.file_bytes, missing));
    }
    return found->second;
  }

  uint32_t generated_mesh(const json::Node& node) {
    constexpr std::string_view kNames[] = {"cube", "plane", "sphere", "knot", "rabbit"};
    const size_t which = node.choice(kNames);
    const auto [found, is_new] = generated_.emplace(which, uint32_t(scene_.meshes.size()));
    if (is_new)
      scene_.meshes.push_back(which == 0   ? cube_mesh()
                              : which == 1 ? plane_mesh(14)
                              : which == 2 ? sphere_mesh(28)
                              : which == 3 ? builtin::knot_mesh()
                                           : builtin::rabbit_mesh());
    return found->second;
  }

  uint32_t material(const json::Node& node) {
    const auto color = node.find("color"), name = node.find("material");
    if (color && name) node.fail("'color' and 'material' exclude each other", "one of them");
    if (name) {
      const auto found = named_.find(name->string());
      if (found == named_.end()) name->fail("no material has this name", "a name from /materials");
      return found->second;
    }
    const glm::vec4 rgba = color ? color->color() : glm::vec4(0.8f, 0.8f, 0.8f, 1.0f);
    const auto [found, is_new] =
        colored_.emplace(std::tuple(rgba.x, rgba.y, rgba.z, rgba.w), uint32_t(scene_.materials.size()));
    if (is_new) scene_.materials.push_back({"", rgba});
    return found->second;
  }

  Scene& scene_;
  std::string path_;
  SceneFolder folder_;
  SceneLimits limits_;
  MaterialReader surfaces_;
  std::map<std::tuple<std::string, MissingNormals>, uint32_t> files_;
  std::map<size_t, uint32_t> generated_;
  std::map<std::string, uint32_t, std::less<>> named_;
  std::map<std::tuple<float, float, float, float>, uint32_t> colored_;
};

// --- Lights --------------------------------------------------------------------------------------------------------

glm::vec3 read_direction(const json::Node& node) {
  const glm::dvec3 direction(node.vec3(-1e9f, 1e9f));
  const glm::dvec3 d = unit(direction);
  if (!(dot(d, d) > 0.5)) node.fail("the direction has no length", "a vector that is not 0");
  return glm::vec3(d);
}

glm::vec3 read_color(const json::Node& node) {
  const auto color = node.find("color");
  const glm::vec3 rgb = color ? color->vec3(0.0f, kLargest) : glm::vec3(1.0f);
  return glm::vec3(glm::dvec3(rgb) * double(real_or(node, "intensity", 1.0f, 0.0f, kLargest)));
}

float read_range(const json::Node& node) {
  return real_or(node, "range", std::numeric_limits<float>::infinity(), kSmallest, kLargest);
}

glm::vec3 read_attenuation(const json::Node& node) {
  const auto attenuation = node.find("attenuation");
  return attenuation ? attenuation->vec3(0.0f, kLargest) : glm::vec3(1.0f, 0.0f, 0.0f);
}

Light read_light(const json::Node& node, LightType type) {
  Light light;
  light.type = type;
  light.color = read_color(node);
  if (const auto ambient = node.find("ambient")) light.ambient = ambient->vec3(0.0f, kLargest);
  if (type == LightType::directional || type == LightType::spot)
    light.direction = read_direction(node.member("direction"));
  if (type == LightType::ambient || type == LightType::directional) return light;
  light.position = node.member("position").vec3(-kLargest, kLargest);
  light.range = read_range(node);
  light.attenuation = read_attenuation(node);
  if (type == LightType::point) return light;
  const double cone = node.member("cone_deg").number(0.0, 180.0);
  const auto penumbra = node.find("penumbra_deg");
  const double fade = penumbra ? penumbra->number(0.0, 180.0) : 0.0;
  if (cone + fade > 180.0) node.fail("cone_deg and penumbra_deg together are over 180", "a sum of at most 180");
  light.cone_rad = float(cone * kRadPerDeg);
  light.penumbra_rad = float(fade * kRadPerDeg);
  light.spot_exponent = real_or(node, "spot_exponent", 0.0f, 0.0, 8192.0);
  return light;
}

void read_ring(const json::Node& node, std::vector<Light>& lights, const SceneLimits& limits) {
  LightRing ring;
  ring.count = uint32_t(node.member("count").integer(1, UINT32_MAX));
  if (lights.size() + ring.count > limits.lights)
    node.fail("the lights are over the limit", "at most " + std::to_string(limits.lights), ErrorKind::limit);
  ring.centre = glm::dvec3(vec3_or(node, "center", glm::vec3(0.0f)));
  ring.centre.y += double(real_or(node, "height", 0.0f, -kLargest, kLargest));
  ring.radius = double(node.member("radius").real(kSmallest, kLargest));
  std::vector<glm::vec3> colors{glm::vec3(1.0f)};
  if (const auto list = node.find("colors")) {
    colors.clear();
    for (size_t i = 0; i < list->array(1, 64).size(); ++i) colors.push_back(list->element(i).vec3(0.0f, kLargest));
  }
  ring.colors = colors;
  ring.intensity = double(real_or(node, "intensity", 1.0f, 0.0f, kLargest));
  ring.noise = double(real_or(node, "noise", 0.0f, 0.0f, 1.0f));
  if (const auto seed = node.find("seed")) ring.seed = uint64_t(seed->integer(0, 9007199254740991));
  ring.range = read_range(node);
  ring.attenuation = read_attenuation(node);
  add_ring(lights, ring);
}

void read_lights(const json::Node& list, std::vector<Light>& lights, const SceneLimits& limits) {
  constexpr std::string_view kTypes[] = {"ambient", "directional", "point", "spot", "ring"};  // as LightType, then ring
  const size_t count = list.array(0, SIZE_MAX).size();
  for (size_t i = 0; i < count; ++i) {
    const json::Node node = list.element(i);
    const size_t type = node.member("type").choice(kTypes);
    node.check_keys(kObjects[kAmbient + type]);
    if (kAmbient + type == kRing)
      read_ring(node, lights, limits);
    else
      lights.push_back(read_light(node, LightType(type)));
  }
}

}  // namespace

std::span<const json::ObjectKeys> scene_object_keys() { return kObjects; }

Scene scene_from_json(std::string_view text, const std::string& path, const SceneLimits& limits,
                      const ImageDecoder& decode) {
  const json::Value value = json::parse(text, path);
  const json::Node root(value, path);
  root.check_keys(kObjects[kRoot]);
  root.member("version").integer(1, 1);
  Scene scene;
  if (const auto pipeline = root.find("pipeline")) {
    pipeline_from_node(*pipeline,
                       presets().front().pipeline);  // bad values are refused here, where the place is known
    scene.pipeline_text = json::text_of(pipeline->value());
  }
  if (const auto clear = root.find("clear")) scene.clear = clear->color();
  if (const auto lights = root.find("lights")) read_lights(*lights, scene.lights, limits);
  ObjectReader objects(scene, path, limits, decode);
  if (const auto textures = root.find("textures")) objects.read_textures(*textures);
  if (const auto materials = root.find("materials")) objects.read_materials(*materials);
  if (const auto list = root.find("objects")) {
    const size_t count = list->array(0, SIZE_MAX).size();
    for (size_t i = 0; i < count; ++i) objects.read_object(list->element(i));
  }
  const auto camera = root.find("camera");
  scene.camera = camera ? read_camera(*camera) : camera_seeing(bounds_of(scene));
  return scene;
}

}  // namespace trueshade
