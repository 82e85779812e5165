#include "judge/diagnosis/fault_parameter.h"

#include <cmath>
#include <cstdlib>

#include "judge/diagnosis/disagreement.h"

namespace trueshade::oracle {

namespace {

std::string vector_text(const ParameterForm& form, const FaultParameter& parameter, const char* between) {
  std::string text;
  for (int k = 0; k < form.vector; ++k) text += (k > 0 ? between : "") + parameter_text(parameter.vector[size_t(k)]);
  return text;
}

}  // namespace

std::string parameter_name(const ParameterForm& form, const FaultParameter& parameter, const std::string& word) {
  std::string name = form.number ? word : "";
  if (form.part) name += "/" + parameter_text(parameter.part);
  if (form.vector > 0) name += (form.number ? ":" : "") + vector_text(form, parameter, ",");
  return name;
}

std::string listed_parameter(const ParameterForm& form) {
  constexpr const char* kAxes[] = {"", "X", "X,Y", "X,Y,Z"};
  std::string listed = form.number ? "N" : "";
  if (form.part) listed += "/P";
  if (form.vector > 0) listed += (form.number ? ":" : "") + std::string(kAxes[form.vector]);
  return listed;
}

std::optional<FaultParameter> parameter_of_name(const ParameterForm& form, std::string_view text) {
  constexpr double kMost = 1e9;
  const std::string copy(text);
  const char* at = copy.c_str();
  bool first = true;
  const auto read = [&](double& number, char before) {
    if (!first && *at++ != before) return false;
    first = false;
    char* end = nullptr;
    number = std::strtod(at, &end);
    const bool fits = end != at && std::fabs(number) <= kMost;  // not a number: no
    at = end;
    return fits;
  };
  FaultParameter parameter;
  if (form.number && !read(parameter.number, '\0')) return std::nullopt;
  if (form.part && !read(parameter.part, '/')) return std::nullopt;
  for (int k = 0; k < form.vector; ++k)
    if (!read(parameter.vector[size_t(k)], k == 0 ? ':' : ',')) return std::nullopt;
  if (*at != '\0') return std::nullopt;
  return parameter;
}

std::string text_with(std::string_view text, const ParameterForm& form, const FaultParameter& parameter,
                      const std::string& word) {
  std::string out(text);
  const auto put = [&out](const char* mark, const std::string& with) {
    if (const size_t at = out.find(mark); at != std::string::npos) out.replace(at, 2, with);
  };
  put("%s", word), put("%p", parameter_text(parameter.part));
  const std::string vector = vector_text(form, parameter, ", ");
  put("%v", form.vector > 1 ? "(" + vector + ")" : vector);
  return out;
}

}  // namespace trueshade::oracle
