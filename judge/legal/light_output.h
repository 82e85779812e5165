#pragma once
// What the fragment shader of one light's draw may output at a surface.
#include <span>

#include "judge/bounds/program_bounds.h"
#include "judge/bounds/shaded_surface.h"
#include "judge/legal/store.h"

namespace trueshade::oracle {

/// What one draw's fragment shader may output.
struct LightOutput {
  std::array<Range, 4> nominal, other;  ///< RGBA before any clamp of the target; `other` where either_way
  bool either_way = false;              ///< a comparison of the shader may go to `other`
  bool undefined = false;               ///< OpenGL gives the value no meaning
};

/// What the program's finish() may make of a sum, whichever way its comparisons go: nominally, and as one set.
LightOutput output_of(const ProgramBounds& program, const ShadedSurface& surface, LitRange lit,
                      ProgramBounds::Registers& registers);

/// Whether no value or end of a colour's ranges is NaN: GLSL promises nothing of what is no number. Infinite ends are
/// numbers.
bool are_numbers(const std::array<Range, 4>& color);

/// The outputs of strategies that draw light by light: each draw's output is what finish() makes of that
/// draw's own sum. A light is named by its place in Scene::lights. The scene is borrowed.
class LightOutputs {
 public:
  /// Makes the light program, or the light model as one. Throws as ProgramBounds does.
  LightOutputs(const Scene& scene, const Pipeline& pipeline, const Profile& profile);

  /// The output of a light's own draw.
  LightOutput term(const ShadedSurface& surface, uint32_t light) const;
  /// The output of the first draw of forward-multipass: light 0, with what the sum starts from.
  LightOutput first(const ShadedSurface& surface) const;
  /// The output of a draw without lights.
  LightOutput start(const ShadedSurface& surface) const;

  /// How many fragments of a quad that ends at the light's range the surface has: 1, 0, or either.
  struct InRange {
    bool surely = true, perhaps = true, nominally = true;
  };
  /// Compares the surface's distance with the light's range.
  InRange in_range(const ShadedSurface& surface, uint32_t light) const;

  /// Whether a fragment of the light counts as lit: in range and facing. One that adds nothing (outside its cone) may
  /// be left out.
  struct Lit {
    bool surely = false, perhaps = false;
  };
  /// Whether the fragment of one light counts.
  Lit lit(const ShadedSurface& surface, uint32_t light) const;
  /// Whether the fragment of light j of terms() counts, which were made with Block::counts.
  Lit lit(const LitApart& terms, size_t j) const;

  /// Sets `lit` to the terms of many lights in one go, which are ascending.
  void terms(const ShadedSurface& surface, std::span<const uint32_t> lights, ProgramBounds::Block& block,
             LitApart& lit) const;
  /// The output of a light whose colour is `color` and cannot be another; alpha as in term().
  LightOutput of_color(const ShadedSurface& surface, const Bounded3& color) const;

  /// The light program, or the light model as one.
  const ProgramBounds& program() const { return program_; }
  /// Whether terms() are outputs, but for alpha: no finish() makes others of them.
  bool are_terms_outputs() const { return !program_.program().defines_finish; }
  /// Whether lights leave the surface out, as it shows its albedo.
  bool is_unlit(const ShadedSurface& surface) const { return program_.is_unlit(surface); }
  /// Whether a draw has no fragments beyond its light's extent, and not fragments that add nothing.
  bool discards_beyond_extent() const { return program_.is_users(); }

 private:
  LightOutput output(const ShadedSurface& surface, LitRange lit) const;
  LitRange alone(const ShadedSurface& surface, uint32_t light) const;

  const Scene& scene_;
  const Profile profile_;
  const ProgramBounds program_;
};

}  // namespace trueshade::oracle
