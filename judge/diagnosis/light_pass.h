#pragma once
// What a light pass makes of one pixel of a capture's own G-buffer, right or with a fault: docs/arithmetic.md section 8
// in double, light after light.
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "judge/diagnosis/light_shapes.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// A pixel's surface as the light pass reads it, in double, without bounds on errors.
struct PlainSurface {
  bool covered = false;
  std::array<double, 3> position{}, normal{}, specular{}, emission{};
  std::array<double, 4> albedo{0, 0, 0, 1};
  double shininess = 0, ambient_share = 1;
  // What light programs read besides:
  std::array<double, 2> uv{};
  uint32_t object = 0, material = 0;
  std::array<int, 2> pixel{};
  bool unlit = false;  ///< shows its albedo, whatever the program
};

/// What a wrong light pass does differently from its light model. The defaults are right.
struct LightFault {
  enum class Distance : uint8_t { right, once, squared };  ///< d where d^2 is due; d^2 where d is
  enum class Half : uint8_t { right, viewer_turned, light_turned, reflected, no_viewer };
  enum class Root : uint8_t { right, one_newton_step, twelve_bits };
  enum class Sum : uint8_t { right, halves };
  enum class Store : uint8_t { right, truncated, nearest, upward };
  enum class Cosine : uint8_t { right, unclamped, two_sided, half_lambert, missing };
  Distance distance = Distance::right;
  Half half = Half::right;
  Root root = Root::right;
  Sum sum = Sum::right;
  Store store = Store::right;
  Cosine cosine = Cosine::right;
  double normal_codes = 0;  ///< normals rounded to so many steps in [0, 1]; 0: not rounded
  double intensity = 1, range = 1, specular = 1, shininess = 1, diffuse = 1;  ///< factors
  double position = 1;                                                        ///< of the lights', about the origin
  int64_t missing = -1, twice = -1;                                           ///< index of a light
  uint32_t most_lights = std::numeric_limits<uint32_t>::max();                ///< of the scene
  uint32_t most_at_pixel = std::numeric_limits<uint32_t>::max();              ///< of those in range of a pixel
  bool reversed = false, normal_turned = false, swapped_colors = false, mirrored_z = false;
  bool no_ambient = false, cone_dropped = false;
  double near = 1, far = 1;     ///< factors of the planes by which positions are rebuilt from depths
  bool normal_in_view = false;  ///< rotated by the camera, and then read as if in the world
};

class PlainProgram;

/// The lights and how they are drawn; a fault may have changed any part.
struct LightPass {
  Camera camera;
  Pipeline pipeline;
  std::vector<Light> lights;
  LightFault fault;
  std::array<double, 3> axis{};                 ///< oracle::view_axis() of the camera
  std::array<std::array<double, 3>, 3> view{};  ///< view_axes() of the camera
  glm::vec4 clear{0.0f};
  /// The eye that light meshes are drawn from, whatever the lights take for the eye; nothing: an orthographic camera,
  /// which draws them along `view[2]`.
  std::optional<std::array<double, 3>> drawn_from{};
  std::shared_ptr<const LightShapes> shapes{};  ///< null: no light is drawn as a mesh
  /// The light program, instead of the light model, which then has no terms; null: there is none.
  std::shared_ptr<const PlainProgram> program{};
};

/// The right pass of this scene. A pipeline's light program becomes `program`, and the light model is emptied.
LightPass light_pass_of(const Scene& scene, const Pipeline& pipeline);

/// The RGBA that is predicted for one pixel.
struct PredictedPixel {
  std::array<double, 4> stored{};  ///< as PlaneView::stored() has it: codes, or floats
  std::array<double, 4> value{};   ///< before the store; of strategies that blend, the value of `stored`
};

/// One light that was drawn, in the order of drawing, and the pixel's value after it.
struct TracedLight {
  uint32_t light = 0;
  bool in_range = true, adds = false;
  std::array<double, 4> value{};
};

/// Predicts what the pass stores at a pixel that shows `surface`; the clear colour where that is not covered.
///   listed: whether each light is in the list that the pixel is lit from; null: all are
///   trace: if not null, the drawn lights are appended in the order in which they are added; not the first one of
///          forward-multipass, which is stored instead of added
PredictedPixel predicted_pixel(const LightPass& pass, const PlainSurface& surface,
                               const std::vector<uint8_t>* listed = nullptr, std::vector<TracedLight>* trace = nullptr);

/// The code or float that the target stores for a value, by a rule that a fault may have changed.
double stored_value(const Pipeline& pipeline, LightFault::Store rule, double value, int channel);
/// The value that a stored code or float stands for: of a float itself, of a code a number from 0 to 1, decoded from
/// sRGB where the channel is encoded.
double value_of_stored(Format target, double stored, int channel);

/// A light that adds something to a pixel, and the RGB that all its fragments add together.
struct LightAdded {
  uint32_t light = 0;
  std::array<double, 3> term{};
};

/// The lights that add something to a surface's pixel, by ascending index, with what they add times the albedo. None
/// for an unlit surface under a light program. Ignores faults that leave lights out or draw them twice.
std::vector<LightAdded> lights_added(const LightPass& pass, const PlainSurface& surface);

}  // namespace trueshade::oracle
