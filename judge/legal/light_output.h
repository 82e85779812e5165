#pragma once
// What the fragment shader of one light's draw may output at a surface.
#include <optional>
#include <span>

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
/// for the scene.
class LightOutputs {
 public:
  LightOutputs(const Scene& scene, const Pipeline& pipeline, const Profile& profile);

  /// The lights whose outputs are asked for next, by their place among them. Not while others ask.
  void set_lights(std::span<const Light> lights);

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
  void terms(const ShadedSurface& surface, std::span<const uint32_t> lights, LitApart& lit) const {
    lights_->apart(surface, lights, lit);
  }
  /// The output of a light whose colour is `color` and cannot be another; alpha as in term().
  LightOutput of_color(const ShadedSurface& surface, const Bounded3& color) const;

 private:
  LightOutput output(const ShadedSurface& surface, const LitRange& lit) const;
  Range alpha(const ShadedSurface& surface) const;
  LightBounds bounds(const Scene& scene) const;

  Scene scene_, dark_;
  const Pipeline pipeline_;
  const Profile profile_;
  LightVolumes limits_;
  std::array<double, 3> view_axis_;
  std::optional<LightBounds> lights_, start_;
};

}  // namespace trueshade::oracle
