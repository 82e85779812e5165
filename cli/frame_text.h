#pragma once
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cli/notes.h"
#include "core/image_files/image_io.h"
#include "scenes/camera_changes.h"
#include "shading/frame.h"

namespace trueshade {

/// One frame and all it came from, for the texts and pages that tell of it.
struct RenderedFrame {
  const Scene& scene;
  Pipeline pipeline;
  Execution execution;
  double time;  ///< seconds, that the scene stands at
  Frame frame;
  std::string image_hash;           ///< 64 hex digits
  std::string scene_hash;           ///< 64 hex digits; empty where nobody asks
  std::vector<double> repeated_ms;  ///< the frame drawn again without planes, for a report's time per frame; ascending
  Notes notes{};
  std::string command{};                  ///< as it was given, for a report
  std::string explain_command{};          ///< that says all of a pixel {x},{y}; or empty
  std::vector<std::string> aov_hashes{};  ///< of each aov, 64 hex digits, where their images have no texels
  std::string cube_map{};                 ///< `X,Y,Z px`, place and face, or `X,Y,Z cross`; empty: the camera's picture
  std::string looks{};                    ///< looks_text() of what the scene was brought to
  SceneParts parts{};                     ///< that the scene was made with
  CameraChanges camera{};                 ///< that its camera was seen with
  double start_ms = 0.0;                  ///< of the frame, since the process was started
};

/// `sha256:<hex>  <WxH>  <format>` and a line feed.
std::string hash_line(const RenderedFrame& result);

/// What every image file carries: all that may change a pixel, and nothing else. Keys `trueshade:...`.
Metadata metadata_of(const RenderedFrame& result);

/// Counts and times of the frame with their names, in the order they are read in.
struct StatLine {
  std::string key;    ///< of JSON
  std::string label;  ///< for people
  std::string value;  ///< a JSON number
};
std::vector<StatLine> stat_lines(const RenderedFrame& result);

/// The stat lines as a table of text.
std::string stats_text(const RenderedFrame& result);

/// `--json`: one document of scene, pipeline, execution, stats, hash, aovs, files, ignored and
/// notes, and a line feed.
std::string json_of(const RenderedFrame& result, std::span<const std::string> files);

}  // namespace trueshade
