#pragma once
// What the fragment shader of one light's draw may output at a surface.
#include <optional>

#include "oracle/intervals/shading.h"
#include "oracle/intervals/store.h"

namespace trueshade::oracle {

struct LightOutput {
  std::array<Range, 4> nominal, other;  ///< RGBA before any clamp of the target; `other` where either_way
  bool either_way = false;              ///< a comparison of the shader may go to `other`
  bool undefined = false;               ///< OpenGL gives the value no meaning
};

/// Of the strategies that draw light by light. A Scene of no meshes but the camera and one light stands for the scene.
class LightOutputs {
 public:
  LightOutputs(const Scene& scene, const Pipeline& pipeline, const Profile& profile);

  /// The light whose outputs are asked for next. Not while others ask.
  void set_light(const Light& light);

  LightOutput term(const ShadedSurface& surface) const;   ///< the light's own, alone
  LightOutput first(const ShadedSurface& surface) const;  ///< with what the sum starts from
  LightOutput start(const ShadedSurface& surface) const;  ///< what a surface has without lights

  /// How many fragments of a quad that ends at the light's range the surface has: 1, 0, or either.
  struct InRange {
    bool surely = true, perhaps = true, nominally = true;
  };
  InRange in_range(const ShadedSurface& surface) const;

 private:
  LightOutput output(const ShadedSurface& surface, const LightBounds& bounds) const;
  LightBounds bounds(const Scene& scene, const LightModel& model) const;

  Scene scene_, dark_;
  const Pipeline pipeline_;
  const Profile profile_;
  LightModel alone_;  ///< the model, its sum starting from 0
  LightVolumes limits_;
  std::array<double, 3> view_axis_;
  std::optional<LightBounds> term_, first_, start_;
};

}  // namespace trueshade::oracle
