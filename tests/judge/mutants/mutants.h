#pragma once
// Wrong renderers, to judge the judge by: each is a change of what a right renderer is given, of what it gives, or
// both.
#include <functional>
#include <span>
#include <string_view>

#include "oracle/capture.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// What a right renderer does; its capture has all planes. The harness runs it on the mutant's input.
using Renderer = std::function<Capture(const Scene&, const Pipeline&)>;

/// Where a mutant's difference may lie inside the legal sets.
enum class Latitude : uint8_t {
  none,          ///< wherever it changes a pixel by more than a rounding, it must be rejected
  stated_rules,  ///< legal where the profile leaves that rule open (fill, half mode, store, float order); rejected
                 ///< where it does not
  always_legal,  ///< never to be rejected: the order of lights
};
inline constexpr Latitude kNone = Latitude::none;  ///< in tables of mutants

/// Point lights and spots.
inline bool is_lamp(const Light& l) { return l.type == LightType::point || l.type == LightType::spot; }

struct Mutant {
  std::string_view name;
  Latitude latitude = Latitude::none;
  void (*base)(Scene&,
               Pipeline&) = nullptr;  ///< what right and wrong renderer are both given, where not the scene as it is
  void (*input)(Scene&, Pipeline&) = nullptr;           ///< what the wrong one is given
  void (*output)(const Pipeline&, Capture&) = nullptr;  ///< what is done to what it drew
};

/// Fifty-seven of them.
std::span<const Mutant> mutants();

/// Whether two captures of the same planes differ in any byte.
bool differ(const Capture& a, const Capture& b);

/// Whether two captures agree in every byte that judge_gbuffer() reads: in all planes but light.count.
bool same_surfaces(const Capture& a, const Capture& b);

/// What the wrong renderer draws. `right`: what the right one does, which is not drawn again where the input is the
/// same.
Capture mutated(const Mutant& mutant, const Scene& scene, const Pipeline& pipeline, const Renderer& renderer,
                const Capture& right);

}  // namespace trueshade::oracle
