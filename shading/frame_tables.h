#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "raster/clusters/cluster_bins.h"
#include "raster/light_geometry/light_outlines.h"
#include "raster/view.h"
#include "scenes/pipeline/light_mesh.h"
#include "shading/frame.h"
#include "shading/frame_plan.h"
#include "shading/light/light_table.h"
#include "shading/light/lists/light_clusters.h"

namespace trueshade {

/// What a frame computes before its tiles. The memory is kept for the thread's next frame, because pages that were
/// never touched are dear.
struct FrameTables {
  std::vector<InstanceTransform> transforms;  ///< memory of View::instances between frames
  ClusterBins bins;
  LightTable lights;
  LightClusters clusters;
  std::optional<LightMeshes> meshes;
  LightOutlines outlines;  ///< filled where lights are blended
  OutlineTasks outline_tasks;
};

/// The calling thread's tables for the time of one frame. A frame that starts within another gets tables of its own.
class TablesLoan {
 public:
  TablesLoan();
  ~TablesLoan();
  TablesLoan(const TablesLoan&) = delete;
  TablesLoan& operator=(const TablesLoan&) = delete;
  FrameTables& operator*() const { return *tables_; }

 private:
  std::unique_ptr<FrameTables> tables_;
};

/// Bins the scene's clusters; fills the tables of lights; and gives `frame` its target and planes, named and without
/// content.
void make_tables(const FramePlan& plan, const PreparedScene& prepared, const Pipeline& pipeline,
                 std::span<const std::string> planes, const View& view, FrameTables& tables, Frame& frame);

}  // namespace trueshade
