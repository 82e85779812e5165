#include <cstdio>

#include "scenes/pipeline/presets.h"
#include "view/window/panels.h"

namespace trueshade::viewer {
namespace {

/// A button with a triangle or two bars.
bool play_button(const PanelContext& context, bool plays) {
  const float side = ImGui::GetFrameHeight();
  const bool pressed = ImGui::Button("##play", {side, side});
  const ImVec2 a = ImGui::GetItemRectMin();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float unit = side / 4.0f;
  if (plays) {
    list.AddRectFilled({a.x + 1.1f * unit, a.y + unit}, {a.x + 1.7f * unit, a.y + 3 * unit}, kText);
    list.AddRectFilled({a.x + 2.3f * unit, a.y + unit}, {a.x + 2.9f * unit, a.y + 3 * unit}, kText);
  } else {
    list.AddTriangleFilled({a.x + 1.3f * unit, a.y + unit}, {a.x + 3.0f * unit, a.y + 2 * unit},
                           {a.x + 1.3f * unit, a.y + 3 * unit}, kText);
  }
  (void)context;
  return pressed;
}

void draw_time(const PanelContext& context, float width) {
  Session& session = context.session;
  if (!session.has_time()) return;
  if (play_button(context, session.plays())) session.play(!session.plays());
  ImGui::SameLine();
  auto time = float(session.state().time);
  ImGui::SetNextItemWidth(width - ImGui::GetFrameHeight() - ImGui::GetStyle().ItemSpacing.x);
  if (ImGui::SliderFloat("##time", &time, 0.0f, float(session.last_time()), "%.2f s", ImGuiSliderFlags_AlwaysClamp))
    session.set_time(double(time));
  ImGui::SameLine();
}

struct PanelButton {
  Panel panel;
  Action action;
  /// The panel's name with a capital.
  std::string label() const {
    std::string name(kPanelNames[size_t(panel)]);
    name.front() = char(name.front() - 'a' + 'A');
    return name;
  }
};

constexpr PanelButton kPanelButtons[] = {{Panel::picture, Action::picture_panel},
                                         {Panel::lights, Action::lights_panel},
                                         {Panel::pixel, Action::pixel_panel},
                                         {Panel::statistics, Action::statistics_panel},
                                         {Panel::model, Action::model_panel}};
constexpr const char* kHelp = "?";

void draw_panel_button(const PanelContext& context, const PanelButton& button) {
  const auto& [panel, action] = button;
  const bool open = context.session.desk().panel == panel;
  if (open) ImGui::PushStyleColor(ImGuiCol_Text, kAccent);
  if (ImGui::Button(button.label().c_str())) context.session.act(action);
  if (open) ImGui::PopStyleColor();
  ImGui::SameLine();
}

float width_of_button(const std::string& label) {
  const ImGuiStyle& style = ImGui::GetStyle();
  return ImGui::CalcTextSize(label.c_str()).x + 2 * style.FramePadding.x + style.ItemSpacing.x;
}

}  // namespace

std::vector<std::string_view> preset_names() {
  std::vector<std::string_view> names;
  for (const Preset& preset : presets()) names.push_back(preset.name);
  return names;
}

size_t preset_index(std::string_view name) {
  const std::vector<std::string_view> names = preset_names();
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? 0 : size_t(found - names.begin());
}

void draw_bar(const PanelContext& context) {
  Session& session = context.session;
  ImGui::SetNextWindowPos({0.0f, context.height - context.bar_height()});
  ImGui::SetNextWindowSize({context.width, context.bar_height()});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.0f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding,
                      {context.size(10), (context.bar_height() - ImGui::GetFrameHeight()) / 2});
  ImGui::Begin("bar", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoNav);
  const Pipeline& pipeline = session.state().pipeline;
  const std::vector<std::string_view> names = preset_names();
  if (const auto chosen = choice("##preset", names, preset_index(pipeline.preset), context.size(128)))
    session.set_preset(names[*chosen]);
  ImGui::SameLine();
  if (const auto chosen = choice("##view", kViewNames, size_t(pipeline.view), context.size(104))) {
    Pipeline other = pipeline;
    other.view = ImageView(*chosen);
    session.set_pipeline(other);
  }
  ImGui::SameLine();
  float buttons = context.size(4) + width_of_button(kHelp);
  for (const PanelButton& button : kPanelButtons) buttons += width_of_button(button.label());
  const float room = context.width - buttons - ImGui::GetCursorPosX() - context.size(14);
  if (room > context.size(110)) draw_time(context, std::min(room, context.size(420)));
  ImGui::SetCursorPosX(std::max(ImGui::GetCursorPosX(), context.width - buttons));
  for (const PanelButton& button : kPanelButtons) draw_panel_button(context, button);
  if (ImGui::Button(kHelp)) session.act(Action::help);
  ImGui::End();
  ImGui::PopStyleVar(3);
}

}  // namespace trueshade::viewer
