#pragma once
// What the fragment shader of one light's draw may output at a surface.
#include <optional>
#include <span>

#include "judge/bounds/program_bounds.h"
#include "judge/bounds/shading.h"
#include "judge/legal/store.h"

namespace trueshade::oracle {

struct LightOutput {
  std::array<Range, 4> nominal, other;  ///< RGBA before any clamp of the target; `other` where either_way
  bool either_way = false;              ///< a comparison of the shader may go to `other`
  bool undefined = false;               ///< OpenGL gives the value no meaning
};

/// A colour of the lights as the fragment outputs it: clamped where the model says so.
Range output_range(const LightModel& model, const Bounded& value);

/// Whether a colour's ranges are known: GLSL promises nothing of what is no number.
bool are_numbers(const std::array<Range, 4>& color);

/// The outputs of strategies that draw light by light. A Scene without meshes, of the camera and some lights, stands
/// for the scene. Of a light program each draw's output is what finish() makes of its own sum.
class LightOutputs {
 public:
  LightOutputs(const Scene& scene, const Pipeline& pipeline, const Profile& profile);

  /// The lights whose outputs are asked for next, by their place among them. first: the scene's number of the first.
  /// Not while others ask.
  void set_lights(std::span<const Light> lights, uint32_t first);

  LightOutput term(const ShadedSurface& surface, uint32_t light) const;  ///< the light's own, alone
  /// With what the sum starts from; only one light may be set.
  LightOutput first(const ShadedSurface& surface) const;
  LightOutput start(const ShadedSurface& surface) const;  ///< what a surface has without lights

  /// How many fragments of a quad that ends at the light's range the surface has: 1, 0, or either.
  struct InRange {
    bool surely = true, perhaps = true, nominally = true;
  };
  InRange in_range(const ShadedSurface& surface, uint32_t light) const;

  /// Whether a fragment of the light counts as lit: in range and facing. One that adds nothing (outside its cone) may
  /// be left out.
  struct Lit {
    bool surely = false, perhaps = false;
  };
  Lit lit(const ShadedSurface& surface, uint32_t light) const;

  /// Many lights' terms in one go, ascending.
  void terms(const ShadedSurface& surface, std::span<const uint32_t> lights, LitApart& lit) const;
  /// The output of a light whose colour is `color` and cannot be another; alpha as in term().
  LightOutput of_color(const ShadedSurface& surface, const Bounded3& color) const;

  const ProgramBounds* program() const { return program_ ? &*program_ : nullptr; }  ///< null: none
  /// Whether terms() are outputs, but for alpha: no finish() makes others of them.
  bool are_terms_outputs() const { return !program_ || !program_->program().defines_finish; }
  /// Whether lights leave the surface out, as it shows its albedo.
  bool is_unlit(const ShadedSurface& surface) const { return program_ && program_->is_unlit(surface); }

 private:
  LightOutput output(const ShadedSurface& surface, const LitRange& lit) const;
  Range alpha(const ShadedSurface& surface) const;
  LightBounds bounds(const Scene& scene) const;
  void take_program(const Scene& scene);
  LitRange alone(const ShadedSurface& surface, uint32_t light) const;

  Scene scene_, dark_, all_;  ///< all_: of a program, whose lights are numbered
  const Pipeline pipeline_;
  const Profile profile_;
  LightVolumes limits_;
  std::array<double, 3> view_axis_;
  std::optional<LightBounds> lights_, start_;
  std::optional<ProgramBounds> program_, apart_;  ///< instead of these: with what the sum starts from, and without
  uint32_t first_ = 0;                            ///< the number of the first light that is set
};

}  // namespace trueshade::oracle
