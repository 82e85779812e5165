#pragma once
// One light on one surface, in the arithmetic of bounded.h: the terms that shading.h sums.
#include <array>

#include "judge/bounds/light_lanes.h"
#include "judge/bounds/shading.h"

namespace trueshade::oracle {

struct LightTerm {
  Bounded3 color;               ///< of the nominal branch
  std::array<double, 3> lit{};  ///< of the branch where it adds something
  bool either_way = false, dark = false;
  bool facing = false, maybe_facing = false, in_range = true, maybe_in_range = true;  ///< surely, and perhaps
  bool undefined = false;
};

/// Whether a light adds something to a surface that faces away from it.
bool adds_unlit(const LightModel& model);

/// What of a surface all lights share, and each light's term. Borrows what it is given.
class LightSum {
 public:
  LightSum(const ShadedSurface& s, const Scene& scene, const LightModel& model, const std::array<double, 3>& view_axis,
           const Arithmetic& a, bool exact, const LightVolumes& volumes);

  bool undefined() const { return undefined_; }

  LightTerm operator()(const Light& light) const;

  /// The pixel as lanes read it; false where they do not suit it.
  bool for_lanes(LanePixel& px) const;

  /// Emission and global ambient light.
  Bounded start(size_t k) const;

 private:
  bool is_tinted() const { return shines_ && model_.specular_source == SpecularSource::albedo; }
  double shininess() const { return reads_specular_plane(model_) ? surface_.shininess : double(model_.shininess); }
  double shininess_error() const { return reads_specular_plane(model_) ? surface_.shininess_error : 0; }
  Bounded specular_color(size_t k) const;

  Bounded color_of(const Light& light, size_t k) const;
  Bounded arriving(const Bounded& ambient) const;  ///< what a surface gets of ambient light

  /// x^shininess for 0 <= low <= value <= high: of every shininess that the surface may have.
  Bounded power_of(double low, double value, double high) const;

  /// True where the squared distance is surely no float: the light adds nothing. Sets either_way and dark where it may
  /// be none.
  bool overflows(const Bounded3& offset, const Bounded& d2, LightTerm& t) const;

  /// False where the light's extent surely leaves the pixel out; sets either_way and dark where it may.
  bool inside_extent(const Bounded& d, const Light& light, LightTerm& t) const;

  /// Beyond the range by more than any rounding: nine roundings separate the computed distance from the real one.
  bool far_away(const Bounded3& offset, const Light& light) const;

  Bounded falloff_at(const Bounded& d2, const Light& light) const;

  Bounded windowed_square(const Bounded& d2, const Light& light) const;

  /// The factor of a spot light; sets either_way and dark where c may be on either side of a hard edge.
  Bounded cone_at(const Light& light, const Bounded3& to_light, LightTerm& t) const;

  void shade(const Light& light, const Bounded3& to_light, const Bounded& strength, LightTerm& t) const;

  Bounded term_of(const Light& light, size_t k, const Bounded& cosine, const Bounded& specular,
                  const Bounded& strength) const;

  /// The specular factor; 0 where it is masked, anything between where that may go either way.
  Bounded specular_of(const Bounded3& to_light, const Bounded& n_l, bool& undefined) const;

  Bounded half_cosine(const Bounded3& to_light, bool& undefined) const;

  Bounded reflected_cosine(const Bounded3& to_light, const Bounded& n_l) const;

  const ShadedSurface& surface_;
  const LightModel& model_;
  const LightVolumes& volumes_;
  const Arithmetic& a_;
  bool exact_, undefined_ = false, view_undefined_ = false, view_lost_ = false, shines_ = true, adds_unlit_ = false;
  Bounded3 normal_, view_;
};

}  // namespace trueshade::oracle
