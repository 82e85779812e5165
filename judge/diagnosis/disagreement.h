#pragma once
// How far what was given is from what is predicted.
#include <algorithm>
#include <cmath>
#include <string>

#include "judge/diagnosis/fault_parameter.h"

namespace trueshade::oracle {

/// Beyond this many steps of what a plane stores a value is another one.
inline constexpr double kSameSteps = 0.5;

/// What a disagreement of so many steps costs: nothing, or from 0.15 for one step to 1 for a thousand. Coming nearer
/// counts for something, being right for much more.
inline double cost_of(double steps) {
  if (steps < kSameSteps) return 0;
  return std::min(1.0, 0.15 + 0.085 * std::log2(std::max(1.0, steps)));
}

/// What a pixel costs of which a fault predicts no number: less than one that is a step off, far more than one that is
/// predicted. So a fault that predicts numbers comes first unless it leaves much unexplained.
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
  double explained = 0;     ///< weight of the pixels that agree, of those that do not without the fault
  double located = 0;       ///< weight of those of which no number is predicted, of those that do not agree without it
  double contradicted = 0;  ///< weight of those that do not agree, of those that do without it
};

/// A number as a fault's name has it: a whole one with all its digits, others with at most five that count.
std::string parameter_text(double value);

/// The parameter of a fault as its name has it: a word, where there is one without spaces.
template <class Fault>
std::string parameter_word(const Fault& fault, double value) {
  const std::string word = fault.says != nullptr ? fault.says(value) : parameter_text(value);
  return word.find(' ') == std::string::npos ? word : parameter_text(value);
}

/// A fault with its numbers: `light-range=1.01`, `light-moved=3:0.5,0,0`; and in a sentence.
template <class Fault>
std::string fault_name(const Fault& fault, const FaultParameter& parameter) {
  const ParameterForm form = fault.form();
  const std::string name(fault.name);
  return form.any() ? name + "=" + parameter_name(form, parameter, parameter_word(fault, parameter.number)) : name;
}
template <class Fault>
std::string fault_text(const Fault& fault, const FaultParameter& parameter) {
  const double number = parameter.number;
  return text_with(fault.text, fault.form(), parameter,
                   fault.says != nullptr ? fault.says(number) : parameter_text(number));
}

}  // namespace trueshade::oracle
