#include <cstdio>

#include "view/window/panels.h"

namespace trueshade::viewer {
namespace {

/// A colour as a swatch has it: of full brightness.
ImVec4 swatch_of(const glm::vec3& color) {
  const float most = std::max({color.x, color.y, color.z, 1e-30f});
  return {color.x / most, color.y / most, color.z / most, 1.0f};
}

void draw_row(const PanelContext& context, uint32_t index) {
  Session& session = context.session;
  const Light& light = session.facts().lights[index];
  const LightChange* const known = session.change_of(index);
  LightChange change = known != nullptr ? *known : LightChange{index};
  ImGui::PushID(int(index));
  bool on = change.on;
  if (ImGui::Checkbox("##on", &on)) {
    change.on = on;
    session.change_light(change);
  }
  ImGui::SameLine();
  const float side = ImGui::GetFrameHeight();
  ImGui::ColorButton("##color", swatch_of(change.color ? *change.color : light.color),
                     ImGuiColorEditFlags_NoTooltip | ImGuiColorEditFlags_NoPicker, {side, side});
  ImGui::SameLine();
  char name[64];
  std::snprintf(name, sizeof name, "%u  %s%s", index, name_of(light.type).data(),
                known != nullptr ? "  \xE2\x80\xA2" : "");
  const bool selected = session.desk().selected_light == index;
  ImGui::AlignTextToFramePadding();
  if (ImGui::Selectable(name, selected, 0, {0, side})) session.desk().selected_light = index;
  ImGui::PopID();
  (void)context;
}

/// The colour of a light as hue at full brightness, and how bright it is: colours of light have no upper end.
void draw_color(const PanelContext& context, const Light& light, LightChange& change, bool& changed) {
  const glm::vec3 now = change.color ? *change.color : light.color;
  const float brightness = std::max({now.x, now.y, now.z});
  const ImVec4 full = swatch_of(now);
  float rgb[3] = {full.x, full.y, full.z};
  row_name(context, "Colour");
  if (ImGui::ColorEdit3("##rgb", rgb, ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_Float)) {
    const auto share = [](float typed) { return std::clamp(typed, 0.0f, 1.0f); };
    change.color = glm::vec3(share(rgb[0]), share(rgb[1]), share(rgb[2])) * (brightness > 0.0f ? brightness : 1.0f);
    changed = true;
  }
  ImGui::SameLine();
  ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kDim), "%.3g  %.3g  %.3g", double(now.x), double(now.y),
                     double(now.z));
}

void draw_editor(const PanelContext& context, uint32_t index) {
  Session& session = context.session;
  const Light& light = session.facts().lights[index];
  const LightChange* const known = session.change_of(index);
  LightChange change = known != nullptr ? *known : LightChange{index};
  bool changed = false;
  char title[64];
  std::snprintf(title, sizeof title, "Light %u, %s", index, name_of(light.type).data());
  heading(context, title);
  const float width = ImGui::GetContentRegionAvail().x - context.size(104) + ImGui::GetStyle().WindowPadding.x;
  draw_color(context, light, change, changed);
  auto intensity = float(change.intensity.value_or(1.0));
  row_name(context, "Intensity");
  ImGui::SetNextItemWidth(width);
  if (ImGui::SliderFloat("##intensity", &intensity, 0.0f, 20.0f, "\xC3\x97 %.2f", ImGuiSliderFlags_Logarithmic)) {
    change.intensity = std::clamp(double(intensity), 0.0, 1e18);  // one that was typed may be over 20
    changed = true;
  }
  if (is_placed(light.type)) {
    const bool drawn = index < context.picture.lights.size();
    glm::vec3 position = change.position ? *change.position
                         : drawn         ? context.picture.lights[index].position
                                         : light.position;
    row_name(context, "Position");
    ImGui::SetNextItemWidth(width);
    constexpr float kFarthest = 1e18f;
    if (ImGui::DragFloat3("##position", &position.x, float(session.facts().reach / 500.0), -kFarthest, kFarthest,
                          "%.4g", ImGuiSliderFlags_AlwaysClamp)) {
      change.position = position;
      changed = true;
    }
  }
  if (changed) session.change_light(change);
  if (known != nullptr && ImGui::Button("Reset this light")) session.reset_light(index);
}

}  // namespace

void draw_lights_panel(const PanelContext& context) {
  Session& session = context.session;
  const auto count = uint32_t(session.facts().lights.size());
  char title[64];
  std::snprintf(title, sizeof title, "%u lights", count);
  heading(context, title);
  if (!session.state().changes.empty()) {
    ImGui::SameLine();
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kAccent), "%d changed", int(session.state().changes.size()));
    ImGui::SameLine();
    if (ImGui::SmallButton("reset all")) session.reset_lights();
  }
  std::optional<uint32_t>& selected = session.desk().selected_light;
  if (selected && *selected >= count) selected.reset();
  const float editor = selected ? context.size(164) : 0.0f;
  ImGui::BeginChild("list", {0, ImGui::GetContentRegionAvail().y - editor});
  ImGuiListClipper clipper;
  clipper.Begin(int(count));
  while (clipper.Step())
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) draw_row(context, uint32_t(i));
  ImGui::EndChild();
  if (selected) {
    ImGui::Separator();
    draw_editor(context, *selected);
  }
}

}  // namespace trueshade::viewer
