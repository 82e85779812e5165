#pragma once
// `render` by several processes.
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/activity.h"
#include "cli/options.h"
#include "cli/picture_sink.h"
#include "cli/pictures.h"
#include "farm/ranks.h"
#include "farm/task_sharing.h"
#include "scene_cache/cached_scene.h"
#include "scenes/scene.h"

namespace trueshade {

/// A scene that was loaded and checked, as `render` draws it. The constructor throws Error for all that it may lack.
struct SceneToRender {
  SceneToRender(const RenderOptions& options, const Execution& execution);
  SceneToRender(const SceneToRender&) = delete;
  SceneToRender& operator=(const SceneToRender&) = delete;
  CachedScene cached;
  Scene& scene;  ///< that of `cached`
  RenderOptions options;  ///< as they were given, but that no looks are left to choose
  Pipeline pipeline;
};

/// Whether several processes that MPI has started share the work of a command. Rank 0 alone carries out any other.
bool is_shared(const Command& command);
/// Of render: frames of a sequence, and bands of one picture. A report, a cube map and a video of one picture are not.
bool is_shared(const RenderOptions& options);

/// `render` as tasks of share_tasks(): frames of a sequence; bands of a picture, or of each of a sequence of large
/// ones. On rank 0 `sink` gets all of it in order. Borrows all.
class SharedRender {
 public:
  /// `for_ranks`: how many the bands are made for; 0: all.
  SharedRender(const RenderOptions& options, Ranks& ranks, PictureSink& sink, int for_ranks = 0);

  /// For share_tasks(), round after round until SharedTasks::is_last: the frames; or of each picture in bands what is
  /// measured of the whole picture, if anything is, then the bands. Loads the scene first. Errors as SceneToRender has
  /// them.
  SharedTasks next_tasks();
  void end_round();  ///< after share_tasks(): on rank 0 hands out a picture whose bands are all taken

  bool by_bands() const;  ///< known once there are tasks
  /// Rows of a band where so many ranks share the picture: a few bands for each, at most 16 million pixels of a large
  /// picture; the same on every rank.
  int band_rows(int ranks) const;
  const Pipeline& pipeline() const { return of_->pipeline; }

 private:
  void load();
  SharedTasks frame_tasks();
  SharedTasks measuring_tasks();
  SharedTasks band_tasks();
  int pictures() const;
  std::optional<int> frame() const;  ///< that is in bands now

  const RenderOptions& options_;
  const int for_ranks_;
  const bool leads_;
  PictureSink& sink_;
  Execution execution_;
  std::optional<SceneToRender> of_;
  std::optional<Pictures> pictures_;
  std::vector<std::pair<std::string, std::string>> identity_;
  std::optional<PictureMeasurement> measurement_;  // while a round measures
  std::optional<PictureConstants> constants_;      // of the picture at hand, once it is measured; known to rank 0
  int done_ = 0;                                   // pictures in bands, or 1 once the frames are done
  std::optional<Activity> activity_;               // of rank 0
};

/// Called by every rank: shares a SharedRender. Errors as share_tasks() and SceneToRender have them; Error(usage): a
/// scene from standard input, which rank 0 alone can read.
void render_shared(const RenderOptions& options, Ranks& ranks, PictureSink& sink);

}  // namespace trueshade
