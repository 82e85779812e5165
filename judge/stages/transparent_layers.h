#pragma once
// Transparent surfaces over a pixel: which fragments may be there, in what order, what each puts into the blend, and
// what the blends leave (docs/arithmetic.md section 15).
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "judge/bounds/program_bounds.h"
#include "judge/bounds/shaded_surface.h"
#include "judge/legal/blend_range.h"
#include "judge/legal/possible_surfaces.h"
#include "judge/legal/surface_values.h"
#include "judge/stages/verdict.h"
#include "oracle/capture.h"

namespace trueshade::oracle {

/// One fragment of a transparent surface at a pixel, as the blend takes it.
struct TransparentLayer {
  uint32_t instance = 0, triangle = 0;
  std::array<Range, 4> nominal, other;  ///< RGBA before any clamp of the target; `other` where either_way
  bool either_way = false;              ///< a comparison of the shader may go to `other`
  bool looked_up = false;               ///< a texture decides some of it
  bool undefined = false;               ///< OpenGL gives the value no meaning
  bool certain = true, drawn = true;    ///< drawn for sure; nominally
  int patch = -1, turn = 0;             ///< of patches that close around the sample: which one, the triangle's sense
  PixelClass doubt = PixelClass::edge;  ///< why it may not be there
  float chance_other = 0;
};

/// The transparent fragments of one pixel, in order of submission, and their closed patches.
struct TransparentPixel {
  std::vector<TransparentLayer> layers;
  std::vector<int> turns;  ///< of each patch: the sum of the senses of its triangles that have the sample (patch.h)
};

/// What a pixel holds after one way of drawing its layers.
struct LayeredTexel {
  PixelClass pixel_class = PixelClass::exact;
  Texel texel;
  std::array<double, 4> value{};  ///< of the last layer
  bool looked_up = false;
  bool undefined = false;
};

/// What a pixel may hold: by the nominal draws, and by any draws that are allowed.
struct CarriedTexel {
  Texel nominal, all;
  bool split = false, open = false;  ///< whether the two may differ; whether a fragment may leave anything
  PixelClass doubt = PixelClass::branch;
};

/// What layers of one material make of a pixel in real arithmetic, and how much one unit of alpha more would change it.
struct GlassChange {
  uint32_t material = 0;
  std::array<double, 4> value{}, by_alpha{};
  int blends = 0;
};

/// Finds the transparent fragments of all pixels. They are tested against the depth that the opaque surfaces left: the
/// capture's own where it has the plane depth, else that of any opaque surface that may be seen there. LESS and LEQUAL
/// (GREATER and GEQUAL alike): a fragment surely passes where all depths it may have are in front of that depth, and
/// may pass where some are. ALWAYS passes. EQUAL and NOTEQUAL may go either way.
class TransparentLayers {
 public:
  /// Finds the fragments that may be seen, with every core. Pixels of other rows than `rows` have none.
  TransparentLayers(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
                    const JudgedRows& rows = {});
  ~TransparentLayers();

  /// Whether any transparent fragment may be at the pixel; y from the top.
  bool any(int x, int y) const;

  /// The fragments of instances [first, end) that may be seen at a pixel, with their colours; y from the top. The
  /// colours are albedos under into-albedo, and lit colours under after-lights.
  TransparentPixel at(int x, int y, uint32_t first, uint32_t end) const;
  /// The fragments of all instances at the pixel.
  TransparentPixel at(int x, int y) const { return at(x, y, 0, ~uint32_t(0)); }

  /// What the pixel holds after each way of drawing the layers onto `from`, the nominal way first. Triangles of a
  /// closed patch are drawn as the patch's sum of turns allows. With more than six layers in doubt: the nominal way,
  /// and one that holds all others.
  std::vector<LayeredTexel> ways(const TransparentPixel& pixel, const Texel& from) const;

  /// What the layers make of a pixel, where all are surely drawn, of one material and without maps; nothing otherwise.
  ///   from: what the pixel holds before them, as values, not codes
  std::optional<GlassChange> change(const TransparentPixel& pixel, const std::array<double, 4>& from) const;

  /// Draws the layers, in all ways at once, onto what a pixel may hold: updates `at`, with the reason why its two sets
  /// may differ.
  void carry(const TransparentPixel& pixel, CarriedTexel& at) const;

  /// The format of the target or plane that the layers are blended into.
  Format format() const { return format_; }

 private:
  struct Front;
  bool test_depth(const SurfaceValues& values, const Front& front, TransparentLayer& layer) const;
  void shade(const SurfaceValues& values, const PossibleSurface& surface, int x, int y, TransparentLayer& layer) const;
  void find_fronts(const Capture& capture, const JudgedRows& rows);
  void chain(const TransparentPixel& pixel, const Texel& from, unsigned drawn, bool other,
             std::vector<LayeredTexel>& out) const;

  const Pipeline pipeline_;
  const Profile profile_;
  const BlendState blend_;
  const Format format_;
  Projector projector_;
  std::vector<double> front_low_, front_high_;  ///< keys of the opaque depth, row 0 the bottom row
  PossibleSurfaces fragments_;
  std::optional<ProgramBounds> lights_;  ///< after_lights
};

/// A copy of the scene in which transparent instances are empty; the other instances keep their indices.
Scene without_transparent(const Scene& scene);

}  // namespace trueshade::oracle
