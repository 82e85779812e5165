#pragma once
// The numbers of a fault, and how they are written behind its name.
#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace trueshade::oracle {

/// One number; or which light or object, which part of it, and up to three numbers that are the fault's own.
struct FaultParameter {
  double number = 0;
  std::array<double, 3> vector{};
  double part = 0;
  FaultParameter(double n = 0) : number(n) {}  ///< one number, as most faults have
  /// A light or an object, the fault's own numbers, and a part.
  FaultParameter(double of, const std::array<double, 3>& v, double p = 0) : number(of), vector(v), part(p) {}
};

/// Which of the numbers a fault has.
struct ParameterForm {
  bool number = false, part = false;
  int vector = 0;  ///< numbers of the vector
  /// Whether there are numbers at all.
  bool any() const { return number || vector > 0; }
  /// How many numbers there are.
  int count() const { return (number ? 1 : 0) + (part ? 1 : 0) + vector; }
};

/// The numbers as a name has them behind `=`: `3`, `3:0.5,0,0`, `3/2:1` or `1,0`.
///   word: what stands for the number
std::string parameter_name(const ParameterForm& form, const FaultParameter& parameter, const std::string& word);
/// The numbers as lists of faults show them: `N`, `N:X,Y,Z`, `N/P:X` or `X,Y`; empty where there are none.
std::string listed_parameter(const ParameterForm& form);

/// Reads what parameter_name() writes of numbers. Nothing where the text is another, a number is NaN, or one is beyond
/// 1e9 in size.
std::optional<FaultParameter> parameter_of_name(const ParameterForm& form, std::string_view text);

/// A fault's text with its numbers in place of `%s` (`word`), `%p` (the part) and `%v` (the vector), each once.
std::string text_with(std::string_view text, const ParameterForm& form, const FaultParameter& parameter,
                      const std::string& word);

}  // namespace trueshade::oracle
