// Scenes: loaded from files, or built from arrays.
#include <cmath>
#include <cstring>
#include <optional>

#include "core/image_files/image_io.h"
#include "python/binding/bindings.h"
#include "python/binding/python_scene.h"
#include "scenes/add_normals.h"
#include "scenes/camera_changes.h"
#include "scenes/light_fields.h"
#include "scenes/texture.h"
#include "scenes/trig.h"

namespace trueshade::python {
namespace {

glm::vec3 vec3_of(const py::handle& values, const std::string& name) {
  const std::vector<double> v = numbers_of(values, name, 3);
  return {float(v[0]), float(v[1]), float(v[2])};
}

/// A direction as scene files have it: rounded to f32, made unit length in f64, rounded again (docs/arithmetic.md,
/// section 1).
glm::vec3 direction_of(const py::handle& values, const std::string& name) {
  const glm::vec3 v = vec3_of(values, name);
  const double x = double(v.x), y = double(v.y), z = double(v.z), length = std::sqrt((x * x + y * y) + z * z);
  if (!(length > 0.0)) throw bad_argument(name, "it has no length", "a direction");
  const double inverse = 1.0 / length;
  return {float(x * inverse), float(y * inverse), float(z * inverse)};
}

/// Colours and the like, each of whose numbers is in [low, high].
glm::vec3 vec3_within(const py::handle& values, const std::string& name, double low, double high) {
  for (const double number : numbers_of(values, name, 3)) number_within(number, name, low, high);
  return vec3_of(values, name);
}

constexpr double kFarthest = 1e18, kBrightest = 1e18;  // as validate() of a scene has it

glm::vec3 place_of(const py::handle& values, const std::string& name) {
  return vec3_within(values, name, -kFarthest, kFarthest);
}

glm::vec3 color_of(const py::handle& values, const std::string& name) {
  return vec3_within(values, name, 0.0, kBrightest);
}

/// A number or a name.
std::optional<std::string> part_of(const py::object& part) {
  if (part.is_none()) return std::nullopt;
  return std::string(py::str(part));
}

std::shared_ptr<PythonScene> load(const py::object& spec_or_path, double time, const py::object& camera,
                                  const py::object& animation, bool lenient, bool trust_paths) {
  const std::string spec = path_of(spec_or_path);
  number_within(time, "time", -kLatestTime, kLatestTime);
  std::shared_ptr<PythonScene> loaded;
  const SceneParts parts{part_of(camera), part_of(animation)};
  const py::gil_scoped_release release;
  SceneLimits limits;
  limits.leniency = lenient ? Leniency::asked : Leniency::offered;
  if (trust_paths) limits.named_paths = NamedPaths::any;
  loaded = std::make_shared<PythonScene>(load_scene(
      spec, limits,
      [&](std::span<const uint8_t> content, const std::string& where, uint64_t most) {
        return decode_image(content, where, most, limits.expansion);
      },
      parts));
  loaded->set_time(time);
  return loaded;
}

template <size_t n>
void take(std::array<FloatStream, n>& to, const py::object& array, const std::string& name) {
  if (array.is_none()) return;
  std::vector<std::vector<float>> columns = columns_of(array, name, n);
  for (size_t c = 0; c < n; ++c) to[c] = std::move(columns[c]);
}

uint32_t add_mesh(PythonScene& to, const py::object& positions, const py::object& indices, const py::object& normals,
                  const py::object& uv, const py::object& colors, bool flat, const std::string& name) {
  if (positions.is_none()) throw bad_argument("positions", "there are none", "pass an array of shape (count, 3)");
  Mesh mesh;
  mesh.name = name;
  take<3>(mesh.position, positions, "positions");
  mesh.indices = indices_of(indices, "indices", 3);
  for (size_t i = 0; i < mesh.indices.size(); ++i)
    if (mesh.indices[i] >= mesh.vertex_count())
      throw bad_argument("indices",
                         "element [" + std::to_string(i / 3) + ", " + std::to_string(i % 3) + "] is " +
                             std::to_string(mesh.indices[i]) + ", and there are " +
                             std::to_string(mesh.vertex_count()) + " positions",
                         "indices below the number of positions");
  take<3>(mesh.normal, normals, "normals");
  take<2>(mesh.uv, uv, "uv");
  take<4>(mesh.color, colors, "colors");
  const auto check_count = [&](const FloatStream& stream, const char* what) {
    if (!stream.empty() && stream.size() != mesh.vertex_count())
      throw bad_argument(
          what,
          "there are " + std::to_string(stream.size()) + ", and " + std::to_string(mesh.vertex_count()) + " positions",
          "one a position");
  };
  check_count(mesh.normal[0], "normals");
  check_count(mesh.uv[0], "uv");
  check_count(mesh.color[0], "colors");
  if (mesh.vertex_count() == 0 || mesh.indices.empty())
    throw bad_argument(mesh.indices.empty() ? "indices" : "positions", "the array is empty", "at least one triangle");
  for (size_t c = 0; c < 3; ++c)
    for (size_t i = 0; i < mesh.vertex_count(); ++i)
      if (std::fabs(mesh.position[c][i]) > float(kFarthest))
        throw bad_argument("positions", "element [" + std::to_string(i) + ", " + std::to_string(c) + "] is over 1e18",
                           "scene units, at most 1e18");
  if (normals.is_none()) add_normals(mesh, flat ? MissingNormals::flat : MissingNormals::smooth);
  Scene& scene = to.changeable();
  scene.meshes.push_back(std::move(mesh));
  return uint32_t(scene.meshes.size() - 1);
}

template <class Names>
size_t place_among(const Names& names, const std::string& given, const std::string& argument) {
  std::string known;
  for (size_t i = 0; i < std::size(names); ++i) {
    if (names[i] == given) return i;
    known += (i == 0 ? "" : ", ") + std::string(names[i]);
  }
  throw bad_argument(argument, "there is no '" + given + "'", "one of: " + known);
}

uint32_t add_texture(PythonScene& to, const py::object& texels, bool srgb, bool mipmaps, const std::string& wrap,
                     const std::string& filter, const std::string& name) {
  const Image image = image_of(texels, "texels", {}, ImageUse::picture);
  Texture texture;
  texture.name = name;
  if (image.format == Format::rgba8)
    texture.format = srgb ? TextureFormat::srgb8_a8 : TextureFormat::rgba8;
  else if (image.format == Format::rgba16f)
    texture.format = TextureFormat::rgba16f;
  else if (image.format == Format::rgba32f)
    texture.format = TextureFormat::rgba32f;
  else
    throw bad_argument("texels", "textures are of uint8, or of float16 or float32 with four channels",
                       "pass an array of shape (height, width, 4)");
  if (image.width > kMaxTextureSide || image.height > kMaxTextureSide)
    throw Error(ErrorKind::limit, "texels", "a side is over 16384 texels", "pass a smaller texture");
  Sampler sampler;
  sampler.wrap.fill(Wrap(place_among(kWrapNames, wrap, "wrap")));
  sampler.mag_filter = sampler.min_filter = Filter(place_among(kFilterNames, filter, "filter"));
  if (!mipmaps) sampler.mip_filter = MipFilter::none;
  // The first row of an image is its top, and that of a texture is at v = 0: rows are kept, so that texel [0, 0] is at
  // u = v = 0, as glTexImage2D has it.
  texture.levels.push_back({image.width, image.height, image.texels});
  if (mipmaps) build_mip_chain(texture);
  Scene& scene = to.changeable();
  scene.textures.push_back(std::move(texture));
  to.samplers().resize(scene.textures.size());
  to.samplers().back() = sampler;
  return uint32_t(scene.textures.size() - 1);
}

TextureSlot slot_of(PythonScene& scene, const py::object& index, const std::string& name) {
  TextureSlot slot;
  if (index.is_none()) return slot;
  if (PyIndex_Check(index.ptr()) == 0 || PyBool_Check(index.ptr()))
    throw bad_argument(name, "it is a " + type_name(index), "an index that add_texture() gave, or None");
  const Py_ssize_t texture = PyNumber_AsSsize_t(index.ptr(), nullptr);  // what is larger becomes the largest
  if (texture < 0 || size_t(texture) >= scene.values().textures.size())
    throw bad_argument(name, "there is no texture " + std::to_string(texture), "an index that add_texture() gave");
  slot.texture = int32_t(texture);
  if (size_t(texture) < scene.samplers().size()) slot.sampler = scene.samplers()[size_t(texture)];
  return slot;
}

uint32_t add_material(PythonScene& to, const py::object& base_color, const py::object& specular_color, double shininess,
                      const py::object& emission, double metallic, double roughness, const py::object& color_map,
                      const py::object& specular_map, const py::object& normal_map,
                      const py::object& metallic_roughness_map, const py::object& emission_map,
                      const py::object& occlusion_map, double normal_scale, double alpha_cutoff, bool transparent,
                      bool double_sided, bool unlit, const std::string& name) {
  Material m;
  const std::vector<double> base = numbers_of(base_color, "base_color", 4);
  for (const double number : base) number_within(number, "base_color", 0.0, kBrightest);
  m.name = name;
  m.base_color = {float(base[0]), float(base[1]), float(base[2]), float(base[3])};
  m.specular_color = color_of(specular_color, "specular_color");
  if (number_within(shininess, "shininess", 0, 8192) != std::floor(shininess))
    throw bad_argument("shininess", "it is no whole number", "a whole number from 0 to 8192");
  m.shininess = float(shininess);
  m.metallic = float(number_within(metallic, "metallic", 0, 1));
  m.roughness = float(number_within(roughness, "roughness", 0, 1));
  m.emission = color_of(emission, "emission");
  m.color_map = slot_of(to, color_map, "color_map");
  m.specular_map = slot_of(to, specular_map, "specular_map");
  m.normal_map = slot_of(to, normal_map, "normal_map");
  m.metallic_roughness_map = slot_of(to, metallic_roughness_map, "metallic_roughness_map");
  m.emission_map = slot_of(to, emission_map, "emission_map");
  m.occlusion_map = slot_of(to, occlusion_map, "occlusion_map");
  m.normal_scale = float(number_within(normal_scale, "normal_scale", -1e6, 1e6));
  m.alpha_cutoff = float(number_within(alpha_cutoff, "alpha_cutoff", 0, 1e18));
  m.transparent = transparent, m.double_sided = double_sided, m.unlit = unlit;
  Scene& scene = to.changeable();
  scene.materials.push_back(std::move(m));
  return uint32_t(scene.materials.size() - 1);
}

/// Checks the indices of instances, which have the type that Python's whole numbers have.
Instance instance_of(const Scene& scene, int64_t mesh, int64_t material) {
  if (mesh < 0 || size_t(mesh) >= scene.meshes.size())
    throw bad_argument("mesh", "there is no mesh " + std::to_string(mesh), "an index that add_mesh() gave");
  if (material < 0 || size_t(material) >= scene.materials.size())
    throw bad_argument("material", "there is no material " + std::to_string(material),
                       "an index that add_material() gave");
  Instance instance;
  instance.mesh = uint32_t(mesh), instance.material = uint32_t(material);
  return instance;
}

void place_instance(Instance& instance, const Matrices& matrices, size_t i, const std::string& name) {
  for (size_t r = 0; r < 3; ++r)
    for (size_t c = 0; c < 4; ++c) instance.world_from_object[int(c)][int(r)] = float(matrices.at(i, r, c));
  if (matrices.rows == 4 && (matrices.at(i, 3, 0) != 0 || matrices.at(i, 3, 1) != 0 || matrices.at(i, 3, 2) != 0 ||
                             matrices.at(i, 3, 3) != 1))
    throw bad_argument(name, "the last row is not 0, 0, 0, 1", "an affine matrix that multiplies columns");
}

uint32_t add_instance(PythonScene& to, int64_t mesh, int64_t material, const py::object& world_from_object) {
  Instance instance = instance_of(to.values(), mesh, material);
  if (!world_from_object.is_none())
    place_instance(instance, matrices_of(world_from_object, "world_from_object", 2), 0, "world_from_object");
  Scene& scene = to.changeable();
  scene.instances.push_back(instance);
  return uint32_t(scene.instances.size() - 1);
}

void add_instances(PythonScene& to, int64_t mesh, int64_t material, const py::object& world_from_objects) {
  Instance instance = instance_of(to.values(), mesh, material);
  const Matrices matrices = matrices_of(world_from_objects, "world_from_objects", 3);
  std::vector<Instance> instances;
  for (size_t i = 0; i < matrices.count; ++i) {
    place_instance(instance, matrices, i, "world_from_objects: matrix " + std::to_string(i));
    instances.push_back(instance);
  }
  Scene& scene = to.changeable();
  scene.instances.insert(scene.instances.end(), instances.begin(), instances.end());
}

LightType light_type_of(const std::string& name) {
  std::string names;
  for (size_t i = 0; i < std::size(kLightTypes); ++i) {
    if (name == kLightTypes[i].name) return LightType(i);
    names += (i == 0 ? "" : ", ") + std::string(kLightTypes[i].name);
  }
  throw bad_argument("type", "there is no light of the type '" + name + "'", "one of: " + names);
}

float range_of(double range) {
  if (!(range > 0.0)) throw bad_argument("range", "it is not above 0", "scene units, or None for an infinite range");
  return float(range);
}

void set_area(Light& light, double radius, const py::object& right, const py::object& up) {
  const bool is_round = light.type == LightType::sphere || light.type == LightType::tube;
  const auto set = [&light](LightProperty property, const py::object& value, const char* name) {
    set_property(light, property, glm::dvec4(glm::dvec3(place_of(value, name)), 0.0));
  };
  if (light.type != LightType::sphere) set(LightProperty::right, right, "right");
  if (!is_round) set(LightProperty::up, up, "up");
  if (is_round) set_property(light, LightProperty::radius, glm::dvec4(number_within(radius, "radius", 1e-18, 1e18)));
}

uint32_t add_light(PythonScene& to, const std::string& type, const py::object& position, const py::object& direction,
                   const py::object& color, double intensity, const std::optional<double>& range,
                   const py::object& attenuation, double cone_deg, double penumbra_deg, const py::object& ambient,
                   double spot_exponent, double radius, const py::object& right, const py::object& up) {
  Light light;
  light.type = light_type_of(type);
  light.position = place_of(position, "position");
  light.direction = direction_of(direction, "direction");
  light.color = color_of(color, "color") * float(number_within(intensity, "intensity", 0, kBrightest));
  light.range = range_of(range.value_or(HUGE_VAL));
  light.attenuation = vec3_within(attenuation, "attenuation", 0.0, 1e18);
  light.cone_rad = float(number_within(cone_deg, "cone_deg", 0, 180) * (kPi / 180.0));
  light.penumbra_rad = float(number_within(penumbra_deg, "penumbra_deg", 0, 180) * (kPi / 180.0));
  light.ambient = color_of(ambient, "ambient");
  light.spot_exponent = float(number_within(spot_exponent, "spot_exponent", 0, 8192));
  if (has_area(light.type)) set_area(light, radius, right, up);
  Scene& scene = to.changeable();
  scene.lights.push_back(light);
  return uint32_t(scene.lights.size() - 1);
}

/// Point lights of arrays: what a renderer of many lights has.
void add_point_lights(PythonScene& to, const py::object& positions, const py::object& colors,
                      const py::object& ranges) {
  const auto position = columns_of(positions, "positions", 3), color = columns_of(colors, "colors", 3);
  const auto range = columns_of(ranges, "ranges", 1);
  if (position[0].size() != color[0].size() || position[0].size() != range[0].size())
    throw bad_argument("positions", "positions, colors and ranges differ in their counts", "one of each a light");
  std::vector<Light> lights(position[0].size());
  for (size_t i = 0; i < lights.size(); ++i) {
    for (size_t c = 0; c < 3; ++c)
      number_within(color[c][i], "colors: element [" + std::to_string(i) + ", " + std::to_string(c) + "]", 0.0,
                    kBrightest);
    if (!(range[0][i] > 0.0f))
      throw bad_argument("ranges", "element [" + std::to_string(i) + ", 0] is not above 0", "scene units");
    lights[i].position = {position[0][i], position[1][i], position[2][i]};
    lights[i].color = {color[0][i], color[1][i], color[2][i]};
    lights[i].range = range[0][i];
  }
  Scene& scene = to.changeable();
  scene.lights.insert(scene.lights.end(), lights.begin(), lights.end());
}

void set_camera(PythonScene& to, const py::object& eye, const py::object& target, const py::object& up, double fov_deg,
                const std::optional<double>& fov_x_deg, double near, double far, const py::object& clip_from_world) {
  if (target.is_none() && clip_from_world.is_none())
    throw bad_argument("target", "there is none", "the point that the camera looks at, or clip_from_world");
  Camera camera;
  camera.eye = place_of(eye, "eye"), camera.up = place_of(up, "up");
  if (!target.is_none()) camera.target = place_of(target, "target");
  camera.fov_y_rad = float(number_within(fov_deg, "fov_deg", 0.001, 179.999) * (kPi / 180.0));
  if (fov_x_deg) camera.fov_x_rad = float(number_within(*fov_x_deg, "fov_x_deg", 0.001, 179.999) * (kPi / 180.0));
  if (!(near > 0.0 && near < far && far <= kFarthest))
    throw bad_argument("near", "near and far are not 0 < near < far <= 1e18", "distances in scene units");
  camera.near = float(near), camera.far = float(far);
  if (!clip_from_world.is_none()) {
    const Matrices matrix = matrices_of(clip_from_world, "clip_from_world", 2);
    if (matrix.rows != 4) throw bad_argument("clip_from_world", "it has 3 rows", "pass one of shape (4, 4)");
    camera.clip_from_world.emplace();
    for (size_t r = 0; r < 4; ++r)
      for (size_t c = 0; c < 4; ++c) (*camera.clip_from_world)[4 * c + r] = float(matrix.at(0, r, c));
  }
  Scene& scene = to.changeable();
  scene.camera = camera, scene.camera_of_ours = false;
}

void set_orbit(PythonScene& to, double azimuth_deg, double elevation_deg, const std::optional<double>& distance,
               const py::object& look_at, const std::optional<double>& fov_deg, const py::object& size) {
  OrbitPlace place;
  place.azimuth_deg = number_within(azimuth_deg, "azimuth_deg", -36000.0, 36000.0);
  place.elevation_deg = number_within(elevation_deg, "elevation_deg", -90.0, 90.0);
  if (distance) {
    place.distance = number_within(*distance, "distance", 1e-30, 1e17);
    place.unit = DistanceUnit::scene_units;
  }
  CameraChanges changes;
  changes.orbit = place;
  if (!look_at.is_none()) changes.target = place_of(look_at, "look_at");
  if (fov_deg) changes.fov_y_deg = number_within(*fov_deg, "fov_deg", 0.001, 179.99);
  const std::vector<double> sides = numbers_of(size, "size", 2);
  for (const double side : sides) number_within(side, "size", 1.0, double(uint64_t(1) << 20));
  const double time = to.time();
  to.set_time(0.0);  // where scenes are framed
  const ChangedCamera camera(to.values(), changes, sides[0] / sides[1]);
  to.set_time(time);
  Scene& scene = to.changeable();
  camera.see(scene);
  scene.camera_of_ours = false;
}

void set_clear(PythonScene& to, const py::object& color) {
  const std::vector<double> c = numbers_of(color, "color", 4);
  for (const double number : c) number_within(number, "color", -kBrightest, kBrightest);
  to.changeable().clear = {float(c[0]), float(c[1]), float(c[2]), float(c[3])};
}

std::string hash_of(const std::shared_ptr<PythonScene>& scene) {
  const PythonScene::Reading reading(*scene);
  const py::gil_scoped_release release;
  return scene->hash();
}

std::string described(const PythonScene& scene) {
  const Scene& s = scene.values();
  return "<trueshade.Scene '" + s.spec + "': " + std::to_string(s.triangle_count()) + " triangles, " +
         std::to_string(s.lights.size()) + " lights>";
}

}  // namespace

void add_scene(py::module_& module) {
  using namespace py::literals;
  module.def("load_scene", &load, doc_of("load_scene"), "spec"_a, "time"_a = 0.0, py::kw_only(),
             "camera"_a = py::none(), "animation"_a = py::none(), "lenient"_a = false, "trust_paths"_a = false);
  const py::tuple zero = py::make_tuple(0.0, 0.0, 0.0), one = py::make_tuple(1.0, 1.0, 1.0);
  const py::tuple quarter = py::make_tuple(0.25, 0.25, 0.25);
  const auto count = [](auto list) { return [list](const PythonScene& s) { return (s.values().*list).size(); }; };
  py::class_<PythonScene, std::shared_ptr<PythonScene>>(module, "Scene", doc_of("Scene"))
      .def(py::init([] {
             Scene scene;
             scene.spec = "python";
             return std::make_shared<PythonScene>(std::move(scene));
           }),
           doc_of("Scene.__init__"))
      .def("add_mesh", &add_mesh, doc_of("Scene.add_mesh"), "positions"_a, "indices"_a, "normals"_a = py::none(),
           "uv"_a = py::none(), "colors"_a = py::none(), py::kw_only(), "flat"_a = false, "name"_a = "")
      .def("add_texture", &add_texture, doc_of("Scene.add_texture"), "texels"_a, py::kw_only(), "srgb"_a = true,
           "mipmaps"_a = true, "wrap"_a = "repeat", "filter"_a = "linear", "name"_a = "")
      .def("add_material", &add_material, doc_of("Scene.add_material"),
           "base_color"_a = py::make_tuple(1.0, 1.0, 1.0, 1.0), py::kw_only(), "specular_color"_a = quarter,
           "shininess"_a = 32.0, "emission"_a = zero, "metallic"_a = 0.0, "roughness"_a = 1.0,
           "color_map"_a = py::none(), "specular_map"_a = py::none(), "normal_map"_a = py::none(),
           "metallic_roughness_map"_a = py::none(), "emission_map"_a = py::none(), "occlusion_map"_a = py::none(),
           "normal_scale"_a = 1.0, "alpha_cutoff"_a = 0.0, "transparent"_a = false, "double_sided"_a = false,
           "unlit"_a = false, "name"_a = "")
      .def("add_instance", &add_instance, doc_of("Scene.add_instance"), "mesh"_a, "material"_a,
           "world_from_object"_a = py::none())
      .def("add_instances", &add_instances, doc_of("Scene.add_instances"), "mesh"_a, "material"_a,
           "world_from_objects"_a)
      .def("add_light", &add_light, doc_of("Scene.add_light"), "type"_a = "point", py::kw_only(), "position"_a = zero,
           "direction"_a = py::make_tuple(0.0, 0.0, -1.0), "color"_a = one, "intensity"_a = 1.0, "range"_a = py::none(),
           "attenuation"_a = py::make_tuple(1.0, 0.0, 0.0), "cone_deg"_a = 180.0, "penumbra_deg"_a = 0.0,
           "ambient"_a = zero, "spot_exponent"_a = 0.0, "radius"_a = 0.0, "right"_a = zero, "up"_a = zero)
      .def("add_point_lights", &add_point_lights, doc_of("Scene.add_point_lights"), "positions"_a, "colors"_a,
           "ranges"_a)
      .def("set_camera", &set_camera, doc_of("Scene.set_camera"), "eye"_a, "target"_a = py::none(), py::kw_only(),
           "up"_a = py::make_tuple(0.0, 1.0, 0.0), "fov_deg"_a = 45.0, "fov_x_deg"_a = py::none(), "near"_a = 0.1,
           "far"_a = 1000.0, "clip_from_world"_a = py::none())
      .def("set_orbit", &set_orbit, doc_of("Scene.set_orbit"), "azimuth_deg"_a, "elevation_deg"_a,
           "distance"_a = py::none(), py::kw_only(), "look_at"_a = py::none(), "fov_deg"_a = py::none(),
           "size"_a = py::make_tuple(1, 1))
      .def("set_clear", &set_clear, doc_of("Scene.set_clear"), "color"_a)
      .def("set_time", &PythonScene::set_time, doc_of("Scene.set_time"), "time"_a)
      .def_property_readonly("time", &PythonScene::time, doc_of("Scene.time"))
      .def_property_readonly("hash", &hash_of, doc_of("Scene.hash"))
      .def_property(
          "spec", [](const PythonScene& s) { return s.values().spec; },
          [](PythonScene& s, const std::string& spec) { s.changeable().spec = spec; }, doc_of("Scene.spec"))
      .def_property_readonly(
          "triangles", [](const PythonScene& s) { return s.values().triangle_count(); }, doc_of("Scene.triangles"))
      .def_property_readonly("meshes", count(&Scene::meshes), doc_of("Scene.meshes"))
      .def_property_readonly("materials", count(&Scene::materials), doc_of("Scene.materials"))
      .def_property_readonly("textures", count(&Scene::textures), doc_of("Scene.textures"))
      .def_property_readonly("instances", count(&Scene::instances), doc_of("Scene.instances"))
      .def_property_readonly("lights", count(&Scene::lights), doc_of("Scene.lights"))
      .def_property_readonly(
          "notes",
          [](const PythonScene& s) {
            std::vector<std::string> notes;
            for (const std::string& note : s.values().notes) notes.push_back(in_words_of_python(note));
            return notes;
          },
          doc_of("Scene.notes"))
      .def("__repr__", &described);
}

}  // namespace trueshade::python
