#pragma once
// How far a capture is from what supposed faults predict. Differences are counted in steps: codes of a unorm plane, or
// the distance of neighbouring floats of the plane's format.
#include <algorithm>
#include <cmath>
#include <string>

#include "judge/diagnosis/fault_parameter.h"

namespace trueshade::oracle {

/// Two values agree if they differ by fewer steps than this.
inline constexpr double kSameSteps = 0.5;

/// What a pixel that is off by so many steps costs: 0 below kSameSteps, else from 0.15 for one step to 1 for a thousand
/// and more. So coming nearer counts for something, and being right for much more.
inline double cost_of(double steps) {
  if (steps < kSameSteps) return 0;
  return std::min(1.0, 0.15 + 0.085 * std::log2(std::max(1.0, steps)));
}

/// What a pixel costs where a fault says that it is wrong but predicts no number: less than a pixel that is a step off.
/// So a fault that predicts numbers comes first unless it leaves much unexplained.
inline constexpr double kAnythingCost = 0.1;

/// The least share of the wrong pixels that a finding must explain.
inline constexpr double kLeastExplained = 1.0 / 3;

/// If fewer pixels than this are wrong, no explanation is looked for.
inline constexpr double kLeastChanged = 8;

/// A difference of more steps is not one that sums in another order, or approximate functions, make.
inline constexpr double kFarOff = 1.5;

/// How many single faults, the likeliest by a few pixels, are tried on the whole sample.
inline constexpr size_t kFinalists = 8;

/// A pixel of the sample. It stands for `weight` pixels of the image.
struct SampledPixel {
  int x = 0, y = 0;
  double weight = 1;
};

/// How well a fault predicts the sampled pixels, in comparison with no fault.
struct Disagreement {
  double cost = 0;          ///< over all sampled pixels, by weight
  double explained = 0;     ///< weight of the pixels that agree under the fault, and do not without it
  double located = 0;       ///< weight of those where the fault predicts no number, and that do not agree without it
  double contradicted = 0;  ///< weight of those that do not agree under the fault, and do without it
};

/// A number as it stands in a fault's name: a whole number with all digits, any other with five significant ones.
std::string parameter_text(double value);

/// The parameter as it stands in a fault's name: the fault's own word for the number, if it has one without spaces,
/// else the number.
template <class Fault>
std::string parameter_word(const Fault& fault, double value) {
  const std::string word = fault.says != nullptr ? fault.says(value) : parameter_text(value);
  return word.find(' ') == std::string::npos ? word : parameter_text(value);
}

/// The name of a fault with its numbers: `light-range=1.01`, `light-moved=3:0.5,0,0`, or the name alone where it has
/// none.
template <class Fault>
std::string fault_name(const Fault& fault, const FaultParameter& parameter) {
  const ParameterForm form = fault.form();
  const std::string name(fault.name);
  return form.any() ? name + "=" + parameter_name(form, parameter, parameter_word(fault, parameter.number)) : name;
}
/// The sentence that describes a fault with its numbers, without its full stop.
template <class Fault>
std::string fault_text(const Fault& fault, const FaultParameter& parameter) {
  const double number = parameter.number;
  return text_with(fault.text, fault.form(), parameter,
                   fault.says != nullptr ? fault.says(number) : parameter_text(number));
}

}  // namespace trueshade::oracle
