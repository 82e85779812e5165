#include "cli/shared_render.h"

#include <algorithm>
#include <utility>

#include "cli/camera_json.h"
#include "cli/looks.h"
#include "cli/notes.h"
#include "cli/option_values.h"
#include "cli/terminal.h"
#include "cli/version.h"
#include "core/byte_stream.h"
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
  text += looks_text(options.looks);
  text += camera_words(options.parts, options.camera);
  if (!options.cube_map) return text;
  text += options.cube_cross ? " --cube-cross" : " --cube-map";
  if (const auto& eye = options.cube_map->eye)
    for (const float value : {eye->x, eye->y, eye->z}) text += ' ' + std::to_string(value);
  return text;
}

/// What two ranks must have in common for what they draw to be parts of one work.
std::vector<std::pair<std::string, std::string>> identity_of(const RenderOptions& options, SceneToRender& of) {
  std::vector<std::pair<std::string, std::string>> identity = {{"version", kVersion}, {"commit", kCommit}};
  if (options.frames)
    identity.emplace_back("frames", std::to_string(options.frames->first) + '-' + std::to_string(options.frames->last));
  if (options.turntable) identity.emplace_back("turntable", std::to_string(*options.turntable));
  const PictureRegion& region = options.execution.region;
  identity.emplace_back("region", std::to_string(region.x) + ',' + std::to_string(region.y) + ',' +
                                      std::to_string(region.width) + 'x' + std::to_string(region.height));
  identity.emplace_back("output", outputs_text(options));
  identity.emplace_back("pipeline", pipeline_json(of.pipeline));
  const double first = options.frames ? double(options.frames->first) / of.scene.timeline.fps : options.seconds();
  const double last = options.frames ? double(options.frames->last) / of.scene.timeline.fps : options.seconds();
  for (const auto& [name, time] : {std::pair{"scene", first}, {"scene at the last frame", last}}) {
    set_time(of.scene, time);
    identity.emplace_back(name, scene_hash(of.scene));
    if (of.scene.timeline.empty() || first == last) break;
  }
  return identity;
}

/// What rank 0 tells of a picture with each of its bands.
struct BandBrief {
  int rows_done;
  PictureConstants constants;
};

template <class Stream, class Extents>
void for_each_extent(Stream& stream, Extents& extents) {
  for (auto& extent : extents) stream(extent.least), stream(extent.most);
}

std::vector<uint8_t> bytes_of(const BandBrief& brief) {
  ByteWriter out;
  out.number(brief.rows_done);
  out.number(brief.constants.view_scale);
  out.number(brief.constants.logarithmic_mean);
  const auto write = [&out](double value) { out.number(value); };
  for_each_extent(write, brief.constants.extents);
  return out.take();
}

BandBrief band_brief_of(std::span<const uint8_t> bytes) {
  ByteReader in(bytes);
  BandBrief brief{in.number<int>(), {}};
  brief.constants.view_scale = in.number<uint32_t>();
  brief.constants.logarithmic_mean = in.number<double>();
  const auto read = [&in](double& value) { value = in.number<double>(); };
  for_each_extent(read, brief.constants.extents);
  return brief;
}

std::vector<uint8_t> bytes_of(const MeasuredRows& rows) {
  ByteWriter out;
  out.number(uint64_t(rows.logarithms.size()));
  for (const double row : rows.logarithms) out.number(row);
  out.number(rows.view_scale);
  const auto write = [&out](double value) { out.number(value); };
  for_each_extent(write, rows.extents);
  return out.take();
}

MeasuredRows measured_rows_of(std::span<const uint8_t> bytes) {
  ByteReader in(bytes);
  MeasuredRows rows;
  rows.logarithms.resize(in.count(sizeof(double)));
  for (double& row : rows.logarithms) row = in.number<double>();
  rows.view_scale = in.number<uint32_t>();
  const auto read = [&in](double& value) { value = in.number<double>(); };
  for_each_extent(read, rows.extents);
  return rows;
}

}  // namespace

SharedRender::SharedRender(const RenderOptions& options, Ranks& ranks, PictureSink& sink, int for_ranks)
    : options_(options),
      for_ranks_(for_ranks > 0 ? for_ranks : ranks.count()),
      leads_(ranks.own() == 0),
      sink_(sink),
      execution_(shared_execution(options, ranks)) {}

void SharedRender::load() {
  of_.emplace(options_, execution_);
  const Pipeline& pipeline = of_->pipeline;
  const PictureRegion drawn = drawn_region(pipeline, options_.execution.region);
  if (execution_.tile == 0) execution_.tile = tile_for(drawn.width, drawn.height, options_.execution.threads);
  pictures_.emplace(of_->options, of_->cached, pipeline, execution_);
  identity_ = identity_of(of_->options, *of_);
  if (leads_) activity_.emplace("rendering", Activity::Counts::by_hand);
}

SharedTasks SharedRender::next_tasks() {
  if (!of_) load();
  if (!by_bands()) return frame_tasks();
  return has_constants(of_->pipeline) && !constants_ ? measuring_tasks() : band_tasks();
}

SharedTasks SharedRender::frame_tasks() {
  SharedTasks tasks;
  const FrameRange frames = *options_.numbered();
  tasks.count = frames.last - frames.first + 1;
  tasks.identity = identity_;
  tasks.run = [this, frames](int task, std::span<const uint8_t>, const Wanted& wanted) {
    PackedPictures packed;
    pictures_->picture(frames.first + task, packed, [&wanted] { wanted.check(); });
    return packed.bytes();
  };
  tasks.same_part = part_without_times;
  tasks.take = [this, count = tasks.count](int task, const std::vector<uint8_t>& result) {
    replay(result, sink_);
    activity_->show(task + 1, count, "frames");
  };
  return tasks;
}

SharedTasks SharedRender::measuring_tasks() {
  PictureMeasurement& measurement = measurement_.emplace(pictures_->measurement(frame()));
  SharedTasks tasks;
  tasks.count = measurement.parts();
  tasks.is_last = false;
  tasks.identity = identity_;
  tasks.run = [this, &measurement](int part, std::span<const uint8_t>, const Wanted& wanted) {
    wanted.check();
    return bytes_of(measurement.measure(part, execution_));
  };
  tasks.take = [this, &measurement](int part, const std::vector<uint8_t>& bytes) {
    measurement.add(measured_rows_of(bytes));
    activity_->show(part + 1, measurement.parts(), "parts measured");
  };
  return tasks;
}

SharedTasks SharedRender::band_tasks() {
  BandedPicture& picture = pictures_->in_bands(frame(), band_rows(for_ranks_));
  if (constants_) picture.set_constants(*constants_);
  if (leads_) picture.begin();
  SharedTasks tasks;
  tasks.count = picture.bands();
  tasks.is_last = done_ + 1 == pictures();
  tasks.identity = identity_;
  tasks.brief = [told = bytes_of(BandBrief{picture.rows_done(), constants_.value_or(PictureConstants())})](int) {
    return told;
  };
  tasks.run = [&picture](int band, std::span<const uint8_t> told, const Wanted& wanted) {
    wanted.check();
    const BandBrief brief = band_brief_of(told);
    picture.set_rows_done(brief.rows_done);
    picture.set_constants(brief.constants);
    return picture.bytes_of(picture.draw(band));
  };
  tasks.same_part = [](std::span<const uint8_t> band) { return part_of_band_without_times(band); };
  tasks.take = [this, &picture](int band, std::vector<uint8_t> bytes) {
    picture.take(picture.band_of(band, std::move(bytes)));
    activity_->show(band + 1, picture.bands(), "bands");
  };
  return tasks;
}

void SharedRender::end_round() {
  if (!of_) return;  // nothing was loaded, which rank 0 knows
  if (measurement_) {
    constants_ = leads_ ? measurement_->constants() : PictureConstants();  // others are told with their bands
    measurement_.reset();
    return;
  }
  if (by_bands() && leads_) pictures_->hand_out_bands(frame(), sink_);
  constants_.reset();
  ++done_;
}

/// That are made one after the other; the frames of a sequence are one round.
int SharedRender::pictures() const {
  const auto frames = options_.numbered();
  return frames && by_bands() ? frames->last - frames->first + 1 : 1;
}

std::optional<int> SharedRender::frame() const {
  const auto frames = options_.numbered();
  return frames ? std::optional(frames->first + done_) : std::nullopt;
}

int SharedRender::band_rows(int ranks) const {
  constexpr int64_t kPixels = int64_t(1) << 24;
  constexpr int kBandsOfRank = 4, kLeast = 16;
  const Pipeline& pipeline = of_->pipeline;
  const PictureRegion drawn = drawn_region(pipeline, options_.execution.region);
  const bool streamed = is_streamed(options_, pipeline);
  int64_t rows = drawn.height / (kBandsOfRank * ranks);
  if (streamed) rows = std::min(rows, kPixels / drawn.width);
  const int unit = streamed ? kStripRows : kLeast;
  return int(std::max<int64_t>((rows + unit - 1) / unit, 1)) * unit;
}

bool SharedRender::by_bands() const { return !options_.numbered() || is_streamed(options_, of_->pipeline); }

bool is_shared(const RenderOptions& options) {
  if (options.numbered()) return true;
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
  bool goes_on = true;
  while (goes_on) {
    const SharingReport report = share_tasks(ranks, options.sharing, [&render] { return render.next_tasks(); });
    lost.insert(lost.end(), report.lost.begin(), report.lost.end());
    goes_on = report.goes_on;
    render.end_round();
  }
  for (const std::string& rank : lost) say_notes({rank + "; its work was done by others"});
}

}  // namespace trueshade
