// The light model that the picture is drawn by, and its parameters.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "scenes/pipeline/program_inputs.h"
#include "scenes/pipeline/shipped_models.h"
#include "view/window/panels.h"

namespace trueshade::viewer {
namespace {

constexpr const char* kFormula = "the preset's formula";

/// A dim text that is wrapped at the panel's edge.
void tell(const char* text) {
  ImGui::PushStyleColor(ImGuiCol_Text, kDim);
  ImGui::TextWrapped("%s", text);
  ImGui::PopStyleColor();
}

/// "Cloth" of "Cloth: its source".
std::string first_clause(std::string_view about) { return std::string(about.substr(0, about.find(':'))) + '.'; }

void draw_choice(const PanelContext& context) {
  Session& session = context.session;
  const std::string& file = session.state().pipeline.light_program.file;
  std::vector<std::string_view> names = {kFormula};
  if (!session.model_file().empty()) names.push_back(session.model_file());
  for (const ShippedModel& model : shipped_models()) names.push_back(model.name);
  const auto now = std::find(names.begin(), names.end(), file);
  const size_t index = now == names.end() ? 0 : size_t(now - names.begin());
  const float width = ImGui::GetContentRegionAvail().x;
  if (const auto chosen = choice("##model", names, index, width))
    session.set_model(*chosen == 0 ? std::string() : std::string(names[*chosen]));
  if (file.empty())
    return tell("A light model takes the formula's place: one of these, or a file given as --light-shader.");
  if (file != session.model_file()) return tell(first_clause(shipped_model(file).about).c_str());
  tell("Saved changes of this file are drawn at once.");
}

/// Whether a hand has changed the numbers.
bool draw_numbers(const ModelParameter& parameter, std::vector<float>& value) {
  const float farthest = parameter.is_float ? 1e18f : kLargestWholeParameter;
  const int count = int(value.size());
  const auto& range = parameter.range;
  const float least = range ? float(range->least) : parameter.is_signed ? -farthest : 0.0f;
  const float most = range && std::isfinite(range->most) ? float(range->most) : farthest;
  const char* const format = parameter.is_float ? "%.4g" : "%.0f";
  if (range && std::isfinite(range->most))
    return ImGui::SliderScalarN("##value", ImGuiDataType_Float, value.data(), count, &least, &most, format,
                                ImGuiSliderFlags_AlwaysClamp);
  const float largest = std::accumulate(value.begin(), value.end(), 0.0f,
                                        [](float most_yet, float one) { return std::max(most_yet, std::fabs(one)); });
  const float speed = parameter.is_float ? std::max(largest, 0.1f) / 100.0f : 0.05f;  // a step a pixel
  return ImGui::DragScalarN("##value", ImGuiDataType_Float, value.data(), count, speed, &least, &most, format,
                            ImGuiSliderFlags_AlwaysClamp);
}

void draw_parameter(const PanelContext& context, const ModelParameter& parameter) {
  Session& session = context.session;
  const std::vector<ProgramParameter>& all = session.state().pipeline.light_program.parameters;
  const auto known = std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.name == parameter.name; });
  if (known == all.end()) return;
  std::vector<float> value = known->value;
  ImGui::PushID(parameter.name.c_str());
  row_name(context, parameter.name.c_str());
  if (ImGui::CalcTextSize(parameter.name.c_str()).x > context.size(84)) ImGui::NewLine();
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
  if (draw_numbers(parameter, value)) {
    if (!parameter.is_float)
      for (float& one : value) one = std::round(one);
    session.set_parameter(parameter.name, value);
  }
  ImGui::PopID();
}

}  // namespace

void draw_model_panel(const PanelContext& context) {
  Session& session = context.session;
  heading(context, "Light model");
  draw_choice(context);
  if (session.state().pipeline.light_program.file.empty()) return;
  heading(context, "Parameters");
  if (session.parameters().empty()) tell("It has none: a uniform block Parameters would name them.");
  const std::vector<ModelParameter> parameters = session.parameters();  // a copy: what is set makes them anew
  for (const ModelParameter& parameter : parameters) draw_parameter(context, parameter);
}

}  // namespace trueshade::viewer
