#pragma once
#include <cstdint>
#include <vector>

#include "raster/light_geometry/light_outlines.h"
#include "raster/light_geometry/transformed_mesh.h"

namespace trueshade {

/// Finds the outline of one light's geometry after the other, on scratch that it keeps.
class OutlineMaker {
 public:
  struct Outline {
    OutlineKind kind = OutlineKind::nothing;
    uint8_t layers = 1;
    int32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< pixels it may cover, half open
    uint32_t edges = 0;                      ///< added to edges()
  };

  /// Begins anew: no edges.
  void start(const GeometryState& state, const WindowTransform& window) {
    state_ = state, window_ = window;
    edges_.clear();
  }

  /// `placed` holds the mesh's vertices in the window, relative to (0, 0).
  Outline outline(const LightMesh& mesh, const TransformedMesh& placed);
  Outline everywhere(OutlineKind kind) const { return {kind, 1, window_.x0, window_.y0, window_.x1, window_.y1, 0}; }

  /// Edges of all outlines so far.
  const std::vector<OutlineEdge>& edges() const { return edges_; }

 private:
  struct Corner {
    int64_t x, y;
    bool operator==(const Corner&) const = default;
    auto operator<=>(const Corner&) const = default;
  };
  struct Side {
    Corner from, to;
    bool operator==(const Side&) const = default;
  };

  Outline unclipped_outline(const LightMesh& mesh, const TransformedMesh& placed);
  Outline clipped_outline(const LightMesh& mesh, const TransformedMesh& placed);
  bool find_loop(const LightMesh& mesh, const TransformedMesh& placed, int sign);
  bool add_sides(const LightMesh& mesh, const TransformedMesh& placed, int& sign);
  void cancel_shared_sides();
  bool link_sides();
  bool convex_loop();
  OutlineKind add_edges();

  GeometryState state_;
  WindowTransform window_{};
  std::vector<OutlineEdge> edges_;
  std::vector<int8_t> drawn_;    // by triangle: on the side that is drawn, or without area; where some are clipped, the
                                 // sign of those that are drawn whole
  std::vector<uint32_t> next_;   // by vertex: where the outline goes on
  std::vector<Side> sides_;      // of drawn triangles, the inside to the left
  std::vector<uint32_t> place_;  // of a table of sides: which is there, from 1; 0: none
  std::vector<int> upward_;      // of each: how often upward, less how often downward
  std::vector<Corner> loop_;     // the outline, counter-clockwise
};

}  // namespace trueshade
