#pragma once
// The judge of one capture's surfaces under one profile: what judge_gbuffer() and gbuffer_violations() share.
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "judge/legal/possible_sample.h"
#include "judge/legal/surface_values.h"
#include "judge/stages/judge.h"
#include "judge/stages/tally.h"
#include "judge/stages/transparent_layers.h"

namespace trueshade::oracle {

/// A plane of the capture whose values are interpolated over triangles.
struct AttributePlane {
  const char* name;
  PlaneView view;
  size_t first;    ///< index in VertexValues
  int count;       ///< channels interpolated; those after them are constants
  double rest[2];  ///< channels 2 and 3 where they are not interpolated
  Interpolation interpolation;
};

/// What a judgement looks for: each pixel's class, or violations alone.
enum class Asked : uint8_t { classes, violations };

/// legal_texel() with its last result kept: colours are constant over many pixels.
class LastTexel {
 public:
  /// The values that a channel may hold for an output in `range`. Plane, channel and profile are the same at every
  /// call.
  const LegalTexel& of(const Range& range, const PlaneView& view, int channel, const Profile& profile) {
    const bool is_same =
        is_known_ && range.value == range_.value && range.low == range_.low && range.high == range_.high;
    if (!is_same) texel_ = legal_texel(range, view.image->format, channel, profile);
    is_known_ = true, range_ = range;
    return texel_;
  }

 private:
  bool is_known_ = false;
  Range range_;
  LegalTexel texel_;
};

/// Working memory of one thread, kept from pixel to pixel.
struct GBufferMemory {
  /// Borrows the projector.
  explicit GBufferMemory(const Projector& projector) : forms(projector), narrowed(projector, forms) {}
  TriangleForms forms;
  std::array<LastTexel, 4> constants;  ///< of the albedo
  NarrowedSurfaces narrowed;
  std::vector<const PossibleSurface*> legal;
};

/// Judges the surfaces of one capture by one profile. Borrows the scene, the capture and `wider`.
class GBufferJudge {
 public:
  /// Finds the surfaces that the pixels of the rows may show, unless `wider` gives them. Throws as judge_gbuffer().
  ///   wider: surfaces found under a profile that allows all that `profile` allows; null: there are none
  ///   hulls: of the scene's textures, as another judge found them; null: there are none
  GBufferJudge(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
               const JudgedRows& rows, Asked asked, const PossibleSurfaces* wider, std::shared_ptr<LevelHulls> hulls);

  /// Judges the rows from y to before `end`, counted from the top, and writes the results to rows[y] and on. Goes tile
  /// by tile, as pixels near each other show the same triangles. From any thread.
  void judge_band(int y, int end, std::vector<RowTally>& rows) const;

  /// Returns the possible surfaces and the texture hulls that were found. The last call, as it moves them out.
  FoundSurfaces take_found() { return {std::move(possible_), projector_.level_hulls()}; }

 private:
  static constexpr int kTile = 16;
  size_t pixel_of(int x, int y_top) const {
    return size_t(pipeline_.height - 1 - y_top) * size_t(pipeline_.width) + size_t(x);
  }

  /// Whether a fragment with this depth key surely passes the depth test against the clear value.
  bool passes_clear(double key) const {
    const GeometryState& g = pipeline_.geometry;
    const bool equal_passes = g.depth_func == DepthFunc::lequal || g.depth_func == DepthFunc::gequal;
    const double clear = clear_key(g);
    return key < clear || (equal_passes && key == clear);
  }

  bool is_clear(int x, int y) const;
  /// Whether the albedo that `view` holds at (x, y), y from the top, is what transparent surfaces may leave on the
  /// clear value; false where none may be there. The caller knows that no opaque surface is seen there.
  bool is_layered(const PlaneView& view, int x, int y) const;
  /// Judges the albedo where transparent surfaces are blended over an opaque one.
  template <typename Found>
  void judge_layered(const AttributePlane& plane, const SurfaceValues& surface, int x, int y_top, Found& m) const;
  /// The range of an unpacked value, widened by how far storing the packed one may move it.
  static Range widened(const Range& packed, const PlaneView& view, int x, int y_top) {
    const double error = view.packing_error(x, y_top);
    return {packed.value, packed.low - error, packed.high + error};
  }

  /// The range of what a plane may hold of component k of a surface's normal.
  Range held_normal(const AttributePlane& plane, const SurfaceValues& surface, int k, int x, int y_top) const;
  /// Compares the pixel with one surface, and returns whether the surface's planes are bounded there.
  ///   Found: Match, or a type with its members that asks only whether the pixel is legal
  template <typename Found>
  bool compare(const Projector& projector, const PossibleSurface& c, int x, int y_top, GBufferMemory& memory,
               SurfacePoint::Within within, Found& m) const;
  /// How the pixel compares with one surface. Sets `bounded` to whether the surface's planes are bounded there.
  ///   worst_error: the largest error found so far; a smaller one is not reported
  Match match(const PossibleSurface& c, int x, int y_top, GBufferMemory& memory, bool& bounded,
              double worst_error) const;
  /// Whether the pixel shows one surface with its vertices in the middle of their boxes. If so, the pixel is legal; if
  /// not, it may still be legal.
  bool fits_middle(const PossibleSurface& c, int x, int y_top, GBufferMemory& memory) const;
  /// Judges a stored shininess, which must be a whole number within the range.
  template <typename Found>
  void judge_shininess(const Range& range, double stored, uint32_t pixel, bool looked_up, Found& m) const;

  template <typename Found>
  void judge_own_plane(const PlaneView& view, const char* name, const Range& range, int x, int y_top, Found& m) const;

  /// Sets `legal` to the surfaces that may be seen, the nominal one first.
  void find_legal(std::span<const PossibleSurface> all, std::vector<const PossibleSurface*>& legal,
                  const PossibleSurface*& nominal, bool& certain) const;
  /// Keeps what the pixel tells of material maps, or of the glass before it, for the tests of the whole image.
  void keep_for_materials(const PossibleSurface& shown, int x, int y_top, GBufferMemory& memory, RowTally& row) const;
  void judge_pixel(std::span<const PossibleSurface> all, int x, int y_top, GBufferMemory& memory, RowTally& row) const;
  void find_violation(int x, int y_top, GBufferMemory& memory, RowTally& row) const;
  std::optional<PossibleSurface> nominally_seen(std::span<const PossibleSurface> all, double x, double y,
                                                TriangleForms& forms) const;
  bool is_surely_legal(std::span<const PossibleSurface> all, int x, int y_top, GBufferMemory& memory) const;
  PixelClass class_of(const Match& m, bool bounded, const PossibleSurface* seen, const PossibleSurface* nominal) const;

  Projector projector_;
  std::optional<Projector> exact_filters_;  ///< where maps are read: by a profile of exact lookups
  const Pipeline pipeline_;
  const Profile profile_;
  const Asked asked_;
  const PixelMask& mask_;
  const PossibleSurfaces* const wider_;
  PlaneView depth_, object_, material_, specular_, emission_, metallic_, roughness_;
  std::vector<AttributePlane> planes_;
  PossibleSurfaces possible_;
  std::optional<TransparentLayers> layers_;  ///< blended into the albedo
};

/// Judges the given rows with every core, and makes the verdict of the whole image, in which pixels of other rows are
/// EXACT and not counted.
///   profile: the one that `judge` was made with
StageVerdict verdict_by(const GBufferJudge& judge, const Pipeline& pipeline, const Profile& profile,
                        const JudgedRows& judged);

}  // namespace trueshade::oracle
