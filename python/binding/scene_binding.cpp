// Scenes: loaded, or built from arrays.
#include <cmath>
#include <cstring>

#include "core/image_files/image_io.h"
#include "python/binding/bindings.h"
#include "scenes/pipeline/fit_lights.h"
#include "scenes/pipeline/presets.h"
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

Scene load(const std::string& spec, double time) {
  const py::gil_scoped_release release;
  const SceneLimits limits;
  Scene scene =
      load_scene(spec, limits, [&](std::span<const uint8_t> content, const std::string& where, uint64_t most) {
        return decode_image(content, where, most, limits.expansion);
      });
  set_time(scene, time);
  return scene;
}

template <size_t n>
void take(std::array<std::vector<float>, n>& to, const py::object& array, const std::string& name) {
  if (array.is_none()) return;
  std::vector<std::vector<float>> columns = columns_of(array.cast<py::array>(), name, n);
  for (size_t c = 0; c < n; ++c) to[c] = std::move(columns[c]);
}

/// Unit normals of the faces, added up at each vertex by area, for meshes without any.
void set_face_normals(Mesh& mesh) {
  for (auto& stream : mesh.normal) stream.assign(mesh.vertex_count(), 0.0f);
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    double p[3][3];
    for (size_t k = 0; k < 3; ++k)
      for (size_t c = 0; c < 3; ++c) p[k][c] = double(mesh.position[c][mesh.indices[i + k]]);
    for (size_t c = 0; c < 3; ++c) {
      const size_t a = (c + 1) % 3, b = (c + 2) % 3;
      const double n = (p[1][a] - p[0][a]) * (p[2][b] - p[0][b]) - (p[1][b] - p[0][b]) * (p[2][a] - p[0][a]);
      for (size_t k = 0; k < 3; ++k) mesh.normal[c][mesh.indices[i + k]] += float(n);
    }
  }
}

uint32_t add_mesh(Scene& scene, const py::array& positions, const py::array& indices, const py::object& normals,
                  const py::object& uv, const py::object& colors, const std::string& name) {
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
  if (normals.is_none()) set_face_normals(mesh);
  const auto check_count = [&](const std::vector<float>& stream, const char* what) {
    if (!stream.empty() && stream.size() != mesh.vertex_count())
      throw bad_argument(
          what,
          "there are " + std::to_string(stream.size()) + ", and " + std::to_string(mesh.vertex_count()) + " positions",
          "one a position");
  };
  check_count(mesh.normal[0], "normals");
  check_count(mesh.uv[0], "uv");
  check_count(mesh.color[0], "colors");
  scene.meshes.push_back(std::move(mesh));
  return uint32_t(scene.meshes.size() - 1);
}

uint32_t add_texture(Scene& scene, const py::array& texels, bool srgb, bool mipmaps, const std::string& name) {
  const Image image = image_of(texels, "texels");
  Texture texture;
  texture.name = name;
  if (image.format == Format::rgba8)
    texture.format = srgb ? TextureFormat::srgb8_a8 : TextureFormat::rgba8;
  else if (image.format == Format::rgba16f)
    texture.format = TextureFormat::rgba16f;
  else if (image.format == Format::rgba32f)
    texture.format = TextureFormat::rgba32f;
  else
    throw bad_argument("texels", "textures have four channels of uint8, float16 or float32",
                       "pass an array of shape (height, width, 4)");
  // The first row of an image is its top, and that of a texture is at v = 0: rows are kept, so that texel [0, 0] is at
  // u = v = 0, as glTexImage2D has it.
  texture.levels.push_back({image.width, image.height, image.texels});
  if (mipmaps) build_mip_chain(texture);
  scene.textures.push_back(std::move(texture));
  return uint32_t(scene.textures.size() - 1);
}

TextureSlot slot_of(const Scene& scene, const py::object& index, const std::string& name) {
  TextureSlot slot;
  if (index.is_none()) return slot;
  const int64_t texture = index.cast<int64_t>();
  if (texture < 0 || size_t(texture) >= scene.textures.size())
    throw bad_argument(name, "there is no texture " + std::to_string(texture), "an index that add_texture() gave");
  slot.texture = int32_t(texture);
  return slot;
}

uint32_t add_material(Scene& scene, const py::object& base_color, const py::object& specular_color, float shininess,
                      const py::object& emission, float metallic, float roughness, const py::object& color_map,
                      const py::object& specular_map, const py::object& normal_map,
                      const py::object& metallic_roughness_map, const py::object& emission_map,
                      const py::object& occlusion_map, float normal_scale, float alpha_cutoff, bool transparent,
                      bool double_sided, bool unlit, const std::string& name) {
  Material m;
  const std::vector<double> base = numbers_of(base_color, "base_color", 4);
  m.name = name;
  m.base_color = {float(base[0]), float(base[1]), float(base[2]), float(base[3])};
  m.specular_color = vec3_of(specular_color, "specular_color");
  m.shininess = shininess, m.metallic = metallic, m.roughness = roughness;
  m.emission = vec3_of(emission, "emission");
  m.color_map = slot_of(scene, color_map, "color_map");
  m.specular_map = slot_of(scene, specular_map, "specular_map");
  m.normal_map = slot_of(scene, normal_map, "normal_map");
  m.metallic_roughness_map = slot_of(scene, metallic_roughness_map, "metallic_roughness_map");
  m.emission_map = slot_of(scene, emission_map, "emission_map");
  m.occlusion_map = slot_of(scene, occlusion_map, "occlusion_map");
  m.normal_scale = normal_scale, m.alpha_cutoff = alpha_cutoff;
  m.transparent = transparent, m.double_sided = double_sided, m.unlit = unlit;
  scene.materials.push_back(std::move(m));
  return uint32_t(scene.materials.size() - 1);
}

uint32_t add_instance(Scene& scene, uint32_t mesh, uint32_t material, const py::object& world_from_object) {
  Instance instance;
  if (mesh >= scene.meshes.size())
    throw bad_argument("mesh", "there is no mesh " + std::to_string(mesh), "an index that add_mesh() gave");
  if (material >= scene.materials.size())
    throw bad_argument("material", "there is no material " + std::to_string(material),
                       "an index that add_material() gave");
  instance.mesh = mesh, instance.material = material;
  if (!world_from_object.is_none()) {
    const py::array_t<double, py::array::c_style | py::array::forcecast> matrix(world_from_object);
    if (matrix.ndim() != 2 || (matrix.shape(0) != 3 && matrix.shape(0) != 4) || matrix.shape(1) != 4)
      throw bad_argument("world_from_object", "it is no matrix of 3 or 4 rows of 4",
                         "an affine matrix that multiplies columns");
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 4; ++c) instance.world_from_object[c][r] = float(matrix.at(r, c));
    if (matrix.shape(0) == 4 &&
        (matrix.at(3, 0) != 0 || matrix.at(3, 1) != 0 || matrix.at(3, 2) != 0 || matrix.at(3, 3) != 1))
      throw bad_argument("world_from_object", "its last row is not 0, 0, 0, 1", "an affine matrix");
  }
  scene.instances.push_back(instance);
  return uint32_t(scene.instances.size() - 1);
}

LightType light_type_of(const std::string& name) {
  constexpr const char* kNames[] = {"ambient", "directional", "point", "spot"};
  for (size_t i = 0; i < 4; ++i)
    if (name == kNames[i]) return LightType(i);
  throw bad_argument("type", "there is no light of the type '" + name + "'", "ambient, directional, point or spot");
}

uint32_t add_light(Scene& scene, const std::string& type, const py::object& position, const py::object& direction,
                   const py::object& color, double intensity, double range, const py::object& attenuation,
                   double cone_deg, double penumbra_deg, const py::object& ambient, double spot_exponent) {
  Light light;
  light.type = light_type_of(type);
  light.position = vec3_of(position, "position");
  light.direction = direction_of(direction, "direction");
  light.color = vec3_of(color, "color") * float(intensity);
  light.range = float(range);
  light.attenuation = vec3_of(attenuation, "attenuation");
  light.cone_rad = float(cone_deg * (kPi / 180.0)), light.penumbra_rad = float(penumbra_deg * (kPi / 180.0));
  light.ambient = vec3_of(ambient, "ambient");
  light.spot_exponent = float(spot_exponent);
  scene.lights.push_back(light);
  return uint32_t(scene.lights.size() - 1);
}

/// Point lights of arrays: what a renderer of many lights has.
void add_point_lights(Scene& scene, const py::array& positions, const py::array& colors, const py::array& ranges) {
  const auto position = columns_of(positions, "positions", 3), color = columns_of(colors, "colors", 3);
  const auto range = columns_of(ranges, "ranges", 1);
  if (position[0].size() != color[0].size() || position[0].size() != range[0].size())
    throw bad_argument("positions", "positions, colors and ranges differ in their counts", "one of each a light");
  for (size_t i = 0; i < position[0].size(); ++i) {
    Light light;
    light.position = {position[0][i], position[1][i], position[2][i]};
    light.color = {color[0][i], color[1][i], color[2][i]};
    light.range = range[0][i];
    scene.lights.push_back(light);
  }
}

void set_camera(Scene& scene, const py::object& eye, const py::object& target, const py::object& up, double fov_deg,
                double near, double far, const py::object& clip_from_world) {
  Camera camera;
  camera.eye = vec3_of(eye, "eye"), camera.target = vec3_of(target, "target"), camera.up = vec3_of(up, "up");
  camera.fov_y_rad = float(fov_deg * (kPi / 180.0));
  camera.near = float(near), camera.far = float(far);
  if (!clip_from_world.is_none()) {
    const py::array_t<double, py::array::c_style | py::array::forcecast> matrix(clip_from_world);
    if (matrix.ndim() != 2 || matrix.shape(0) != 4 || matrix.shape(1) != 4)
      throw bad_argument("clip_from_world", "it is no matrix of 4 rows of 4", "a matrix that multiplies columns");
    camera.clip_from_world.emplace();
    for (size_t r = 0; r < 4; ++r)
      for (size_t c = 0; c < 4; ++c) (*camera.clip_from_world)[4 * c + r] = float(matrix.at(r, c));
  }
  scene.camera = camera;
}

void set_clear(Scene& scene, const py::object& color) {
  const std::vector<double> c = numbers_of(color, "clear", 4);
  scene.clear = {float(c[0]), float(c[1]), float(c[2]), float(c[3])};
}

}  // namespace

void add_scene(py::module_& module) {
  using namespace py::literals;
  module.def("load_scene", &load, "spec"_a, "time"_a = 0.0);
  const py::tuple zero = py::make_tuple(0.0, 0.0, 0.0), one = py::make_tuple(1.0, 1.0, 1.0);
  const py::tuple quarter = py::make_tuple(0.25, 0.25, 0.25);
  py::class_<Scene, std::shared_ptr<Scene>>(module, "Scene")
      .def(py::init([] {
        auto scene = std::make_shared<Scene>();
        scene->spec = "python";
        return scene;
      }))
      .def("add_mesh", &add_mesh, "positions"_a, "indices"_a, "normals"_a = py::none(), "uv"_a = py::none(),
           "colors"_a = py::none(), py::kw_only(), "name"_a = "")
      .def("add_texture", &add_texture, "texels"_a, py::kw_only(), "srgb"_a = true, "mipmaps"_a = true, "name"_a = "")
      .def("add_material", &add_material, "base_color"_a = py::make_tuple(1.0, 1.0, 1.0, 1.0), py::kw_only(),
           "specular_color"_a = quarter, "shininess"_a = 32.0f, "emission"_a = zero, "metallic"_a = 0.0f,
           "roughness"_a = 1.0f, "color_map"_a = py::none(), "specular_map"_a = py::none(), "normal_map"_a = py::none(),
           "metallic_roughness_map"_a = py::none(), "emission_map"_a = py::none(), "occlusion_map"_a = py::none(),
           "normal_scale"_a = 1.0f, "alpha_cutoff"_a = 0.0f, "transparent"_a = false, "double_sided"_a = false,
           "unlit"_a = false, "name"_a = "")
      .def("add_instance", &add_instance, "mesh"_a, "material"_a, "world_from_object"_a = py::none())
      .def("add_light", &add_light, "type"_a = "point", py::kw_only(), "position"_a = zero,
           "direction"_a = py::make_tuple(0.0, 0.0, -1.0), "color"_a = one, "intensity"_a = 1.0, "range"_a = HUGE_VAL,
           "attenuation"_a = py::make_tuple(1.0, 0.0, 0.0), "cone_deg"_a = 180.0, "penumbra_deg"_a = 0.0,
           "ambient"_a = zero, "spot_exponent"_a = 0.0)
      .def("add_point_lights", &add_point_lights, "positions"_a, "colors"_a, "ranges"_a)
      .def("set_camera", &set_camera, "eye"_a, "target"_a, py::kw_only(), "up"_a = py::make_tuple(0.0, 1.0, 0.0),
           "fov_deg"_a = 45.0, "near"_a = 0.1, "far"_a = 1000.0, "clip_from_world"_a = py::none())
      .def("set_clear", &set_clear, "color"_a)
      .def(
          "set_time", [](Scene& scene, double time) { set_time(scene, time); }, "time"_a)
      .def_property_readonly("hash", [](const Scene& scene) { return "sha256:" + scene_hash(scene); })
      .def_readwrite("spec", &Scene::spec)
      .def_property_readonly("triangles", &Scene::triangle_count)
      .def_property_readonly("meshes", [](const Scene& s) { return s.meshes.size(); })
      .def_property_readonly("materials", [](const Scene& s) { return s.materials.size(); })
      .def_property_readonly("textures", [](const Scene& s) { return s.textures.size(); })
      .def_property_readonly("instances", [](const Scene& s) { return s.instances.size(); })
      .def_property_readonly("lights", [](const Scene& s) { return s.lights.size(); })
      .def_property_readonly("notes", [](const Scene& s) { return s.notes; })
      .def("__repr__", [](const Scene& s) {
        return "<trueshade.Scene '" + s.spec + "': " + std::to_string(s.triangle_count()) + " triangles, " +
               std::to_string(s.lights.size()) + " lights>";
      });
}

}  // namespace trueshade::python
