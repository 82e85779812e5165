#pragma once
// A capture's planes as the light pass reads them.
#include "judge/bounds/shaded_surface.h"
#include "judge/legal/light_output.h"
#include "judge/stages/tally.h"
#include "oracle/matrices.h"

namespace trueshade::oracle {

/// What the light pass reads of each pixel, from the capture's own planes. Borrows the capture. y counts from the top.
class CapturedSurface {
 public:
  /// Throws Error(bad_input) naming a plane that the light model reads and the capture lacks, or that has another size
  /// than the pipeline's; also where neither id.object nor depth tells where a surface is, and for a camera without an
  /// inverse where positions are rebuilt from depths.
  CapturedSurface(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture);

  /// Whether the pixel shows a surface, as id.object tells or, without that plane, the depth.
  bool covered(int x, int y) const;
  /// The pixel's surface as the light pass reads it. Where no surface is, whatever the planes hold there.
  ShadedSurface at(int x, int y) const;

  /// The alpha that the light pass outputs for a surface, before the target clamps it: the albedo's, or 1.
  Bounded alpha(const ShadedSurface& surface) const {
    return pipeline_.light_model.alpha_from_albedo ? surface.albedo[3] : Bounded{1, 0};
  }
  /// The plane id.object; empty where it was not captured.
  const PlaneView& object() const { return object_; }
  /// The plane depth; empty where it was not captured.
  const PlaneView& depth() const { return depth_; }

 private:
  PlaneView required(const Capture& capture, std::string_view name) const;
  Bounded fetched(const PlaneView& view, int x, int y, int channel) const;
  void find_fields(const Scene& scene, const Capture& capture);
  void fetch_fields(int x, int y, ShadedSurface& surface) const;
  void invert(const Scene& scene);
  Bounded3 position_from_depth(int x, int y) const;

  const Pipeline pipeline_;
  const Profile profile_;
  PlaneView normal_, albedo_, object_, specular_, emission_, position_, depth_;
  // For light programs.
  PlaneView uv_, material_, metallic_, roughness_, occlusion_, uv1_, tangent_;
  std::array<PlaneView, 4> user_;
  Viewport viewport_;
  Matrix4 world_from_clip_{};
};

/// Throws Error(bad_input), naming the plane, if a light program reads id.material or id.object and the capture lacks
/// it.
void require_planes_of(const ProgramBounds& program, const Capture& capture);

/// A normal's component as shaders compute it from a fixed-point plane: 2 c - 1, c what they fetch. Doubling is exact,
/// and the difference is rounded once, fused or not.
Bounded doubled_normal(const Bounded& fetched, const Arithmetic& arithmetic);

}  // namespace trueshade::oracle
