#include "view/saved_scene.h"

#include <cmath>
#include <filesystem>

#include "cli/looks.h"
#include "core/error.h"
#include "core/fp_env.h"
#include "core/standard_input.h"
#include "scenes/json/json_value.h"
#include "scenes/trig.h"

namespace trueshade::viewer {
namespace {

using json::number_text;

std::string text_of(const glm::vec3& v) {
  return '[' + number_text(double(v.x)) + ", " + number_text(double(v.y)) + ", " + number_text(double(v.z)) + ']';
}

std::string json_text_of(std::string_view text) {
  std::string out;
  json::append_string(out, text);
  return out;
}

std::string text_of(const Camera& camera) {
  if (camera.clip_from_world) {
    std::string text = "{\"eye\": " + text_of(camera.eye) + ", \"clip_from_world\": [";
    for (size_t i = 0; i < 16; ++i) text += (i == 0 ? "" : ", ") + number_text(double((*camera.clip_from_world)[i]));
    return text + "]}";
  }
  const bool horizontal = camera.fov_x_rad.has_value();
  return "{\"eye\": " + text_of(camera.eye) + ", \"target\": " + text_of(camera.target) +
         ", \"up\": " + text_of(camera.up) + ",\n             \"fov_deg\": " +
         number_text(degrees_read_as(horizontal ? *camera.fov_x_rad : camera.fov_y_rad)) +
         (horizontal ? ", \"fov_axis\": \"x\"" : "") + ", \"near\": " + number_text(double(camera.near)) +
         ", \"far\": " + number_text(double(camera.far)) + '}';
}

std::string text_of(const LightChange& change) {
  std::string text = "{\"light\": " + std::to_string(change.light);
  if (!change.on) text += ", \"on\": false";
  if (change.color) text += ", \"color\": " + text_of(*change.color);
  if (change.intensity) text += ", \"intensity\": " + number_text(*change.intensity);
  if (change.position) text += ", \"position\": " + text_of(*change.position);
  return text + '}';
}

/// A URI's path: what RFC 3986 gives no other meaning in one stays as it is.
std::string uri_of(const std::string& path) {
  constexpr std::string_view kKept = "-._~/!$&'()*+,;=@";
  std::string uri;
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    const bool kept = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || byte >= 0x80 ||
                      kKept.find(c) != std::string_view::npos;
    constexpr char kDigits[] = "0123456789ABCDEF";
    if (kept)
      uri += c;
    else
      uri += {'%', kDigits[byte >> 4], kDigits[byte & 15]};
  }
  return uri;
}

/// The scene that is referred to, by its way from the folder of the file that is written.
std::string way_to(const std::string& scene, const std::string& path) {
  if (scene.starts_with("builtin:")) return scene;
  if (scene == kStandardInputName)
    throw Error(ErrorKind::usage, path, "the scene came from standard input, which no scene file can refer to",
                "open the scene from a file");
  namespace fs = std::filesystem;
  const fs::path folder = fs::absolute(fs::path(path)).lexically_normal().parent_path();
  const std::string way = fs::absolute(fs::path(scene)).lexically_normal().lexically_relative(folder).string();
  if (way.empty() || way == ".." || way.starts_with("../"))
    throw Error(ErrorKind::usage, path, "a scene file refers to files in its folder or below, and " + scene + " is not",
                "save into the folder of " + scene + ", or above it");
  if (fs::absolute(fs::path(scene)).lexically_normal() == fs::absolute(fs::path(path)).lexically_normal())
    throw Error(ErrorKind::usage, path, "a scene file cannot refer to itself", "give the new one another name");
  return uri_of(way);
}

/// The camera of the file; empty where the camera of the scene that is referred to holds. `stands`: without motion.
std::string camera_text(const SceneFacts& facts, const DrawnPicture& picture, bool stands) {
  if (picture.state.camera) return text_of(picture.camera);
  if (facts.camera_text.empty()) return {};
  return stands ? text_of(picture.camera) : facts.camera_text;
}

}  // namespace

double degrees_read_as(float radians) {
  const FpScope fp;
  const auto read = [](double degrees) { return float(degrees * (kPi / 180.0)); };
  double degrees = double(radians) * (180.0 / kPi);
  for (double parts = 1.0; parts <= 1e6; parts *= 10.0) {  // 45, not 45.000001
    const double rounded = std::round(degrees * parts) / parts;
    if (read(rounded) == radians) return rounded;
  }
  while (read(degrees) < radians) degrees = std::nextafter(degrees, 1e9);
  while (read(degrees) > radians) degrees = std::nextafter(degrees, 0.0);
  return degrees;
}

std::string saved_scene(const SceneFacts& facts, const DrawnPicture& picture, const std::string& path) {
  const FpScope fp;
  const Looks looks = looks_of_text(facts.looks);
  if (looks.lights && *looks.lights != "keep")
    throw Error(ErrorKind::usage, path, "no scene file says the lights that --lights " + *looks.lights + " has made",
                "open the scene with --lights keep");
  const SceneReference known = facts.reference ? *facts.reference : SceneReference{facts.spec, {}, {}, false};
  const bool stands = picture.state.time != 0.0;
  std::string text = "{\n  \"version\": 1,\n  \"scene\": " + json_text_of(way_to(known.scene, path));
  if (known.time || stands) text += ",\n  \"time\": " + number_text(known.time ? *known.time : picture.state.time);
  if (const std::string camera = camera_text(facts, picture, stands); !camera.empty())
    text += ",\n  \"camera\": " + camera;
  if (!known.lights.empty()) text += ",\n  \"lights\": " + known.lights;
  std::string changes;
  for (const std::vector<LightChange>* list : {&known.changes, &picture.state.changes})
    for (const LightChange& change : *list) changes += (changes.empty() ? "\n    " : ",\n    ") + text_of(change);
  if (!changes.empty()) text += ",\n  \"light_changes\": [" + changes + "\n  ]";
  if (known.both_faces || looks.faces == "both") text += ",\n  \"faces\": \"both\"";
  if (facts.reference || !facts.looks.empty()) {
    text += ",\n  \"clear\": [";
    for (int c = 0; c < 4; ++c) text += (c == 0 ? "" : ", ") + number_text(double(facts.clear[c]));
    text += "],\n  \"fps\": " + number_text(facts.fps);
  }
  return text + ",\n  \"pipeline\": " + pipeline_json(picture.pipeline) + "\n}\n";
}

}  // namespace trueshade::viewer
