#pragma once
// The lights of docs/arithmetic.md section 8 summed as real numbers, with the bound of docs/gl_rules.md section 6 on
// what legal float arithmetic makes of the sum.
#include <span>
#include <vector>

#include "judge/bounds/bounded.h"
#include "judge/bounds/light_lanes.h"
#include "scenes/pipeline/light_model.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// A texel of the G-buffer as the light pass reads it.
struct ShadedSurface {
  Bounded3 position, normal;
  std::array<Bounded, 4> albedo;
  Bounded3 specular{}, emission{};            ///< where the model reads them
  double shininess = 0, shininess_error = 0;  ///< an integer; any one within the error, where a map leaves several
  Bounded ambient_share{1, 0};                ///< what arrives of ambient light, where the model reads emission
  std::array<Bounded, 2> uv{};                ///< the rest where a light program reads it
  std::array<Bounded, 2> uv1{};
  std::array<Bounded, 4> tangent{};
  std::array<Bounded, 16> user{};             ///< four vectors
  uint32_t object = 0, material = 0;          ///< from 1 on
  std::array<int, 2> pixel{};                 ///< column and row from the lower left
};

/// A light whose comparison with its threshold may go either way: what the other branch adds to the sum.
struct OtherBranch {
  std::array<double, 3> change{};
};

struct LitRange {
  Bounded3 color;  ///< the nominal branches, all lights summed
  std::vector<OtherBranch> branches;
  bool undefined = false;               ///< normalize(0), 0^0: any value is legal
  int lights_low = 0, lights_high = 0;  ///< lights in range and facing: light.count may be any number between
};

/// What lights add alone, by the order they were asked for in. Kept by the caller from pixel to pixel.
struct LitApart {
  std::vector<std::array<Bounded, 3>> color;
  /// 1 where `color` is the only outcome; 0 where a comparison may go either way or the value is undefined, which
  /// LightBounds::alone() tells.
  std::vector<uint8_t> one_outcome;

  LightColumns columns;  // what lanes work on
  LaneTerms terms;
  std::vector<uint32_t> in_columns, places;
};

/// The lights of a scene under a model, ready for any surface. Borrows the scene, which must outlive it.
/// Lights in any order: sum of the errors, and (N - 1) v sum |c_i| for the N - 1 additions.
/// A cone whose cosine may lie on either side of its edge counts as either branch. Not clamped to [0, 1].
class LightBounds {
 public:
  struct Span {
    double low, high;
  };

  ///   view_axis: of the pipeline's camera, where the model's viewer is infinite
  ///   volumes: a light whose extent is bounded has no term from its range on
  ///   exact: normalize(0) = 0 and 0^0 = 1 are promised, not undefined
  LightBounds(const Scene& scene, const LightModel& model, const std::array<double, 3>& view_axis,
              const Arithmetic& arithmetic, bool exact, const LightVolumes& volumes = {});

  /// Lights in lanes where the model lets them (light_lanes.h), the others one by one.
  LitRange at(const ShadedSurface& surface) const { return at(surface, columns_); }

  /// Of the lights in lanes those that may reach a surface whose position is in the box. Sums of these alone are the
  /// same: a light that ends at its range adds nothing beyond.
  void take_near(const std::array<Span, 3>& box, LightColumns& near) const;
  LitRange at(const ShadedSurface& surface, const LightColumns& near) const;

  /// All one by one, every error carried operation by operation. The same lights, branches and counts; bounds of at()
  /// are no smaller, and less than 1.1 times as large.
  LitRange one_by_one(const ShadedSurface& surface) const;

  /// One light of the scene alone: without what a sum starts from.
  LitRange alone(const ShadedSurface& surface, uint32_t light) const;

  /// Each of these lights alone, ascending; in lanes where at() would have it so: no smaller bounds, and less than
  /// 1.2 times as large.
  void apart(const ShadedSurface& surface, std::span<const uint32_t> lights, LitApart& lit) const;

 private:
  template <class Term>
  LitRange alone(const ShadedSurface& surface, const Term& term, uint32_t light) const;

  const Scene& scene_;
  LightModel model_;
  std::array<double, 3> view_axis_;
  Arithmetic arithmetic_;
  bool exact_;
  LightVolumes volumes_;
  LightColumns columns_;
  std::vector<uint32_t> others_;  ///< lights that are not in the columns
  std::vector<int64_t> place_;    ///< of each light in the columns, -1 of others
  LaneModel lanes_;
};

/// Of one surface: LightBounds::at().
LitRange lit_range(const ShadedSurface& surface, const Scene& scene, const LightModel& model,
                   const std::array<double, 3>& view_axis, const Arithmetic& arithmetic, bool exact,
                   const LightVolumes& volumes = {});

}  // namespace trueshade::oracle
