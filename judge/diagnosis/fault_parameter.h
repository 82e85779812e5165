#pragma once
// The numbers of a fault, and how they are written behind its name.
#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace trueshade::oracle {

/// The numbers of one fault: one number; or a light or object, a part of it, and up to three further numbers.
struct FaultParameter {
  double number = 0;
  std::array<double, 3> vector{};
  double part = 0;
  FaultParameter(double n = 0) : number(n) {}  ///< one number, as most faults have
  /// `of`: the index of a light or object; `v`: the fault's own numbers; `p`: the part.
  FaultParameter(double of, const std::array<double, 3>& v, double p = 0) : number(of), vector(v), part(p) {}
};

/// Which numbers the parameter of a fault has.
struct ParameterForm {
  bool number = false, part = false;
  int vector = 0;  ///< numbers of the vector
  /// Whether the fault has any number.
  bool any() const { return number || vector > 0; }
  /// How many numbers the fault has.
  int count() const { return (number ? 1 : 0) + (part ? 1 : 0) + vector; }
};

/// The numbers as they stand behind `=` in a fault's name: `3`, `3:0.5,0,0`, `3/2:1` or `1,0`.
///   word: what stands for FaultParameter::number
std::string parameter_name(const ParameterForm& form, const FaultParameter& parameter, const std::string& word);
/// The form of the numbers in lists of faults: `N`, `N:X,Y,Z`, `N/P:X` or `X,Y`; empty where the fault has none.
std::string listed_parameter(const ParameterForm& form);

/// Reads the text that parameter_name() writes. Nothing for any other text, for NaN, and for a number beyond 1e9 in
/// size.
std::optional<FaultParameter> parameter_of_name(const ParameterForm& form, std::string_view text);

/// A fault's sentence with its numbers put in, each once: `word` for `%s`, the part for `%p`, the vector for `%v`.
std::string text_with(std::string_view text, const ParameterForm& form, const FaultParameter& parameter,
                      const std::string& word);

}  // namespace trueshade::oracle
