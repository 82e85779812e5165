#pragma once
// What a possible surface hands to the fragment shader at a sample, and what the material makes of it.
#include <memory>
#include <optional>

#include "judge/bounds/shaded_surface.h"
#include "judge/legal/bent_normal.h"
#include "judge/legal/map_range.h"
#include "judge/legal/possible_surfaces.h"
#include "judge/legal/triangle_form.h"

namespace trueshade::oracle {

/// The maps of a material, in the order of maps_of().
enum MaterialMap : size_t { kColorMap, kSpecularMap, kNormalMap, kMetalMap, kEmissionMap, kOcclusionMap };

/// What the maps of a material give at a sample; nothing where a map is not there, or not read.
using SurfaceTexels = std::array<std::optional<std::array<Range, 4>>, kMaterialMaps>;

/// Bounds what one possible surface hands to the fragment shader at one sample (x, y), pixels, y up, and what its
/// material makes of that. Borrows the projector.
class SurfaceValues {
 public:
  /// Computes the triangle's form, and looks up its material's maps.
  SurfaceValues(const Projector& projector, const PossibleSurface& possible, double x, double y);

  /// Takes a triangle whose form is known.
  ///   texels: what the maps give, where that is known already; null: they are looked up
  SurfaceValues(const Projector& projector, std::shared_ptr<const TriangleForm> form, const PossibleSurface& possible,
                double x, double y, SurfacePoint::Within within = SurfacePoint::Within::box,
                const SurfaceTexels* texels = nullptr);

  /// False where depth and attributes may be anything (SurfacePoint::bounded()).
  bool bounded() const { return point_.bounded(); }
  /// Whether the albedo comes from a lookup.
  bool textured() const { return texels_[kColorMap] || texels_[kMetalMap]; }
  /// Whether the specular colour comes from a lookup.
  bool glossy() const { return maps_metals(model_) ? textured() : texels_[kSpecularMap].has_value(); }
  /// Whether the shininess comes from a lookup.
  bool rough() const { return texels_[kMetalMap].has_value(); }
  /// Whether the emission comes from a lookup.
  bool glowing() const { return texels_[unlit_ ? kColorMap : kEmissionMap].has_value(); }
  /// Whether the share of ambient light comes from a lookup.
  bool shaded() const { return texels_[kOcclusionMap].has_value(); }
  /// Whether the normal comes from a lookup.
  bool bumpy() const { return bent_.has_value(); }
  /// Whether any of them comes from a lookup.
  bool looked_up() const { return textured() || glossy() || glowing() || shaded() || bumpy(); }
  /// The surface's material, which is the scene's.
  const Material& material() const { return *material_; }

  Range depth() const;                                               ///< as the depth buffer may hold it
  Range attribute(size_t index, Interpolation interpolation) const;  ///< a ValueIndex plus a component
  Range normal(int k, Interpolation interpolation) const;      ///< bent where there is a map, then turned to the viewer
  Range base_color(int k, Interpolation interpolation) const;  ///< vertex colour times texel times base colour
  Range albedo(const Range& base) const;                       ///< of the base colour: less what is metal
  Range specular(const Range& base, int k) const;
  Range shininess() const;  ///< integers: any one between the ends
  Range emission(const Range& base, int k) const;
  Range ambient_share() const;  ///< what arrives of ambient light

 private:
  bool reads(MaterialMap map) const;
  Range straight_normal(int k, Interpolation interpolation) const;  ///< of the front, before a map bends it
  const Range* texel(MaterialMap map) const { return texels_[map] ? texels_[map]->data() : nullptr; }
  Range tinted(const Range& r, double tint) const;
  void bend(const std::array<Range, 4>& bumps);
  Range metallic() const;
  Range roughness() const;
  double roundoff() const;

  const Projector& projector_;
  const LightModel& model_;
  const Material* material_;
  const std::shared_ptr<const TriangleForm> form_;
  const size_t piece_index_;
  const Piece* const piece_;
  const SurfacePoint point_;
  bool unlit_ = false;
  SurfaceTexels texels_;
  std::optional<std::array<Range, 3>> bent_;

  /// Whether the triangle may show its front, and its back: a double-sided material turns the normal of the back.
  bool may_be_front() const { return !material_->double_sided || !piece_->facing_known || piece_->front; }
  bool may_be_back() const { return material_->double_sided && (!piece_->facing_known || !piece_->front); }
};

/// A possible surface's fragment as lights read it under forward strategies, where no G-buffer plane stores it.
/// `planes` says how each attribute is interpolated.
ShadedSurface shaded_surface(const SurfaceValues& values, const GBufferState& planes);

/// Component k of n / |n|, for any n in the ranges x, y, z.
Range normalized(const Range& x, const Range& y, const Range& z, int k, const Profile& profile);

/// The range of n 0.5 + 0.5, a normal's component as fixed-point planes store it: halving is exact, the sum rounds
/// once.
Range halved_normal(const Range& n, const Profile& profile);

}  // namespace trueshade::oracle
