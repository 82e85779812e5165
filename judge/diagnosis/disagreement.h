#pragma once
// How far a capture is from what faults predict of it.
#include <algorithm>
#include <cmath>
#include <string>

#include "judge/diagnosis/fault_parameter.h"

namespace trueshade::oracle {

/// Two values agree if they differ by less than so many steps of what the plane stores.
inline constexpr double kSameSteps = 0.5;

/// What a disagreement of so many steps costs: nothing below kSameSteps, else from 0.15 for one step to 1 for a
/// thousand and more. Coming nearer counts for something, being right for much more.
inline double cost_of(double steps) {
  if (steps < kSameSteps) return 0;
  return std::min(1.0, 0.15 + 0.085 * std::log2(std::max(1.0, steps)));
}

/// What a pixel costs where a fault predicts no number: less than a pixel that is a step off, and more than one that
/// agrees, which costs 0. So a fault that predicts numbers comes first unless it leaves much unexplained.
inline constexpr double kAnythingCost = 0.1;

/// The share of the pixels that are wrong which a finding explains at least.
inline constexpr double kLeastExplained = 1.0 / 3;

/// Pixels that are wrong, below which there is nothing to explain.
inline constexpr double kLeastChanged = 8;

/// Steps beyond what sums in another order and estimates leave.
inline constexpr double kFarOff = 1.5;

/// Single faults, the likeliest by a few pixels, that are judged by the whole sample.
inline constexpr size_t kFinalists = 8;

/// A pixel of the sample. It stands for `weight` pixels of the image.
struct SampledPixel {
  int x = 0, y = 0;
  double weight = 1;
};

/// Pixels that agree with a prediction, and what the others cost.
struct Disagreement {
  double cost = 0;          ///< over all sampled pixels, by weight
  double explained = 0;     ///< weight of the pixels that agree under the fault, and do not without it
  double located = 0;       ///< weight of those where the fault predicts no number, and that do not agree without it
  double contradicted = 0;  ///< weight of those that do not agree under the fault, and do without it
};

/// A number as a fault's name has it: a whole one with all its digits, others with at most five that count.
std::string parameter_text(double value);

/// The parameter of a fault as its name has it: the fault's word for it where that has no spaces, else the number.
template <class Fault>
std::string parameter_word(const Fault& fault, double value) {
  const std::string word = fault.says != nullptr ? fault.says(value) : parameter_text(value);
  return word.find(' ') == std::string::npos ? word : parameter_text(value);
}

/// A fault with its numbers as a name: `light-range=1.01`, `light-moved=3:0.5,0,0`, or the name alone where it has
/// none.
template <class Fault>
std::string fault_name(const Fault& fault, const FaultParameter& parameter) {
  const ParameterForm form = fault.form();
  const std::string name(fault.name);
  return form.any() ? name + "=" + parameter_name(form, parameter, parameter_word(fault, parameter.number)) : name;
}
/// A fault with its numbers as a sentence, without its full stop.
template <class Fault>
std::string fault_text(const Fault& fault, const FaultParameter& parameter) {
  const double number = parameter.number;
  return text_with(fault.text, fault.form(), parameter,
                   fault.says != nullptr ? fault.says(number) : parameter_text(number));
}

}  // namespace trueshade::oracle
