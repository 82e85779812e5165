#pragma once
#include "raster/surfaces/surfaces.h"

namespace trueshade {

/// Planes that are interpolated and stored alike: [first, first + count) of Stream.
struct StreamGroup {
  int first, count;
  PlaneState plane;
};

/// A tile whose surfaces are resolved: what resolve_surfaces() was given, and the planes that it interpolates.
struct SurfaceTask {
  const TileDraws& in;
  const TileRect& rect;
  const GBufferState& planes;
  const LightModel& model;
  const VisibilityTile& visible;
  VisibleVertices& work;
  SurfaceTile& out;
  bool reads_uv;  ///< texture coordinates are interpolated, for maps or for their planes
  StreamGroup group[6];
  int groups;       ///< that are planes
  int read_groups;  ///< and those behind them, that only maps read

  int more_uv() const { return 2 * (in.view.maps.uv_sets - 1); }
  int streams() const { return in.view.maps.tangents ? kAllStreams : kStreams + more_uv(); }

  int pixels() const { return rect.size * rect.size; }
  int blocks() const { return rect.size / kBlockSize; }  ///< a row
};

/// Sets the groups: positions unless depth gives them, normals, albedo, and texture coordinates where they are needed,
/// sets beside the first and tangents last.
inline void set_groups(SurfaceTask& task) {
  const GBufferState& planes = task.planes;
  task.groups = 0;
  if (!planes.position_from_depth) task.group[task.groups++] = {kPosition, 3, planes.position};
  task.group[task.groups++] = {kNormal, 3, planes.normal};
  task.group[task.groups++] = {kAlbedo, 4, planes.albedo};
  if (task.reads_uv) task.group[task.groups++] = {kUv, 2, planes.uv};
  task.read_groups = task.groups;
  if (task.more_uv() > 0) task.group[task.read_groups++] = {kStreams, task.more_uv(), planes.uv};
  if (task.in.view.maps.tangents) task.group[task.read_groups++] = {kVertexTangent, 4, planes.normal};
}

}  // namespace trueshade
