#include "cli/shared_frames.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "cli/activity.h"
#include "cli/notes.h"
#include "cli/option_values.h"
#include "cli/pictures.h"
#include "cli/terminal.h"
#include "cli/version.h"
#include "core/standard_input.h"
#include "core/threads/parallel_for.h"
#include "farm/task_sharing.h"
#include "scenes/pipeline/pipeline.h"

namespace trueshade {
namespace {

/// The cores of a machine are divided among its ranks. The side of tiles stays that of one process, because statistics
/// count tiles.
Execution shared_execution(const RenderOptions& options, const Ranks& ranks) {
  Execution execution = execution_of(options);
  if (execution.threads == 0) execution.threads = std::max(1, thread_count(0) / ranks.on_this_machine());
  return execution;
}

std::string outputs_text(const RenderOptions& options) {
  std::string text = joined(options.outputs);
  for (const auto& [name, is_on] : {std::pair{" --hash", options.hash},
                                    {" --stats", options.stats},
                                    {" --json", options.json},
                                    {" --raw-video", options.raw_video}})
    if (is_on) text += name;
  if (!options.aovs.empty()) text += " --aov " + joined(options.aovs);
  if (options.encode) text += " --encode " + std::to_string(int(*options.encode));
  if (!options.cube_map) return text;
  text += options.cube_map->cross ? " --cube-cross" : " --cube-map";
  if (const auto& eye = options.cube_map->eye)
    for (const float value : {eye->x, eye->y, eye->z}) text += ' ' + std::to_string(value);
  return text;
}

/// What two ranks must have in common for their frames to be parts of one film.
std::vector<std::pair<std::string, std::string>> identity_of(const RenderOptions& options, SceneToRender& of) {
  const FrameRange frames = *options.frames;
  std::vector<std::pair<std::string, std::string>> identity = {
      {"version", kVersion},
      {"commit", kCommit},
      {"frames", std::to_string(frames.first) + '-' + std::to_string(frames.last)},
      {"output", outputs_text(options)},
      {"pipeline", pipeline_json(of.pipeline)}};
  for (const auto& [name, frame] : {std::pair{"scene", frames.first}, {"scene at the last frame", frames.last}}) {
    set_time(of.scene, double(frame) / of.scene.timeline.fps);
    identity.emplace_back(name, scene_hash(of.scene));
    if (of.scene.timeline.empty()) break;
  }
  return identity;
}

}  // namespace

void render_shared_frames(const RenderOptions& options, Ranks& ranks, PictureSink& sink) {
  if (options.scene == kStandardInputName)
    throw usage("SCENE", "mpirun gives standard input to rank 0 alone", "name a file that every machine has");
  if (ranks.own() != 0) be_quiet();
  const int first = options.frames->first, count = options.frames->last - first + 1;
  Execution execution = shared_execution(options, ranks);
  std::optional<SceneToRender> of;
  std::optional<Pictures> pictures;
  std::optional<Activity> activity;
  const auto prepare = [&] {
    of.emplace(options, execution);
    if (execution.tile == 0)
      execution.tile = tile_for(of->pipeline.width, of->pipeline.height, options.execution.threads);
    pictures.emplace(options, of->scene, of->pipeline, execution);
    SharedTasks tasks;
    tasks.count = count;
    tasks.identity = identity_of(options, *of);
    tasks.run = [&pictures, first](int task, const Wanted& wanted) {
      PackedPictures packed;
      pictures->frame(first + task, packed, [&wanted] { wanted.check(); });
      return packed.bytes();
    };
    tasks.same_part = part_without_times;
    if (ranks.own() == 0) activity.emplace("rendering frames", Activity::Counts::by_hand);
    tasks.take = [&](int task, std::vector<uint8_t> result) {
      replay(result, sink);
      activity->show(task + 1, count, "frames");
    };
    return tasks;
  };
  const SharingReport report = share_tasks(ranks, options.sharing, prepare);
  activity.reset();
  for (const std::string& lost : report.lost) say_notes({lost + "; its frames were drawn by others"});
}

}  // namespace trueshade
