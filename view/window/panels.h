#pragma once
#include "view/frame_times.h"
#include "view/session.h"
#include "view/window/placement.h"
#include "view/window/style.h"

namespace trueshade::viewer {

/// What panels are drawn from.
struct PanelContext {
  Session& session;
  const Fonts& fonts;
  const FrameTimes& times;
  const DrawnPicture& picture;  ///< the one that is shown
  PicturePlace place;
  float scale;          ///< of texts and panels
  float width, height;  ///< of the window

  float size(float pixels) const { return pixels * scale; }
  float bar_height() const { return float(bar_rows(double(scale))); }
  float panel_width() const { return size(332.0f); }
};

// Each draws a part of the window by ImGui.
void draw_bar(const PanelContext& context);           ///< below: preset, view, time, panels
void draw_status(const PanelContext& context);        ///< top left: what is shown, how fast, its hash
void draw_notice(const PanelContext& context);        ///< what happened last
void draw_broken_model(const PanelContext& context);  ///< why the light model's file is none, for as long as it is
void draw_marks(const PanelContext& context);         ///< over the picture: the clicked pixel, the selected light
void draw_scale(const PanelContext& context);         ///< left: what the colours of a heat map stand for
void draw_panel(const PanelContext& context);         ///< at the right: the one that is open
void draw_help(const PanelContext& context);

// The panels' contents.
void draw_picture_panel(const PanelContext& context);
void draw_lights_panel(const PanelContext& context);
void draw_pixel_panel(const PanelContext& context);
void draw_statistics_panel(const PanelContext& context);
void draw_model_panel(const PanelContext& context);

/// A list of names to choose one of; the index of the chosen one, where another was chosen.
template <typename Names>
std::optional<size_t> choice(const char* id, const Names& names, size_t now, float width) {
  std::optional<size_t> chosen;
  ImGui::SetNextItemWidth(width);
  if (!ImGui::BeginCombo(id, std::string(names[now]).c_str(), ImGuiComboFlags_HeightLarge)) return chosen;
  for (size_t i = 0; i < std::size(names); ++i) {
    if (ImGui::Selectable(std::string(names[i]).c_str(), i == now)) chosen = i;
    if (i == now) ImGui::SetItemDefaultFocus();
  }
  ImGui::EndCombo();
  return chosen;
}

/// The names of all presets, and the place of one among them.
std::vector<std::string_view> preset_names();
size_t preset_index(std::string_view name);

/// A name at the left of a row; what follows stands at the right.
void row_name(const PanelContext& context, const char* name);
/// A heading over rows.
void heading(const PanelContext& context, const char* text);

}  // namespace trueshade::viewer
