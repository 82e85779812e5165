#include "scenes/files/gltf/reading.h"
#include "scenes/trig.h"

namespace trueshade::gltf {
namespace {

constexpr double kSmallest = 1e-30;  // of lengths that must be above 0

CameraSource read_camera(const json::Node& node) {
  constexpr std::string_view kTypes[] = {"perspective", "orthographic"};
  CameraSource camera;
  camera.name = string_or_empty(node, "name");
  camera.type = CameraSource::Type(known_or_other(node.member("type"), kTypes));
  const auto perspective = node.find("perspective"), orthographic = node.find("orthographic");
  if (perspective && orthographic) node.fail("a camera is perspective and orthographic", "one of them");
  if (camera.type == CameraSource::Type::perspective) {
    const json::Node p = node.member("perspective");
    number_or(p, "aspectRatio", 1.0, kSmallest, kLargest);
    camera.fov_y_rad = p.member("yfov").number(kSmallest, kLargest);
    camera.near = p.member("znear").number(kSmallest, kLargest);
    if (const auto far = p.find("zfar")) camera.far = far->number(kSmallest, kLargest);
    if (camera.far && !(*camera.far > camera.near)) p.fail("zfar is not above znear", "znear < zfar");
  }
  if (camera.type == CameraSource::Type::orthographic) {
    const json::Node o = node.member("orthographic");
    camera.x_mag = o.member("xmag").number(-kLargest, kLargest);
    camera.y_mag = o.member("ymag").number(-kLargest, kLargest);
    if (camera.x_mag == 0.0 || camera.y_mag == 0.0) o.fail("xmag or ymag is 0", "half the width and height seen");
    camera.near = o.member("znear").number(0.0, kLargest);
    camera.far = o.member("zfar").number(kSmallest, kLargest);
    if (!(*camera.far > camera.near)) o.fail("zfar is not above znear", "znear < zfar");
  }
  extensions_of(node);
  return camera;
}

void read_cone(const json::Node& spot, LightSource& light) {
  const double right = 0.5 * kPi + 1e-6;  // writers round pi / 2 up
  light.inner_rad = number_or(spot, "innerConeAngle", 0.0, 0.0, right);
  light.outer_rad = number_or(spot, "outerConeAngle", light.outer_rad, 0.0, right);
  if (!(light.inner_rad < light.outer_rad))
    spot.fail("innerConeAngle is not below outerConeAngle", "innerConeAngle < outerConeAngle");
}

LightSource read_light(const json::Node& node) {
  constexpr std::string_view kTypes[] = {"directional", "point", "spot"};
  constexpr LightType kKinds[] = {LightType::directional, LightType::point, LightType::spot};
  LightSource light;
  const size_t type = known_or_other(node.member("type"), kTypes);
  if (type < std::size(kTypes)) light.type = kKinds[type];
  if (const auto color = node.find("color")) light.color = color->vec3(0.0, kLargest);
  light.intensity = number_or(node, "intensity", 1.0, 0.0, kLargest);
  if (const auto range = node.find("range")) light.range = range->real(kSmallest, kLargest);
  if (light.type == LightType::spot) {
    const json::Node spot = node.member("spot");
    read_cone(spot, light);
  }
  return light;
}

}  // namespace

void read_lights_and_cameras(const json::Node& root, Document& document) {
  for_each(root, "cameras", [&](const json::Node& node, size_t) { document.cameras.push_back(read_camera(node)); });
  const auto extensions = extensions_of(root);
  const auto lights = extensions ? extensions->find("KHR_lights_punctual") : std::nullopt;
  if (lights)
    for_each(*lights, "lights", [&](const json::Node& node, size_t) { document.lights.push_back(read_light(node)); });
}

}  // namespace trueshade::gltf
