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
  FaultParameter(double n = 0) : number(n) {}  // most faults have one number
  FaultParameter(double of, const std::array<double, 3>& v, double p = 0) : number(of), vector(v), part(p) {}
};

/// Which of the numbers a fault has.
struct ParameterForm {
  bool number = false, part = false;
  int vector = 0;  ///< numbers of the vector
  bool any() const { return number || vector > 0; }
  int count() const { return (number ? 1 : 0) + (part ? 1 : 0) + vector; }
};

/// `N`, `N:X,Y,Z`, `N/P:X` or `X,Y`: as a name has them behind `=`, and as lists of faults show them.
///   word: what stands for the number
std::string parameter_name(const ParameterForm& form, const FaultParameter& parameter, const std::string& word);
std::string listed_parameter(const ParameterForm& form);

/// Reads what parameter_name() writes; nothing where the text is another. Numbers within 1e9.
std::optional<FaultParameter> parameter_of_name(const ParameterForm& form, std::string_view text);

/// Puts the numbers for `%s`, `%p` and `%v`.
std::string text_with(std::string_view text, const ParameterForm& form, const FaultParameter& parameter,
                      const std::string& word);

}  // namespace trueshade::oracle
