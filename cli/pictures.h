#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cli/banded_picture.h"
#include "cli/options.h"
#include "cli/picture_sink.h"
#include "raster/clusters/clusters.h"
#include "scene_cache/cached_scene.h"
#include "scenes/scene.h"
#include "shading/frame.h"
#include "shading/picture_region.h"

namespace trueshade {

/// Called now and then while a picture is drawn; what it throws ends the drawing.
using ProgressSeen = std::function<void()>;

/// The planes asked for, then those that a report shows and that are not among them.
std::vector<std::string> planes_to_render(const RenderOptions& options);

/// The pictures that `render` makes, one after the other, from one scene whose meshes are loaded and clustered once.
/// Borrows all.
class Pictures {
 public:
  /// `execution`: how the pictures are drawn. The JSON documents state the execution of the options instead.
  /// The scene is as it was loaded.
  Pictures(const RenderOptions& options, CachedScene& cached, const Pipeline& pipeline, const Execution& execution);

  /// Makes the picture, or the cube map, of a frame of the timeline or of a turntable, whose number goes into the names
  /// of the outputs; or with nothing that of the options' time.
  void picture(std::optional<int> frame, PictureSink& sink, const ProgressSeen& seen = {});

  /// The outputs of a frame, or with nothing those of the picture that there is.
  std::vector<std::string> outputs_of(std::optional<int> frame) const;
  /// Seconds.
  double time_of(std::optional<int> frame) const;
  /// Of a picture that has_constants(), the scene brought to its time, before in_bands().
  PictureMeasurement measurement(std::optional<int> frame);
  /// A picture that is not drawn yet, the scene brought to its time. `band_rows`: as BandedPicture has it. It lives
  /// until the next call. Where has_constants() it wants to be told them.
  BandedPicture& in_bands(std::optional<int> frame, int band_rows);
  /// Hands out that picture, all of whose bands are taken.
  void hand_out_bands(std::optional<int> frame, PictureSink& sink);

 private:
  /// How a picture is seen, and the camera that this makes.
  struct Seen {
    CameraChanges changes;
    ChangedCamera camera;
  };

  const Seen& seen_of(std::optional<int> frame) const { return seen_[options_.turntable ? size_t(*frame) : 0]; }
  void go_to(std::optional<int> frame);
  RenderedFrame result_of(std::optional<int> frame) const;
  void cube_map(std::optional<int> frame, PictureSink& sink, const ProgressSeen& seen);

  const RenderOptions& options_;
  Scene& scene_;
  const Pipeline& pipeline_;
  const Execution execution_;
  std::vector<Seen> seen_;                 // one, or one a picture of a turntable
  std::optional<PreparedScene> prepared_;  // from the first picture on, or with the clusters of a cache file
  std::optional<BandedPicture> banded_;
};

}  // namespace trueshade
