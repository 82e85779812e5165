#pragma once
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/image_files/image_io.h"
#include "scenes/scene.h"
#include "tests/catch.hpp"
#include "tests/cli/engine_capture.h"
#include "tests/cli/run_command.h"
#include "tests/scratch_folder.h"

// A frame of ours as the capture of an engine, and how engines pack it.
namespace trueshade {

// A camera that looks askew, so that no space is another's; a background; edges, round and flat surfaces.
inline constexpr const char* kScene = "s.json";
inline constexpr const char* kSceneText = R"({
  "version": 1,
  "camera": {"eye": [3, 2.5, 5], "target": [0.2, 0.5, 0], "fov_deg": 45, "near": 0.1, "far": 50},
  "clear": [0.02, 0.02, 0.03, 1],
  "objects": [
    {"mesh": "sphere", "color": [0.9, 0.7, 0.4], "position": [0, 1, 0], "scale": 1.2},
    {"mesh": "cube", "color": [0.4, 0.6, 0.9], "position": [1.6, 0.6, -1.5], "rotation_deg": [20, 30, 0], "scale": 1.5},
    {"mesh": "plane", "color": [0.5, 0.5, 0.52], "scale": 14}
  ],
  "lights": [
    {"type": "ambient", "color": [0.05, 0.05, 0.07]},
    {"type": "point", "position": [2, 3, 3], "color": [1, 0.9, 0.8], "range": 9},
    {"type": "ring", "count": 8, "center": [0, 0.4, 0], "radius": 1.8, "range": 2.5,
     "colors": [[1, 0.2, 0.1], [0.1, 0.4, 1]], "intensity": 0.6}
  ]
})";

/// A frame of ours as c.exr and its planes as an engine holds them.
struct DrawnCapture {
  ScratchFolder folder;
  EnginePlane color, depth, position, normal, albedo, object;

  DrawnCapture() {
    folder.write(kScene, kSceneText);
    const Outcome drawn = run_command({"render", kScene, "--size", "120x90", "-o", "c.exr", "-o", "c.png", "--aov",
                                       "depth,position,normal,albedo,id.object"},
                                      folder.path(""));
    REQUIRE(drawn.exit_code == 0);
    for (const NamedImage& plane : read_planes(folder.path("c.exr"))) {
      if (plane.name == "color") color = engine_plane(plane.image);
      if (plane.name == "depth") depth = engine_plane(plane.image);
      if (plane.name == "position") position = engine_plane(plane.image);
      if (plane.name == "normal") normal = engine_plane(plane.image);
      if (plane.name == "albedo") albedo = engine_plane(plane.image);
      if (plane.name == "id.object") object = engine_plane(plane.image);
    }
  }

  bool covered(int x, int y) const { return object.at(x, y, 0) != 0; }
  std::string path(const std::string& name) const { return folder.path(name); }

  Outcome judge(Arguments options) const {
    Arguments words = {"validate", kScene, "--quick", "--json"};
    words.insert(words.end(), options.begin(), options.end());
    return run_command(words, folder.path(""));
  }

  /// Classes of pixels by stage.
  nlohmann::json counts(const Arguments& options) const {
    const Outcome outcome = judge(options);
    INFO(outcome.err);
    REQUIRE((outcome.exit_code == 0 || outcome.exit_code == 1));
    const auto document = nlohmann::json::parse(outcome.out);
    nlohmann::json result;
    for (const auto& stage : document["verdict"]["stages"]) result[stage["stage"].get<std::string>()] = stage["counts"];
    return result;
  }
};

inline uint64_t violations(const nlohmann::json& counts) {
  uint64_t sum = 0;
  for (const auto& stage : counts) sum += stage["VIOLATION"].get<uint64_t>();
  return sum;
}

struct Axes {
  double right[3], up[3], back[3], eye[3];
};

inline Axes axes_of(const DrawnCapture& c) {
  const Camera camera = load_scene(c.path(kScene)).camera;
  Axes a{};
  double f[3], length = 0, s[3], s_length = 0;
  for (int k = 0; k < 3; ++k) {
    a.eye[k] = double(camera.eye[k]);
    f[k] = double(camera.target[k]) - a.eye[k];
    length += f[k] * f[k];
  }
  for (double& x : f) x /= std::sqrt(length);
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    s[k] = f[i] * double(camera.up[j]) - f[j] * double(camera.up[i]);
    s_length += s[k] * s[k];
  }
  for (int k = 0; k < 3; ++k) a.right[k] = s[k] / std::sqrt(s_length), a.back[k] = -f[k];
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    a.up[k] = a.right[i] * f[j] - a.right[j] * f[i];
  }
  return a;
}

inline double along(const double axis[3], const double* v) { return axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2]; }

/// Directions in the view's axes, z towards the viewer.
inline void to_view(const Axes& a, const double* v, double* out) {
  out[0] = along(a.right, v), out[1] = along(a.up, v), out[2] = along(a.back, v);
}

inline void octahedral(const double* n, double* e) {
  const double sum = std::fabs(n[0]) + std::fabs(n[1]) + std::fabs(n[2]);
  if (sum == 0) return;
  e[0] = n[0] / sum, e[1] = n[1] / sum;
  if (n[2] >= 0) return;
  const double x = e[0];
  e[0] = (1 - std::fabs(e[1])) * (x >= 0 ? 1 : -1);
  e[1] = (1 - std::fabs(x)) * (e[1] >= 0 ? 1 : -1);
}

inline void spheremap(const double* n, double* e) {
  const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  if (length == 0) return;
  const double f = std::sqrt(8 * n[2] / length + 8);
  e[0] = n[0] / length / f + 0.5, e[1] = n[1] / length / f + 0.5;
}

}  // namespace trueshade
