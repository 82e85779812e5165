#include "shading/frame_tables.h"

#include <initializer_list>
#include <utility>

#include "core/threads/parallel_for.h"
#include "raster/clusters/clusters.h"
#include "shading/blend/light_volume_draws.h"
#include "shading/output/target.h"

namespace trueshade {
namespace {

std::unique_ptr<FrameTables>& kept_tables() {
  thread_local std::unique_ptr<FrameTables> tables;
  return tables;
}

struct Tasks {
  int count;
  TaskRef run;
};

// Runs independent loops as one parallel loop: each alone is too short to be split well.
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

}  // namespace

TablesLoan::TablesLoan() : tables_(std::move(kept_tables())) {
  if (!tables_) tables_ = std::make_unique<FrameTables>();
}
TablesLoan::~TablesLoan() { kept_tables() = std::move(tables_); }

void make_tables(const FramePlan& plan, const PreparedScene& prepared, const Pipeline& pipeline,
                 std::span<const std::string> planes, const View& view, FrameTables& tables, Frame& frame) {
  const Scene& scene = prepared.scene();
  const Execution& execution = plan.execution;
  bin_clusters(scene, prepared.clusters(), view, execution.tile, execution.geometry_culling, execution.threads,
               tables.bins);
  if (!tables.meshes || !tables.meshes->fit(pipeline.light_volumes)) tables.meshes.emplace(pipeline.light_volumes);
  for (const std::string& name : planes) frame.aovs.push_back({name, Image()});
  const auto make_image = [&](int i) {
    if (i == 0 && !plan.lit()) return;
    const Format format = i == 0 ? plan.target.format : aov_format(planes[size_t(i - 1)], plan.surface_planes);
    (i == 0 ? frame.color : frame.aovs[size_t(i - 1)].image) = Image(view.width, view.height, format);
  };
  LightTableUpdate rows(scene.lights, pipeline.light_model, pipeline.light_volumes,
                        pipeline.strategy == Strategy::deferred_volumes, scene.camera, tables.lights);
  const int outlines = plan.blends() ? start_outlines(scene.lights, pipeline, *tables.meshes, view,
                                                      tables.outline_tasks, tables.outlines)
                                     : 0;
  run_together({{int(planes.size()) + 1, make_image},
                {outlines, [&](int i) { tables.outline_tasks.run(i); }},
                {rows.tasks(), [&](int i) { rows.run(i); }}},
               execution.threads);
  rows.finish();
  tables.lights.program = plan.program.get();
  if (plan.blends()) tables.outline_tasks.finish(execution.threads);
  if (plan.lit() && execution.light_culling)
    make_light_clusters(tables.lights, execution.threads, tables.clusters);
  else
    tables.clusters.cluster.clear(), tables.clusters.made_of = 0;
}

}  // namespace trueshade
