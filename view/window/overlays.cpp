// What lies over the picture: status, notices, marks, the page of keys.
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/vec4.hpp>

#include "shading/output/heat_map.h"
#include "view/window/panels.h"

namespace trueshade::viewer {
namespace {

constexpr ImGuiWindowFlags kOverlay = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                                      ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoNav |
                                      ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoSavedSettings;

/// Pictures a second over the last half second of what was shown.
double rate_of(const FrameTimes& times) {
  double ms = 0.0;
  int count = 0;
  for (auto shown = times.shown().rbegin(); shown != times.shown().rend() && ms < 500.0; ++shown, ++count)
    ms += (*shown)[Part::interval];
  return ms > 0.0 ? 1000.0 * count / ms : 0.0;
}

/// Where a point of the world is in the window; nothing behind the camera.
std::optional<ImVec2> in_window(const PanelContext& context, const glm::vec3& point) {
  const Pipeline& pipeline = context.picture.pipeline;
  const Matrix4 m = clip_from_world(context.picture.camera, double(pipeline.width) / pipeline.height);
  double clip[4];
  for (size_t r = 0; r < 4; ++r)
    clip[r] = m[r] * double(point.x) + m[4 + r] * double(point.y) + m[8 + r] * double(point.z) + m[12 + r];
  if (!(clip[3] > 0.0)) return std::nullopt;
  const double x = (clip[0] / clip[3] + 1.0) / 2.0, y = (1.0 - clip[1] / clip[3]) / 2.0;
  return ImVec2(float(context.place.x + x * context.place.width), float(context.place.y + y * context.place.height));
}

}  // namespace

void row_name(const PanelContext& context, const char* name) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kDim), "%s", name);
  ImGui::SameLine(context.size(104));
}

void heading(const PanelContext& context, const char* text) {
  ImGui::Dummy({0, context.size(2)});
  ImGui::PushFont(context.fonts.bold);
  ImGui::TextUnformatted(text);
  ImGui::PopFont();
}

void draw_status(const PanelContext& context) {
  Session& session = context.session;
  const Image& image = context.picture.frame.color;
  ImGui::SetNextWindowPos({context.size(10), context.size(10)});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {context.size(10), context.size(6)});
  ImGui::Begin("status", nullptr, kOverlay);
  ImGui::PushFont(context.fonts.bold);
  ImGui::TextUnformatted(session.facts().name.c_str());
  ImGui::PopFont();
  ImGui::SameLine();
  ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kDim), "%d \xC3\x97 %d", image.width, image.height);
  ImGui::SameLine();
  ImGui::Text("%.1f ms", context.picture.draw_ms);
  const std::string hash = session.hash();
  if (!hash.empty()) {
    ImGui::SameLine();
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kDim), "sha256 %s\xE2\x80\xA6", hash.substr(0, 12).c_str());
  } else if (session.moves()) {
    ImGui::SameLine();
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kDim), "%.0f a second", rate_of(context.times));
  }
  if (session.state().exposure != 0.0 && !session.state().pipeline.light_program.used()) {
    ImGui::SameLine();
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kAccent), "%+.1f stops", session.state().exposure);
  }
  ImGui::End();
  ImGui::PopStyleVar();
}

void draw_notice(const PanelContext& context) {
  const std::optional<Notice>& notice = context.session.notice();
  if (!notice) return;
  const float wrap = std::min(context.width - context.size(60), context.size(720));
  ImGui::SetNextWindowPos({context.size(10), context.height - context.bar_height() - context.size(10)}, 0,
                          {0.0f, 1.0f});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {wrap, context.height});
  ImGui::Begin("notice", nullptr, kOverlay);
  ImGui::PushTextWrapPos(wrap - context.size(20));
  ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(notice->problem ? kBad : kText), "%s", notice->text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::End();
}

void draw_broken_model(const PanelContext& context) {
  const std::optional<BrokenModel>& broken = context.session.broken_model();
  if (!broken) return;
  const float beside = context.session.desk().panel == Panel::none ? 0.0f : context.panel_width();
  const float width =
      std::max(std::min(context.width - beside - context.size(30), context.size(640)), context.size(240));
  ImGui::SetNextWindowPos({context.size(10), context.size(52)});
  ImGui::SetNextWindowSizeConstraints({width, 0}, {width, context.height});
  ImGui::PushStyleColor(ImGuiCol_WindowBg, IM_COL32(17, 19, 23, 244));
  ImGui::PushStyleColor(ImGuiCol_Border, (kBad & ~IM_COL32_A_MASK) | IM_COL32(0, 0, 0, 150));
  ImGui::Begin("broken", nullptr, kOverlay);
  ImGui::PushTextWrapPos(width - context.size(12));
  ImGui::PushFont(context.fonts.bold);
  ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kBad), "The light model does not compile");
  ImGui::PopFont();
  ImGui::PushFont(context.fonts.mono);
  ImGui::TextUnformatted(broken->reason.c_str());
  if (!broken->line.empty()) ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kAccent), "%s", broken->line.c_str());
  ImGui::PopFont();
  ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kDim), "The picture is drawn by the last version that did.");
  ImGui::PopTextWrapPos();
  ImGui::End();
  ImGui::PopStyleColor(2);
}

void draw_marks(const PanelContext& context) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  Session& session = context.session;
  if (const std::optional<PixelCard>& card = session.card(); card && session.desk().panel == Panel::pixel) {
    const float x = float(context.place.x + (card->x + 0.5) * context.place.scale),
                y = float(context.place.y + (card->y + 0.5) * context.place.scale);
    const float near = context.size(5), far = context.size(14);
    for (const auto& [dx, dy] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}})
      for (const auto& [color, thick] : {std::pair(IM_COL32(0, 0, 0, 160), 3.0f), {IM_COL32(255, 255, 255, 230), 1.0f}})
        list.AddLine({x + float(dx) * near, y + float(dy) * near}, {x + float(dx) * far, y + float(dy) * far}, color,
                     thick);
  }
  const std::optional<uint32_t> light = session.desk().selected_light;
  if (!light || *light >= context.picture.lights.size()) return;
  const Light& shown = context.picture.lights[*light];
  if (!is_placed(shown.type)) return;
  if (const auto at = in_window(context, shown.position)) {
    list.AddCircle(*at, context.size(9), IM_COL32(0, 0, 0, 160), 24, context.size(3.5f));
    list.AddCircle(*at, context.size(9), kAccent, 24, context.size(1.5f));
  }
}

void draw_scale(const PanelContext& context) {
  const uint32_t top = context.picture.frame.view_scale;
  if (top == 0) return;
  const float x = context.size(20), y = context.size(58), width = context.size(12), edge = context.size(10);
  const int rows = int(context.size(128));
  const float line = ImGui::GetTextLineHeight();
  const auto label = [&](uint32_t count) { return std::to_string(count); };
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float right = x + width + context.size(8) + ImGui::CalcTextSize(label(top).c_str()).x + edge;
  list.AddRectFilled({x - edge, y - edge}, {right, y + float(rows) + edge}, kPaper, context.size(6));
  for (int row = 0; row < rows; ++row) {
    const std::array<uint8_t, 3> rgb = heat_color(256 - 256 * row / (rows - 1));
    list.AddRectFilled({x, y + float(row)}, {x + width, y + float(row + 1)}, IM_COL32(rgb[0], rgb[1], rgb[2], 255));
  }
  const auto write = [&](uint32_t count, float at) {
    list.AddText({x + width + context.size(8), std::floor(at)}, kText, label(count).c_str());
  };
  write(top, y - line * 0.2f);
  if (top > 1) write(top / 2, y + (float(rows) - line) * 0.5f);
  write(0, y + float(rows) - line * 0.8f);
}

void draw_help(const PanelContext& context) {
  if (!context.session.desk().help) return;
  ImGui::SetNextWindowPos({context.width / 2, context.height / 2}, 0, {0.5f, 0.5f});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {context.size(22), context.size(18)});
  ImGui::PushStyleColor(ImGuiCol_WindowBg, IM_COL32(17, 19, 23, 252));
  ImGui::Begin("help", nullptr, kOverlay);
  ImGui::PushFont(context.fonts.bold);
  ImGui::TextUnformatted("Keys and mouse");
  ImGui::PopFont();
  ImGui::Dummy({0, context.size(4)});
  const auto line = [&](std::string_view keys, std::string_view about) {
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kAccent), "%.*s", int(keys.size()), keys.data());
    ImGui::SameLine(context.size(150));
    ImGui::TextUnformatted(about.data(), about.data() + about.size());
  };
  line("Drag", "look around");
  line("Alt drag, middle drag", "orbit");
  line("Wheel", "fly faster, slower; with Alt nearer, farther");
  line("Click", "explain a pixel");
  for (const Key& key : keys())
    if (!key.shown.empty()) line(key.shown, key.about);
  ImGui::End();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar();
}

void draw_panel(const PanelContext& context) {
  const Panel panel = context.session.desk().panel;
  if (panel == Panel::none) return;
  const float width = std::min(panel == Panel::pixel ? context.size(380) : context.panel_width(), context.width * 0.6f);
  ImGui::SetNextWindowPos({context.width - width - context.size(10), context.size(10)});
  const float room = context.height - context.bar_height() - context.size(20);
  ImGui::SetNextWindowSizeConstraints({width, 0}, {width, room});
  if (panel == Panel::pixel || panel == Panel::lights) ImGui::SetNextWindowSize({width, room});
  ImGui::Begin(std::string(kPanelNames[size_t(panel)]).c_str(), nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoNav |
                   (panel == Panel::pixel || panel == Panel::lights ? 0 : ImGuiWindowFlags_AlwaysAutoResize));
  switch (panel) {
    case Panel::picture:
      draw_picture_panel(context);
      break;
    case Panel::lights:
      draw_lights_panel(context);
      break;
    case Panel::pixel:
      draw_pixel_panel(context);
      break;
    case Panel::statistics:
      draw_statistics_panel(context);
      break;
    case Panel::model:
      draw_model_panel(context);
      break;
    case Panel::none:
      break;
  }
  ImGui::End();
}

}  // namespace trueshade::viewer
