#include "scenes/files/scene_json.h"

#include "core/error.h"
#include "scenes/both_faces.h"
#include "scenes/files/light_json.h"
#include "scenes/files/object_json.h"
#include "scenes/files/reference_json.h"
#include "scenes/files/steps_json.h"
#include "scenes/pipeline/pipeline_json.h"
#include "scenes/pipeline/presets.h"
#include "scenes/scene_defaults.h"
#include "scenes/trig.h"

namespace trueshade {
namespace {

constexpr std::string_view kRootKeys[] = {"version", "camera", "clear",         "textures", "materials",
                                          "objects", "lights", "scene",         "pipeline", "fps",
                                          "$schema", "time",   "light_changes", "faces"};
constexpr std::string_view kCameraKeys[] = {"eye", "target",          "up",    "fov_deg",       "fov_axis", "near",
                                            "far", "clip_from_world", "steps", "interpolation", "repeat"};
constexpr std::string_view kMatrixCameraKeys[] = {"eye", "clip_from_world"};
constexpr std::string_view kCameraStepKeys[] = {"time", "eye", "target", "up", "fov_deg"};

enum : size_t { kScene, kCamera, kCameraStep };
constexpr json::ObjectKeys kSceneJsonKeys[] = {
    {"", kRootKeys}, {"camera", kCameraKeys}, {"camera_step", kCameraStepKeys}};

Camera matrix_camera(const json::Node& node, const json::Node& matrix) {
  Camera camera;
  node.check_keys({"camera", kMatrixCameraKeys});
  matrix.array(16, 16);
  camera.clip_from_world.emplace();
  for (size_t i = 0; i < 16; ++i)
    (*camera.clip_from_world)[i] = matrix.element(i).real(-json::kLargest, json::kLargest);
  camera.eye = node.member("eye").vec3(-json::kLargest, json::kLargest);
  return camera;
}

float real_or(const json::Node& node, std::string_view key, float absent, double least, double most) {
  const auto found = node.find(key);
  return found ? found->real(least, most) : absent;
}

void read_camera(const json::Node& node, Scene& scene) {
  node.check_keys(kSceneJsonKeys[kCamera]);
  if (const auto matrix = node.find("clip_from_world")) {
    scene.camera = matrix_camera(node, *matrix);
    return;
  }
  Camera& camera = scene.camera;
  const StepReader steps(node, kSceneJsonKeys[kCameraStep]);
  const auto take = [&](CameraProperty property, Said said) {
    if (said.value) set_property(camera, property, *said.value);
    if (said.track) scene.timeline.camera.push_back({property, std::move(*said.track)});
    return said.at_all();
  };
  const auto three = [&](std::string_view key) {
    return steps.said(key, numbers(key, 3, -json::kLargest, json::kLargest));
  };
  if (!take(CameraProperty::eye, three("eye"))) node.member("eye");  // fails
  take(CameraProperty::target, three("target"));
  take(CameraProperty::up, three("up"));
  constexpr std::string_view kAxes[] = {"y", "x"};
  const auto axis = node.find("fov_axis");
  const auto fov = axis && axis->choice(kAxes) == 1 ? CameraProperty::fov_x : CameraProperty::fov_y;
  if (!take(fov, steps.said("fov_deg", degrees("fov_deg", 0.001, 179.99))))
    set_property(camera, fov, glm::dvec4(45.0 * (kPi / 180.0)));
  camera.near = real_or(node, "near", camera.near, json::kSmallest, json::kLargest);
  camera.far = real_or(node, "far", camera.far, json::kSmallest, json::kLargest);
  if (!(camera.near < camera.far)) node.fail("near is not below far", "0 < near < far");
}

}  // namespace

std::span<const json::ObjectKeys> scene_object_keys() {
  static const std::vector<json::ObjectKeys> all = [] {
    std::vector<json::ObjectKeys> keys(std::begin(kSceneJsonKeys), std::end(kSceneJsonKeys));
    for (const json::ObjectKeys& object : object_json_keys()) keys.push_back(object);
    for (const json::ObjectKeys& light : light_json_keys()) keys.push_back(light);
    for (const json::ObjectKeys& change : reference_json_keys()) keys.push_back(change);
    return keys;
  }();
  return all;
}

Scene scene_from_json(std::string_view text, const std::string& path, const SceneLimits& limits,
                      const ImageDecoder& decode, const SceneLoader& load) {
  const json::Value value = json::parse(text, path);
  const json::Node root(value, path);
  root.check_keys(kSceneJsonKeys[kScene]);
  if (const auto schema = root.find("$schema")) schema->string();  // for editors
  root.member("version").integer(1, 1);
  const auto reference = reference_from_json(root, path, limits);
  const auto read_own_lights = [&](Scene& to) {
    if (const auto lights = root.find("lights")) read_lights(*lights, to, path, limits, decode);
  };
  Scene scene = reference ? scene_of_reference(*reference, root, load, read_own_lights) : Scene();
  scene.spec = path;
  scene.is_model = false;
  if (const auto pipeline = root.find("pipeline")) {
    pipeline_from_node(*pipeline,
                       presets().front().pipeline);  // bad values are refused here, where the place is known
    scene.pipeline_text = json::text_of(pipeline->value());
  }
  if (const auto fps = root.find("fps")) scene.timeline.fps = fps->number(0.001, 1e6);
  if (const auto clear = root.find("clear")) scene.clear = clear->color();
  if (!reference) {
    read_own_lights(scene);
    ObjectReader objects(scene, path, limits, decode);
    if (const auto textures = root.find("textures")) objects.read_textures(*textures);
    if (const auto materials = root.find("materials")) objects.read_materials(*materials);
    if (const auto list = root.find("objects")) objects.read_objects(*list);
    objects.finish();
  }
  if (lights_both_faces(root)) light_both_faces(scene);
  const auto camera = root.find("camera");
  if (camera) {
    scene.camera = Camera();
    scene.camera_of_ours = false;
    scene.cameras.clear();
    scene.timeline.camera.clear();
    scene.timeline.node_camera.reset();
    read_camera(*camera, scene);
  }
  set_time(scene, 0.0);
  if (!camera && !reference) add_camera_of_ours(scene);
  return scene;
}

}  // namespace trueshade
