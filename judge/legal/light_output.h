#pragma once
// What the fragment shader of one light's draw may output at a surface.
#include <span>

#include "judge/bounds/program_bounds.h"
#include "judge/bounds/shaded_surface.h"
#include "judge/legal/store.h"

namespace trueshade::oracle {

/// The colours that the fragment shader may output in one draw: a range a channel, and a second one where a comparison
/// in the shader may go either way.
struct LightOutput {
  std::array<Range, 4> nominal, other;  ///< RGBA before any clamp of the target; `other` where either_way
  bool either_way = false;              ///< a comparison of the shader may go to `other`
  bool undefined = false;               ///< OpenGL gives the value no meaning
};

/// What finish() may make of the sum `lit`: `nominal` with the sum's nominal branches, `other` as one set that holds
/// the results of all branches.
LightOutput output_of(const ProgramBounds& program, const ShadedSurface& surface, LitRange lit,
                      ProgramBounds::Registers& registers);

/// Whether no value and no end of the four ranges is NaN, of which GLSL promises nothing. Infinite ends are allowed.
bool are_numbers(const std::array<Range, 4>& color);

/// What the fragment shader outputs under strategies that draw light by light: finish() of each draw's own sum. A light
/// is named by its place in Scene::lights. The scene is borrowed.
class LightOutputs {
 public:
  /// Prepares the pipeline's light program or, where it has none, its light model as a program. Throws as ProgramBounds
  /// does.
  LightOutputs(const Scene& scene, const Pipeline& pipeline, const Profile& profile);

  /// The output of the draw of one light.
  LightOutput term(const ShadedSurface& surface, uint32_t light) const;
  /// The output of the first draw of forward-multipass: light 0 added to what the sum starts from.
  LightOutput first(const ShadedSurface& surface) const;
  /// The output of a draw without lights: what the sum starts from.
  LightOutput start(const ShadedSurface& surface) const;

  /// Whether the surface is nearer to a light than its range: surely, perhaps, and in real arithmetic. A quad that ends
  /// at the range has one fragment there where it is, and none where it is not.
  struct InRange {
    bool surely = true, perhaps = true, nominally = true;
  };
  /// Compares the surface's distance to the light with the light's range.
  InRange in_range(const ShadedSurface& surface, uint32_t light) const;

  /// Whether a light counts as lit: the surface is in its range and faces it. A light that adds nothing (outside of its
  /// cone) may or may not be counted.
  struct Lit {
    bool surely = false, perhaps = false;
  };
  /// Whether one light counts as lit.
  Lit lit(const ShadedSurface& surface, uint32_t light) const;
  /// Whether light j of `terms` counts as lit; terms() made them with Block::counts.
  Lit lit(const LitApart& terms, size_t j) const;

  /// Sets `lit` to what each of these lights, given in ascending order, adds by itself.
  void terms(const ShadedSurface& surface, std::span<const uint32_t> lights, ProgramBounds::Block& block,
             LitApart& lit) const;
  /// The output of a light's draw whose colour before finish() is `color`, with no other outcome; alpha as in term().
  LightOutput of_color(const ShadedSurface& surface, const Bounded3& color) const;

  /// The light program, or the program that stands for the light model.
  const ProgramBounds& program() const { return program_; }
  /// Whether what terms() gives is already the RGB that a draw outputs, because the program has no finish().
  bool are_terms_outputs() const { return !program_.program().defines_finish; }
  /// Whether the surface is unlit: it shows its albedo, and lights do not draw on it.
  bool is_unlit(const ShadedSurface& surface) const { return program_.is_unlit(surface); }
  /// Whether a light's draw discards its fragments beyond the light's extent; if not, they are drawn and add nothing.
  bool discards_beyond_extent() const { return program_.is_users(); }

 private:
  LightOutput output(const ShadedSurface& surface, LitRange lit) const;
  LitRange alone(const ShadedSurface& surface, uint32_t light) const;

  const Scene& scene_;
  const Profile profile_;
  const ProgramBounds program_;
};

}  // namespace trueshade::oracle
