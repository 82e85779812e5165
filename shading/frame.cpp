#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <numeric>
#include <optional>

#include "core/error.h"
#include "core/fp_env.h"
#include "core/threads/parallel_for.h"
#include "raster/clusters/cluster_bins.h"
#include "raster/clusters/clusters.h"
#include "raster/visibility/overdraw.h"
#include "core/simd/simd_target.h"
#include "raster/surfaces/surfaces.h"
#include "raster/view.h"
#include "raster/visibility/visibility.h"
#include "shading/blend/blend_pass.h"
#include "shading/blend/clear_color.h"
#include "shading/draw_frame.h"
#include "shading/gl_counts.h"
#include "shading/light/lists/light_clusters.h"
#include "shading/light/light_pass.h"
#include "shading/output/light_planes.h"
#include "shading/light/light_table.h"
#include "shading/output/target.h"
#include "shading/output/texels.h"
#include "shading/blend/transparent_blend.h"
#include "shading/blend/transparent_pass.h"
#include "shading/output/view_distance.h"

namespace trueshade {
namespace {

double now_ms() {
  using namespace std::chrono;
  return duration<double, std::milli>(steady_clock::now().time_since_epoch()).count();
}

// Scratch of one thread: about 0.8 MB, kept for the thread's life so that no frame allocates it.
struct TileScratch {
  VisibilityTile visible;
  SurfaceTile surface;
  ColorTile color, extra;  // extra: of planes beside the picture
  VisibleVertices vertices;
  LightLists lights;
  BlendWork blend;
  TiedFragments tied;
  std::unique_ptr<TransparentWork> transparent;  // of scenes that need it
};

TileScratch& thread_scratch() {
  thread_local std::unique_ptr<TileScratch> scratch = std::make_unique<TileScratch>();
  return *scratch;
}

// What a frame fills before its tiles, in memory that stays touched: pages are dear.
struct FrameTables {
  std::vector<InstanceTransform> transforms;  ///< of the view
  ClusterBins bins;
  LightTable lights;
  PlainLights plain;
  LightGroups groups;
  std::optional<LightMeshes> meshes;
  LightOutlines outlines;
  OutlineTasks outline_tasks;
};

// Tables that a frame has for its time, kept for the thread's next one.
struct TablesLoan {
  std::unique_ptr<FrameTables> tables;

  TablesLoan() : tables(std::move(kept())) {
    if (!tables) tables = std::make_unique<FrameTables>();
  }
  ~TablesLoan() { kept() = std::move(tables); }
  TablesLoan(const TablesLoan&) = delete;
  TablesLoan& operator=(const TablesLoan&) = delete;

 private:
  static std::unique_ptr<FrameTables>& kept() {
    thread_local std::unique_ptr<FrameTables> tables;
    return tables;
  }
};

struct TileCounts {
  RasterCounts raster;
  LightCounts light;
  uint64_t covered = 0, transparent = 0;
  uint64_t lit_geometry = 0;  ///< P of the counters
  StageTimes ms;
};

// What every tile of a frame shares.
struct FrameWork {
  const PreparedScene& prepared;
  const Pipeline& pipeline;
  const Execution& execution;
  const View& view;
  const ClusterBins& bins;
  const LightTable& lights;
  const PlainLights& plain;  ///< of strategies that sum, where bounds may settle them
  const LightGroups& groups;
  const LightMeshes& meshes;
  const LightOutlines& outlines;  ///< of strategies that blend
  bool need_uv, lit;
  const LightPlanes light_planes;
  const ViewDistance view_distance;
  const TransparentPass transparent;
  Frame& out;

  LightDraws light_draws() const {
    LightDraws out = draws_of(prepared.scene().lights, pipeline, lights, groups, meshes, outlines, view);
    out.culling = execution.light_culling;
    out.compiled = execution.compiled_models;
    out.settles = execution.settled_sums;
    return out;
  }

  TileRect rect(int tile) const { return tile_rect(view.window, execution.tile, bins.tiles_x, tile); }

  // Sums that go into fixed point as they are.
  LightShortcuts light_shortcuts() const {
    const bool codes = info(pipeline.target).number_class == NumberClass::unorm && !draws_unlike_clears(target());
    return {execution.light_culling, execution.compiled_models, codes ? &plain : nullptr, pipeline.target};
  }

  BlendTarget target() const { return {pipeline.target, pipeline.profile, pipeline.gbuffer.half_round}; }

  // Scratch for the transparent surfaces; null where there are none.
  TransparentWork* transparent_work(TileScratch& s) const {
    if (transparent.active() && s.transparent == nullptr) s.transparent = std::make_unique<TransparentWork>();
    return transparent.active() ? s.transparent.get() : nullptr;
  }

  /// Whether a tile's colours are in the target's stored form once its lights are in.
  bool encodes(const TransparentWork* glass) const {
    return blends_lights(pipeline.strategy) || draws_unlike_clears(target()) ||
           (glass != nullptr && transparent.after_lights());
  }

  /// Lights, and what is transparent after them.
  void light(const TileDraws& all, const TileRect& where, bool tied, TransparentWork* glass, TileScratch& s,
             TileCounts& counts) const {
    const glm::vec4 clear_color = drawn_clear(prepared.scene().clear, target());
    const float* const clear = &clear_color[0];
    if (blends_lights(pipeline.strategy)) {
      blend_tile(light_draws(), s.surface, tied ? &s.tied : nullptr, where, clear, s.blend, s.color, counts.light);
    } else {
      light_tile(s.surface, where.size, lights, groups, pipeline.light_model, clear, light_shortcuts(), s.lights,
                 s.color, counts.light);
      if (encodes(glass)) encode_colors(target(), where.size * where.size, s.color);
    }
    if (glass != nullptr && transparent.after_lights())
      transparent.blend_after_lights(all, where, execution, s.vertices, s.lights, *glass, s.color);
  }

  /// The target's texels, and the planes light.<i>.
  void store(const TileRect& where, bool tied, const TransparentWork* glass, TileScratch& s) const {
    if (encodes(glass))
      write_stored(s.color, where, out.color);
    else
      store_target(s.color, where, pipeline.gbuffer.half_round, out.color);
    if (blends_lights(pipeline.strategy))
      light_planes.blend(light_draws(), s.surface, tied ? &s.tied : nullptr, where, s.blend, s.extra, out.aovs);
    else
      light_planes.sum(s.surface, where, execution.light_culling, execution.compiled_models, s.lights, s.extra,
                       out.aovs);
  }

  void draw(int tile, TileScratch& s, TileCounts& counts) const {
    const double start = now_ms();
    const Scene& scene = prepared.scene();
    const TileRect where = rect(tile);
    const TileDraws all{prepared.clusters(),    scene, view, pipeline.geometry, bins.draws, bins.tile_list(tile),
                        execution.fast_geometry};
    TransparentWork* const glass = transparent_work(s);
    const TileDraws draws = glass != nullptr ? transparent.opaque_draws(all, *glass) : all;
    draw_visibility(draws, where, execution.geometry_culling, s.visible, counts.raster);
    const double seen = now_ms();
    const GBufferState planes = surface_planes(pipeline);
    resolve_surfaces(draws, where, planes, pipeline.light_model, s.visible, need_uv, s.vertices, s.surface);
    const bool tied = pipeline.strategy == Strategy::forward_multipass &&
                      resolve_tied(draws, where, planes, pipeline.light_model, need_uv, execution.geometry_culling,
                                   s.visible, s.vertices, s.tied);
    counts.covered += uint64_t(s.surface.covered_pixels);
    if (glass != nullptr) {
      counts.transparent += transparent.find_fragments(all, where, execution.geometry_culling, s.visible, *glass);
      if (transparent.into_albedo()) transparent.blend_into_albedo(all, where, s.vertices, *glass, s.surface);
    }
    const double resolved = now_ms();
    if (lit) fetch_texels(where, out.color);
    if (lit) light(all, where, tied, glass, s, counts);
    const double lighted = now_ms();
    if (lit) store(where, tied, glass, s);
    for (NamedImage& aov : out.aovs) {
      if (light_of_plane(aov.name)) continue;
      if (aov.name == "specular" || aov.name == "emission") {
        store_material_plane(aov.name, s.surface, pipeline.light_model, where, planes.half_round, aov.image);
        continue;
      }
      const bool counts_fragments = aov.name == "overdraw", distance = aov.name == "Z";
      if (counts_fragments) count_fragments(all, where, s.extra.light_count);
      if (distance) view_distance.measure(s.surface, where.size * where.size, s.extra.plane[0]);
      store_aov(aov.name, s.visible, s.surface, counts_fragments || distance ? s.extra : s.color, where,
                planes.half_round, aov.image);
    }
    counts.ms = {seen - start, resolved - seen, lighted - resolved, now_ms() - lighted};
    if (lit && execution.count_as_gl && blends_lights(pipeline.strategy))  // what it takes is no part of the frame
      counts.lit_geometry += count_lit_geometry(light_draws(), s.surface, where, s.blend.counts, s.blend.lights);
  }
};

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

// Refused before anything is allocated: more bytes than half of the machine's memory would end in the system killing
// us.
void check_memory(const Pipeline& pipeline, const Execution& execution, std::span<const std::string> aovs) {
  const uint64_t pixels = uint64_t(pipeline.width) * uint64_t(pipeline.height);
  uint64_t texel = uint64_t(info(pipeline.target).bytes_per_texel());
  for (const std::string& name : aovs)
    texel += uint64_t(info(aov_format(name, surface_planes(pipeline))).bytes_per_texel());
  const uint64_t tiles = pixels / uint64_t(execution.tile * execution.tile) + 1;
  const uint64_t need = pixels * texel + tiles * (sizeof(TileCounts) + 3 * sizeof(uint64_t));
  const uint64_t have = uint64_t(sysconf(_SC_PHYS_PAGES)) * uint64_t(sysconf(_SC_PAGESIZE));
  if (need > have / 2)
    throw Error(
        ErrorKind::limit, "size",
        "the image and its planes need " + std::to_string(need >> 20) + " MiB, over half of this machine's memory",
        "a smaller size or fewer planes");
}

void add_up(const std::vector<TileCounts>& tiles, FrameStats& stats) {
  for (const TileCounts& t : tiles) {  // in tile order, so that the sums do not depend on scheduling
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

void draw_tiles(const FrameWork& work, const Progress& progress) {
  const std::vector<int> order = tile_order(work.bins, work.execution);
  std::vector<TileCounts> counts(order.size());
  std::atomic<int> done = 0;
  std::mutex reporting;
  parallel_for(int(order.size()), work.execution.threads, [&](int i) {
    const int tile = order[size_t(i)];
    TileCounts of_tile;  // by itself while it is counted: tiles next to each other share cache lines of `counts`
    work.draw(tile, thread_scratch(), of_tile);
    counts[size_t(tile)] = of_tile;
    const int finished = ++done;
    if (!progress || finished % 16 != 0) return;
    if (const std::unique_lock lock(reporting, std::try_to_lock); lock) progress(finished, int(order.size()));
  });
  add_up(counts, work.out.stats);
  work.out.stats.tile_ms.reserve(order.size());
  for (const int tile : order) work.out.stats.tile_ms.push_back(counts[size_t(tile)].ms);
}

}  // namespace

PreparedScene::PreparedScene(const Scene& scene)
    : scene_(&scene), clusters_(std::make_unique<ClusteredScene>(cluster_scene(scene))) {}
PreparedScene::~PreparedScene() = default;
PreparedScene::PreparedScene(PreparedScene&&) noexcept = default;

int tile_for(int width, int height, int threads) {
  const auto tiles = [](int side) { return uint64_t(side + 63) / 64; };
  return tiles(width) * tiles(height) < 8 * uint64_t(thread_count(threads)) ? 32 : 64;
}

namespace {

struct Tasks {
  int count;
  TaskRef run;
};

// Loops that need nothing of each other as one: each alone is too short to be shared well.
void run_together(std::initializer_list<Tasks> loops, int threads) {
  int count = 0;
  for (const Tasks& loop : loops) count += loop.count;
  parallel_for(count, threads, [&](int i) {
    for (const Tasks& loop : loops) {
      if (i < loop.count) return loop.run(i);
      i -= loop.count;
    }
  });
}

// The picture and the planes, without content; the lights' rows, groups and outlines.
void make_images_and_lights(const Scene& scene, const Pipeline& pipeline, const Execution& execution,
                            std::span<const std::string> aovs, bool lit, const View& view, FrameTables& tables,
                            Frame& frame) {
  if (!tables.meshes || !tables.meshes->fit(pipeline.light_volumes)) tables.meshes.emplace(pipeline.light_volumes);
  for (const std::string& name : aovs) frame.aovs.push_back({name, Image()});
  const auto make_image = [&](int i) {
    if (i == 0 && !lit) return;
    const Format format = i == 0 ? pipeline.target : aov_format(aovs[size_t(i - 1)], surface_planes(pipeline));
    (i == 0 ? frame.color : frame.aovs[size_t(i - 1)].image) = Image(pipeline.width, pipeline.height, format);
  };
  LightTableUpdate rows(scene.lights, pipeline.light_model, pipeline.light_volumes,
                        pipeline.strategy == Strategy::deferred_volumes, scene.camera, tables.lights);
  const bool drawn = lit && blends_lights(pipeline.strategy);
  const int outlines =
      drawn ? start_outlines(scene.lights, pipeline, *tables.meshes, view, tables.outline_tasks, tables.outlines) : 0;
  run_together({{int(aovs.size()) + 1, make_image},
                {outlines, [&](int i) { tables.outline_tasks.run(i); }},
                {rows.tasks(), [&](int i) { rows.run(i); }}},
               execution.threads);
  rows.finish();
  if (drawn) tables.outline_tasks.finish(execution.threads);
  if (lit && execution.light_culling)
    make_light_groups(tables.lights, execution.threads, tables.groups);
  else
    tables.groups.group.clear(), tables.groups.made_of = 0;
}

}  // namespace

Frame draw_frame(const PreparedScene& prepared, const Pipeline& pipeline, const Execution& asked,
                 std::span<const std::string> aovs, bool lit, const Progress& progress) {
  Execution execution = asked;
  if (execution.tile == 0) execution.tile = tile_for(pipeline.width, pipeline.height, execution.threads);
  check_memory(pipeline, execution, aovs);
  wake_threads(execution.threads);
  const FpScope fp;
  const SimdScope simd(execution.simd);
  const double start = now_ms();
  const Scene& scene = prepared.scene();
  Frame frame;
  std::optional<LoopTimes> log(std::in_place);
  const TablesLoan loan;
  FrameTables& tables = *loan.tables;
  View view = make_view(scene, pipeline, execution.threads, std::move(tables.transforms));
  bin_clusters(scene, prepared.clusters(), view, execution.tile, execution.geometry_culling, execution.threads,
               tables.bins);
  make_images_and_lights(scene, pipeline, execution, aovs, lit, view, tables, frame);
  const bool need_uv = std::find(aovs.begin(), aovs.end(), "uv") != aovs.end();
  if (lit && execution.settled_sums && !blends_lights(pipeline.strategy))
    make_plain_lights(tables.lights, pipeline.light_model, tables.plain);
  else
    tables.plain.light.clear(), tables.plain.window.clear();
  const LightMeshes& meshes = *tables.meshes;
  LightPlanes light_planes(aovs, scene, pipeline, meshes, view);
  frame.stats.before_tiles_ms = now_ms() - start;
  frame.stats.loops_before_tiles = log->loops();
  frame.stats.tile = execution.tile, frame.stats.threads = thread_count(execution.threads);
  log.reset();
  draw_tiles({prepared, pipeline, execution, view, tables.bins, tables.lights, tables.plain, tables.groups, meshes,
              tables.outlines, need_uv, lit, std::move(light_planes), ViewDistance(scene, pipeline),
              TransparentPass(scene, pipeline, execution), frame},
             progress);

  tables.transforms = std::move(view.instances);
  FrameStats& stats = frame.stats;
  stats.pixels = uint64_t(pipeline.width) * uint64_t(pipeline.height);
  stats.lights = scene.lights.size();
  stats.pixel_lights = stats.covered_pixels * stats.lights;
  stats.triangles = scene.triangle_count();
  stats.gl = counted_as_gl(scene, pipeline, meshes, stats);
  stats.total_ms = now_ms() - start;
  return frame;
}

}  // namespace trueshade
