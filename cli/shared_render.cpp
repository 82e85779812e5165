#include "cli/shared_render.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "cli/notes.h"
#include "cli/option_values.h"
#include "cli/terminal.h"
#include "cli/version.h"
#include "core/file_ending.h"
#include "core/standard_input.h"
#include "core/threads/parallel_for.h"
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

/// What two ranks must have in common for what they draw to be parts of one work.
std::vector<std::pair<std::string, std::string>> identity_of(const RenderOptions& options, SceneToRender& of) {
  std::vector<std::pair<std::string, std::string>> identity = {{"version", kVersion}, {"commit", kCommit}};
  if (options.frames)
    identity.emplace_back("frames", std::to_string(options.frames->first) + '-' + std::to_string(options.frames->last));
  const PictureRegion& region = options.execution.region;
  identity.emplace_back("region", std::to_string(region.x) + ',' + std::to_string(region.y) + ',' +
                                      std::to_string(region.width) + 'x' + std::to_string(region.height));
  identity.emplace_back("output", outputs_text(options));
  identity.emplace_back("pipeline", pipeline_json(of.pipeline));
  const double first = options.frames ? double(options.frames->first) / of.scene.timeline.fps : options.time;
  const double last = options.frames ? double(options.frames->last) / of.scene.timeline.fps : options.time;
  for (const auto& [name, time] : {std::pair{"scene", first}, {"scene at the last frame", last}}) {
    set_time(of.scene, time);
    identity.emplace_back(name, scene_hash(of.scene));
    if (of.scene.timeline.empty() || first == last) break;
  }
  return identity;
}

/// Rows of a band, the same on every rank: as many as give each rank a few bands, and of large pictures some 16 million
/// pixels at most.
int shared_band_rows(const RenderOptions& options, const Pipeline& pipeline, int ranks) {
  constexpr int64_t kPixels = int64_t(1) << 24;
  constexpr int kBandsOfRank = 4, kLeast = 16;
  const PictureRegion drawn = drawn_region(pipeline, options.execution.region);
  const bool streamed = is_streamed(options, pipeline);
  int64_t rows = drawn.height / (kBandsOfRank * ranks);
  if (streamed) rows = std::min(rows, kPixels / drawn.width);
  const int unit = streamed ? kStripRows : kLeast;
  return int(std::max<int64_t>((rows + unit - 1) / unit, 1)) * unit;
}

std::vector<uint8_t> bytes_of(int number) {
  std::vector<uint8_t> bytes(sizeof number);
  std::memcpy(bytes.data(), &number, sizeof number);
  return bytes;
}
int number_of(std::span<const uint8_t> bytes) {
  int number = 0;
  if (bytes.size() == sizeof number) std::memcpy(&number, bytes.data(), sizeof number);
  return number;
}

}  // namespace

SharedRender::SharedRender(const RenderOptions& options, Ranks& ranks, PictureSink& sink, int for_ranks)
    : options_(options),
      for_ranks_(for_ranks > 0 ? for_ranks : ranks.count()),
      leads_(ranks.own() == 0),
      sink_(sink),
      execution_(shared_execution(options, ranks)) {}

SharedTasks SharedRender::first_tasks() {
  of_.emplace(options_, execution_);
  const Pipeline& pipeline = of_->pipeline;
  const PictureRegion drawn = drawn_region(pipeline, options_.execution.region);
  if (execution_.tile == 0) execution_.tile = tile_for(drawn.width, drawn.height, options_.execution.threads);
  pictures_.emplace(options_, of_->cached, pipeline, execution_);
  identity_ = identity_of(options_, *of_);
  if (leads_) activity_.emplace("rendering", Activity::Counts::by_hand);
  return by_bands() ? band_tasks(0) : frame_tasks();
}

SharedTasks SharedRender::band_tasks(int index) {
  BandedPicture& picture = pictures_->in_bands(frame_at(index), shared_band_rows(options_, of_->pipeline, for_ranks_));
  if (leads_) picture.begin();
  SharedTasks tasks;
  tasks.count = picture.bands();
  tasks.identity = identity_;
  tasks.brief = [rows = picture.rows_done()](int) { return bytes_of(rows); };
  tasks.run = [&picture](int band, std::span<const uint8_t> rows_done, const Wanted& wanted) {
    wanted.check();
    picture.set_rows_done(number_of(rows_done));
    return picture.bytes_of(picture.draw(band));
  };
  tasks.same_part = [](std::span<const uint8_t> band) { return part_of_band_without_times(band); };
  tasks.take = [this, &picture](int band, std::vector<uint8_t> bytes) {
    picture.take(picture.band_of(band, std::move(bytes)));
    activity_->show(band + 1, picture.bands(), "bands");
  };
  return tasks;
}

SharedTasks SharedRender::frame_tasks() {
  SharedTasks tasks;
  tasks.count = frames();
  tasks.identity = identity_;
  tasks.run = [this](int task, std::span<const uint8_t>, const Wanted& wanted) {
    PackedPictures packed;
    pictures_->picture(frame_at(task), packed, [&wanted] { wanted.check(); });
    return packed.bytes();
  };
  tasks.same_part = part_without_times;
  tasks.take = [this](int task, const std::vector<uint8_t>& result) {
    replay(result, sink_);
    activity_->show(task + 1, frames(), "frames");
  };
  return tasks;
}

bool SharedRender::goes_on(int done) const { return by_bands() && options_.frames && done < frames(); }

void SharedRender::finish(int index) {
  if (leads_ && by_bands()) pictures_->hand_out_bands(frame_at(index), sink_);
}

int SharedRender::frames() const { return options_.frames->last - options_.frames->first + 1; }

std::optional<int> SharedRender::frame_at(int index) const {
  return options_.frames ? std::optional(options_.frames->first + index) : std::nullopt;
}

bool SharedRender::by_bands() const { return !options_.frames || is_streamed(options_, of_->pipeline); }

bool is_shared(const RenderOptions& options) {
  if (options.frames) return true;
  return !options.cube_map && !options.raw_video &&
         std::none_of(options.outputs.begin(), options.outputs.end(),
                      [](const std::string& path) { return has_ending(path, ".html"); });
}

void render_shared(const RenderOptions& options, Ranks& ranks, PictureSink& sink) {
  if (options.scene == kStandardInputName)
    throw usage("SCENE", "mpirun gives standard input to rank 0 alone", "name a file that every machine has");
  if (ranks.own() != 0) be_quiet();
  std::vector<std::string> lost;
  SharedRender render(options, ranks, sink);
  SharingReport report = share_tasks(ranks, options.sharing, [&render] { return render.first_tasks(); });
  for (int done = 1;; ++done) {
    lost.insert(lost.end(), report.lost.begin(), report.lost.end());
    render.finish(done - 1);
    if (!render.goes_on(done)) break;
    report = share_tasks(ranks, options.sharing, [&] { return render.band_tasks(done); });
  }
  for (const std::string& rank : lost) say_notes({rank + "; its work was done by others"});
}

}  // namespace trueshade
