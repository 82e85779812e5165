#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cli/options.h"
#include "cli/picture_sink.h"
#include "scenes/scene.h"
#include "shading/frame.h"

namespace trueshade {

/// Called now and then while a picture is drawn; what it throws ends the drawing.
using ProgressSeen = std::function<void()>;

/// The planes asked for, then those that a report shows and that are not among them.
std::vector<std::string> planes_to_render(const RenderOptions& options);

/// The pictures that `render` makes, one after the other, from one scene whose meshes are loaded and clustered once.
/// Borrows all.
class Pictures {
 public:
  /// `execution`: how they are drawn; documents tell of that of the options.
  Pictures(const RenderOptions& options, Scene& scene, const Pipeline& pipeline, const Execution& execution)
      : options_(options), scene_(scene), pipeline_(pipeline), execution_(execution) {}

  /// Makes the picture, or the cube map, of one time, seconds.
  void at_time(double time, const std::vector<std::string>& paths, PictureSink& sink, const ProgressSeen& seen = {});
  /// The same of a frame of the timeline; its number goes into the names of the outputs.
  void frame(int frame, PictureSink& sink, const ProgressSeen& seen = {});

 private:
  void cube_map(double time, const std::vector<std::string>& paths, PictureSink& sink, const ProgressSeen& seen);

  const RenderOptions& options_;
  Scene& scene_;
  const Pipeline& pipeline_;
  const Execution execution_;
  std::optional<PreparedScene> prepared_;  // from the first picture on
};

}  // namespace trueshade
