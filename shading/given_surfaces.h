#pragma once
#include "core/image.h"
#include "raster/surfaces/surfaces.h"
#include "raster/view.h"
#include "scenes/pipeline/program_inputs.h"
#include "shading/frame.h"

namespace trueshade {

/// A G-buffer that something else has drawn. Images are of the pipeline's size; their values are those that planes read
/// back as (docs/arithmetic.md section 7), and fixed-point normals are halved. Borrowed; null where there is none.
struct GivenSurfaces {
  const Image* depth = nullptr;     ///< window depth
  const Image* object = nullptr;    ///< r32ui: index + 1, 0 without a surface
  const Image* position = nullptr;  ///< world space; else rebuilt from the depth
  const Image* normal = nullptr;    ///< world space
  const Image* albedo = nullptr;    ///< linear; without a fourth channel alpha is 1
  const Image* specular = nullptr;  ///< RGB the specular colour, A the shininess; where the light model reads them
  const Image* emission = nullptr;  ///< RGB, A the share of ambient light; absent: 0, 1

  // What light programs may read besides.
  const Image *metallic = nullptr, *roughness = nullptr, *occlusion = nullptr;  ///< before those of other planes
  const Image *uv = nullptr, *uv1 = nullptr, *tangent = nullptr;
  const Image* user[4] = {};
  const Image* material = nullptr;  ///< r32ui: index + 1
  float clear_depth = 1.0f;         ///< tells surfaces where there is no `object`
};

/// Error(bad_input) naming a plane that the pipeline's light pass reads and that is not there, or of another size;
/// Error(usage) for forward-multipass, which blends fragments of equal depth that no G-buffer has, for a post chain
/// with samples, which lights more pixels than there are, and for a view but the lit one.
void check_surfaces(const GivenSurfaces& given, const Pipeline& pipeline);

/// The fields of captures that are there.
CapturedFields captured_fields(const GivenSurfaces& given);

/// Error(bad_input) naming a plane that a light program reads and that is not there; or that of materials, where some
/// are unlit.
void check_fields(const GivenSurfaces& given, const ProgramReads& reads, bool has_unlit, const Pipeline& pipeline);

/// The tile's surfaces and depths from the images, in place of draw_visibility() and resolve_surfaces().
///   reads: of the light program; null: there is none
void load_surfaces(const GivenSurfaces& given, const ProgramReads* reads, const View& view, const TileRect& rect,
                   VisibilityTile& visible, SurfaceTile& out);

/// Lights surfaces by the scene's lights, camera and clear colour: the light pass of render_frame(), which makes the
/// same bits of the planes of a frame of ours. The scene's objects are not drawn. Throws as check_surfaces() does.
Frame light_surfaces(const Scene& scene, const Pipeline& pipeline, const Execution& execution,
                     const GivenSurfaces& given, const Progress& progress = {});

}  // namespace trueshade
