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

  /// Loads the scene. The frames, or the bands of the first picture. Errors as SceneToRender has them.
  SharedTasks first_tasks();
  /// Whether there is another picture in bands than the first `done`; and its bands.
  bool goes_on(int done) const;
  SharedTasks band_tasks(int index);
  /// On rank 0: hands out a picture all of whose bands are taken. Of frames there is nothing left to do.
  void finish(int index);

  bool by_bands() const;  ///< known once there are tasks
  const Pipeline& pipeline() const { return of_->pipeline; }

 private:
  SharedTasks frame_tasks();
  int frames() const;
  std::optional<int> frame_at(int index) const;

  const RenderOptions& options_;
  const int for_ranks_;
  const bool leads_;
  PictureSink& sink_;
  Execution execution_;
  std::optional<SceneToRender> of_;
  std::optional<Pictures> pictures_;
  std::vector<std::pair<std::string, std::string>> identity_;
  std::optional<Activity> activity_;  // of rank 0
};

/// Called by every rank: shares a SharedRender. Errors as share_tasks() and SceneToRender have them; Error(usage): a
/// scene from standard input, which rank 0 alone can read.
void render_shared(const RenderOptions& options, Ranks& ranks, PictureSink& sink);

}  // namespace trueshade
