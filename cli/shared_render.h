#pragma once
// `render` by several processes.
#include "cli/options.h"
#include "cli/picture_sink.h"
#include "farm/ranks.h"
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

/// Called by every rank. Each loads the scene and draws what rank 0 gives it: frames of a sequence; bands of a picture,
/// or of each of a sequence of large ones. On rank 0 `sink` gets all of it in order. Errors as share_tasks() and
/// SceneToRender have them; Error(usage): a scene from standard input, which rank 0 alone can read.
void render_shared(const RenderOptions& options, Ranks& ranks, PictureSink& sink);

}  // namespace trueshade
