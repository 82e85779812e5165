#include <algorithm>
#include <cmath>

#include "scenes/camera.h"
#include "scenes/files/gltf/extras/field_writer.h"
#include "scenes/files/gltf/extras/punctual_lights.h"
#include "scenes/files/gltf/writing/scene_writer.h"
#include "scenes/hierarchy.h"
#include "scenes/trig.h"

namespace trueshade::gltf {
namespace {

/// A node that stands at `position` with these axes.
std::string placed(const glm::dvec3& x, const glm::dvec3& y, const glm::dvec3& z, const glm::dvec3& position,
                   const std::string& rest) {
  std::vector<double> values;
  for (const auto& [column, last] : {std::pair(x, 0.0), {y, 0.0}, {z, 0.0}, {position, 1.0}})
    values.insert(values.end(), {column.x, column.y, column.z, last});
  std::string text = "{\"matrix\":";
  append_json(text, std::span<const double>(values));
  return text + ',' + rest + '}';
}

std::string punctual(const Light& light, bool photometric) {
  const double largest = std::max({light.color.x, light.color.y, light.color.z}),
               scale = largest > 0.0 ? 1.0 / largest : 1.0;
  std::string text = "{\"type\":\"" + std::string(name_of(light.type)) + "\",\"color\":";
  const double color[] = {std::min(light.color.x * scale, 1.0), std::min(light.color.y * scale, 1.0),
                          std::min(light.color.z * scale, 1.0)};
  append_json(text, std::span<const double>(color));
  append_json(text += ",\"intensity\":", std::min(largest * photometric_intensity(light, photometric), 1e18));
  if (!is_directional(light.type) && std::isfinite(light.range) && light.range >= 1e-30f && light.range <= 1e18f)
    append_json(text += ",\"range\":", light.range);
  if (is_spot(light.type)) {
    constexpr double kLeast = 1e-3;
    const double outer = std::clamp(double(light.cone_rad) + double(light.penumbra_rad), kLeast, 0.5 * kPi);
    append_json(text += ",\"spot\":{\"innerConeAngle\":",
                std::clamp(double(light.cone_rad), 0.0, outer - 0.5 * kLeast));
    append_json(text += ",\"outerConeAngle\":", outer);
    text += '}';
  }
  return text + '}';
}

/// KHR_lights_punctual shines along -z.
std::string light_node(const Light& light, uint32_t index) {
  const std::string rest = "\"extensions\":{\"KHR_lights_punctual\":{\"light\":" + std::to_string(index) + "}}";
  const glm::dvec3 position = is_directional(light.type) ? glm::dvec3(0.0) : glm::dvec3(light.position);
  if (light.type == LightType::point) return placed({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, position, rest);
  const glm::dvec3 z = unit(-glm::dvec3(light.direction));
  const glm::dvec3 beside = std::fabs(z.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  const glm::dvec3 x = unit(cross(beside, z));
  return placed(x, cross(z, x), z, position, rest);
}

void write_lights(Writing& out) {
  std::string lights;
  uint32_t count = 0;
  for (const Light& light : out.scene.lights) {
    if (!row_of(light.type).in_gltf) continue;
    lights += (count == 0 ? "" : ",") + punctual(light, out.scene.photometric);
    out.glb.add("nodes", light_node(light, count++));
  }
  if (const size_t ours = out.scene.lights.size() - count; ours > 0)
    out.notes.push_back(std::to_string(ours) + (ours == 1 ? " light is" : " lights are") +
                        " for trueshade alone, because glTF has no ambient lights and none with an area");
  if (count == 0) return;
  out.glb.use("KHR_lights_punctual");
  out.lights_extension = "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[" + lights + "]}}";
}

void write_camera(Writing& out) {
  const Camera& camera = out.scene.camera;
  if (camera.clip_from_world) {
    out.notes.push_back("The camera is for trueshade alone, because glTF has none that is given by a matrix");
    return;
  }
  std::string text = R"({"type":"perspective","perspective":{"yfov":)";
  append_json(text, camera.fov_x_rad.value_or(camera.fov_y_rad));
  append_json(text += ",\"znear\":", camera.near);
  append_json(text += ",\"zfar\":", camera.far);
  const uint32_t index = out.glb.add("cameras", text + "}}");
  const Matrix4 view = view_from_world(camera);  // its rows are the axes
  const auto row = [&](size_t r) { return glm::dvec3(view[r], view[4 + r], view[8 + r]); };
  out.glb.add("nodes", placed(row(0), row(1), row(2), glm::dvec3(camera.eye), "\"camera\":" + std::to_string(index)));
}

}  // namespace

void write_lights_and_camera(Writing& out) {
  write_lights(out);
  write_camera(out);
}

}  // namespace trueshade::gltf
