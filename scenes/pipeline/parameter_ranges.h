#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace trueshade {

/// Which values a parameter of a light program is made for, ends included.
struct ParameterRange {
  double least, most;                  ///< most may be infinite
  std::optional<float> usual{};        ///< what it is where nothing gives it
  bool holds(float value) const { return value >= float(least) && value <= float(most); }
  std::string text() const;  ///< "0 to 1", "from 1"
};

/// A member of a program's block Parameters.
struct DeclaredParameter {
  std::string name;
  std::optional<ParameterRange> range;
};

/// Those that a program's text declares, in its order. A comment behind members that begins "// 0 to 1" or "// from 1"
/// states their range, and with ", usually 4" behind that what they are where nothing gives them; others state neither.
std::vector<DeclaredParameter> declared_parameters(std::string_view text);

/// The range of one; null where the text states none.
const ParameterRange* range_of(const std::vector<DeclaredParameter>& declared, std::string_view name);

}  // namespace trueshade
