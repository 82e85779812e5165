#pragma once
// What people get wrong of transparent surfaces that are blended over the lit picture.
#include "judge/diagnosis/picture_case.h"

namespace trueshade::oracle {

/// One fragment of glass at a pixel, lit.
struct GlassLayer {
  uint32_t instance = 0;
  double distance = 0;  ///< squared, from the eye to the origin of the object
  Color color{};        ///< lit, and its alpha
};

/// What a glass fault may change: the fragments in the order in which they are drawn, and how they are blended.
struct GlassPixel {
  std::vector<GlassLayer> layers;
  BlendState blend;
};

/// A row of the table of glass faults: what a renderer does wrong, and how it changes a pixel's fragments.
struct GlassFault {
  std::string_view name, text;  ///< text: `%s` stands for the parameter
  void (*change)(GlassPixel&, double) = nullptr;
  bool of_object = false;  ///< its parameter is an object that is transparent
  std::string (*says)(double) = nullptr;

  /// Which numbers the fault's parameter has: an object, or none.
  ParameterForm form() const { return {of_object, false, 0}; }
};

/// All glass faults.
std::span<const GlassFault> glass_faults();

/// A fault that is supposed, with its parameter.
struct NamedGlassFault {
  const GlassFault* fault = nullptr;
  FaultParameter parameter;
};

/// Explains wrong pixels under glass: the likeliest findings first, as from diagnose(). None where fewer than
/// kLeastChanged pixels are wrong. For TransparencyMode::after_lights.
///   picture: of the same capture; predicts what the lights make before glass is drawn
///   only: faults that are supposed, one at a time; empty: look for the likeliest
std::vector<Finding> glass_findings(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                                    const Capture& capture, const StageVerdict& stage, const PictureCase& picture,
                                    std::span<const NamedGlassFault> only);

}  // namespace trueshade::oracle
