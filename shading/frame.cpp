#include "shading/frame.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <numeric>
#include <optional>

#include "core/error.h"
#include "core/fp_env.h"
#include "core/memory_cap.h"
#include "core/simd/simd_target.h"
#include "core/threads/clock.h"
#include "core/threads/parallel_for.h"
#include "raster/clusters/clusters.h"
#include "raster/view.h"
#include "scenes/pipeline/program_inputs.h"
#include "shading/draw_frame.h"
#include "shading/frame_plan.h"
#include "shading/frame_tables.h"
#include "shading/frame_tile.h"
#include "shading/gl_counts.h"
#include "shading/output/post_frame.h"
#include "shading/output/target.h"

namespace trueshade {
namespace {

// Tiles in the order they are started: dearest first, so that no thread is left alone with a dear one at the end.
std::vector<int> tile_order(const ClusterBins& bins, const Execution& execution) {
  std::vector<int> order(bins.first.size() - 1);
  std::iota(order.begin(), order.end(), 0);
  if (execution.shuffle_tiles) {
    uint64_t state = 0x9E3779B97F4A7C15ull;
    for (size_t i = order.size(); i > 1; --i) {
      state = state * 6364136223846793005ull + 1442695040888963407ull;
      std::swap(order[i - 1], order[size_t((state >> 33) % i)]);
    }
  } else {
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return bins.tile_list(a).size() > bins.tile_list(b).size(); });
  }
  return order;
}

// Refuses a frame before its pictures are allocated: with more than the cap the system would end the program.
void check_memory(const FramePlan& plan, const Pipeline& pipeline, std::span<const std::string> planes) {
  const uint64_t pixels = drawn_pixels(pipeline, plan.execution.region);
  uint64_t texel = uint64_t(info(pipeline.target).bytes_per_texel());
  for (const std::string& name : planes)
    texel += uint64_t(info(aov_format(name, plan.surface_planes)).bytes_per_texel());
  const uint64_t tiles = pixels / uint64_t(plan.execution.tile * plan.execution.tile) + 1;
  require_memory(pixels * texel + tiles * (sizeof(TileCounts) + 3 * sizeof(uint64_t)), "size",
                 "the image with its planes");
}

// Adds in tile order, so that the sums do not depend on scheduling.
void add_up(const std::vector<TileCounts>& tiles, FrameStats& stats) {
  for (const TileCounts& t : tiles) {
    stats.covered_pixels += t.covered;
    stats.transparent_fragments += t.transparent;
    stats.lit_pixel_lights += t.light.lit_pairs;
    stats.clusters_drawn += t.raster.clusters;
    stats.triangles_tested += t.raster.triangles;
    stats.fragments += t.raster.fragments;
    stats.tile_pixel_lights += t.light.tile_pairs;
    stats.evaluated_pixel_lights += t.light.evaluated_pairs;
    stats.lights_tested += t.light.tested;
    stats.gl.light_pixels += t.lit_geometry;
    stats.core_ms += t.ms;
  }
}

/// `start`: of the frame, now_ms().
void draw_tiles(const FrameWork& frame, double start, const Progress& progress) {
  const Execution& execution = frame.plan.execution;
  const std::vector<int> order = tile_order(frame.tables.bins, execution);
  std::vector<TileCounts> counts(order.size());
  std::atomic<int> done = 0;
  std::mutex reporting;
  parallel_for(int(order.size()), execution.threads, [&](int i) {
    const int tile = order[size_t(i)];
    TileCounts of_tile;  // counted by itself: tiles next to each other share cache lines of `counts`
    draw_tile(frame, tile, of_tile);
    counts[size_t(tile)] = of_tile;
    const int finished = ++done;
    if (finished == 1) frame.out.stats.first_tile_ms = now_ms() - start;
    if (!progress || finished % 16 != 0) return;
    if (const std::unique_lock lock(reporting, std::try_to_lock); lock) progress(finished, int(order.size()));
  });
  FrameStats& stats = frame.out.stats;
  add_up(counts, stats);
  stats.tile = execution.tile, stats.threads = thread_count(execution.threads);
  stats.tile_ms.reserve(order.size());
  for (const int tile : order) stats.tile_ms.push_back(counts[size_t(tile)].ms);
}

}  // namespace

PreparedScene::PreparedScene(const Scene& scene)
    : scene_(&scene), clusters_(std::make_unique<ClusteredScene>(cluster_scene(scene))) {}
PreparedScene::PreparedScene(const Scene& scene, std::unique_ptr<ClusteredScene> clusters)
    : scene_(&scene), clusters_(std::move(clusters)) {}
PreparedScene::~PreparedScene() = default;
void PreparedScene::update() { cluster_posed_meshes(*scene_, *clusters_); }
PreparedScene::PreparedScene(PreparedScene&&) noexcept = default;

namespace {

/// `given`: surfaces to be lit instead of the scene's; null: those are drawn.
Frame draw_surfaces(const PreparedScene& prepared, const Pipeline& asked_for, const Execution& asked,
                    std::span<const std::string> planes, bool lit, const GivenSurfaces* given,
                    const Progress& progress) {
  const FpScope fp;
  const Scene& scene = prepared.scene();
  const Pipeline pipeline =
      with_planes_of_program(given == nullptr ? without_idle_emission(scene, asked_for) : asked_for);
  const CapturedFields there = given == nullptr ? CapturedFields() : captured_fields(*given);
  const FramePlan plan = plan_frame(scene, pipeline, asked, planes, lit, there);
  if (given != nullptr && plan.program != nullptr)
    check_fields(*given, plan.program->reads(), plan.program->has_unlit(), pipeline);
  const int threads = plan.execution.threads;
  check_lights(scene.lights, pipeline);
  check_memory(plan, pipeline, planes);
  wake_threads(threads);
  const SimdScope simd(plan.execution.simd);
  const double start = now_ms();
  Frame frame;
  FrameStats& stats = frame.stats;
  std::optional<LoopTimes> log(std::in_place);
  const TablesLoan loan;
  FrameTables& tables = *loan;
  View view = make_view(scene, pipeline, threads, std::move(tables.transforms), plan.execution.region);
  make_tables(plan, prepared, pipeline, planes, view, tables, frame);
  const FrameWork work{plan,
                       prepared,
                       pipeline,
                       view,
                       tables,
                       light_volume_draws(scene.lights, pipeline, plan.execution, tables.lights, tables.clusters,
                                          *tables.meshes, tables.outlines, view),
                       LightPlanes(planes, scene, pipeline, plan.program.get(), *tables.meshes, view),
                       ViewDistance(scene, pipeline),
                       TransparentPass(scene, pipeline, plan.program.get(), plan.execution),
                       given,
                       frame};
  stats.before_tiles_ms = now_ms() - start;
  stats.loops_before_tiles = log->loops();
  log.reset();
  draw_tiles(work, start, progress);
  tables.transforms = std::move(view.instances);

  stats.pixels = drawn_pixels(pipeline, plan.execution.region);
  stats.lights = scene.lights.size();
  stats.pixel_lights = stats.covered_pixels * stats.lights;
  stats.triangles = scene.triangle_count();
  stats.gl = counted_as_gl(scene, asked_for, *tables.meshes, stats);
  stats.total_ms = now_ms() - start;
  return frame;
}

}  // namespace

Frame draw_frame(const PreparedScene& prepared, const Pipeline& pipeline, const Execution& execution,
                 std::span<const std::string> planes, bool lit, const Progress& progress) {
  return draw_surfaces(prepared, pipeline, execution, planes, lit, nullptr, progress);
}

Frame light_surfaces(const Scene& scene, const Pipeline& asked, const Execution& execution, const GivenSurfaces& given,
                     const Progress& progress) {
  validate(asked);
  validate(execution);
  if (!execution.region.whole())
    throw Error(ErrorKind::usage, "region", "given surfaces are lit as a whole", "leave the region out");
  Pipeline pipeline = asked;
  pipeline.transparency.mode = TransparencyMode::none;
  check_surfaces(given, pipeline);
  Scene lights = scene;
  lights.instances.clear();
  Frame frame = draw_surfaces(PreparedScene(lights), pipeline, execution, {}, true, &given, progress);
  if (pipeline.post.active()) frame.color = finished_image(scene, pipeline, execution, frame.color, given.depth);
  return frame;
}

}  // namespace trueshade
