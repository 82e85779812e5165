#include <cstdio>

#include "view/window/panels.h"

namespace trueshade::viewer {
namespace {

std::string values_of(const Quantity& quantity) {
  return quantity.shown.empty() ? values_text(quantity.values) : quantity.shown;
}

void draw_quantities(const PanelContext& context, const Account& account) {
  ImGui::PushFont(context.fonts.mono);
  for (const Quantity& quantity : account.quantities) {
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kDim), "%-11s", quantity.name.c_str());
    ImGui::SameLine();
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextUnformatted(values_of(quantity).c_str());
    ImGui::PopTextWrapPos();
    if (ImGui::IsItemHovered() && !quantity.meaning.empty()) {
      ImGui::PushFont(context.fonts.text);
      ImGui::SetTooltip("%s", quantity.meaning.c_str());
      ImGui::PopFont();
    }
  }
  ImGui::PopFont();
}

void draw_steps(const PanelContext& context, const Account& account) {
  for (size_t i = 0; i < account.parts.size(); ++i) {
    const Account& part = account.parts[i];
    ImGui::PushID(int(i));
    const size_t chapter = part.title.find(" (docs/");  // where the step is defined stands in the text that is copied
    const std::string title = part.title.substr(0, chapter);
    if (ImGui::TreeNodeEx("##step", ImGuiTreeNodeFlags_SpanAvailWidth, "%s", title.c_str())) {
      draw_quantities(context, part);
      draw_steps(context, part);
      ImGui::TreePop();
    }
    ImGui::PopID();
  }
}

/// The lights of the pixel, each with the share that it adds.
void draw_lights(const PanelContext& context, const PixelCard& card) {
  constexpr size_t kListed = 8;
  if (card.lights.empty()) return;
  const auto sum = [](const AddedLight& light) { return light.term.x + light.term.y + light.term.z; };
  float all = 0.0f;
  for (const AddedLight& light : card.lights) all += std::max(sum(light), 0.0f);
  const float strongest = std::max(sum(card.lights.front()), 1e-30f);
  char title[64];
  std::snprintf(title, sizeof title, "%d lights add to it", int(card.lights.size()));
  heading(context, card.lights.size() == 1 ? "One light adds to it" : title);
  for (size_t i = 0; i < std::min(card.lights.size(), kListed); ++i) {
    const AddedLight& light = card.lights[i];
    const float share = all > 0.0f ? sum(light) / all : 0.0f,
                most = std::max({light.term.x, light.term.y, light.term.z, 1e-30f});
    const auto code = [most](float v) { return int(255.0f * std::clamp(v / most, 0.0f, 1.0f)); };
    char name[32];
    std::snprintf(name, sizeof name, "light %u", light.light);
    ImGui::PushID(int(i));
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float height = ImGui::GetTextLineHeight(), room = ImGui::GetContentRegionAvail().x;
    const float begin = context.size(96), width = room - begin - context.size(52);
    if (ImGui::Selectable(name)) {
      context.session.desk().selected_light = light.light;
      context.session.desk().panel = Panel::lights;
    }
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(
        {at.x + begin, at.y + height * 0.25f},
        {at.x + begin + std::max(width * std::clamp(sum(light) / strongest, 0.0f, 1.0f), 1.0f), at.y + height * 0.85f},
        IM_COL32(code(light.term.x), code(light.term.y), code(light.term.z), 255));
    char percent[16];
    std::snprintf(percent, sizeof percent, "%.1f %%", 100.0 * double(share));
    list.AddText({at.x + room - ImGui::CalcTextSize(percent).x, at.y}, kDim, percent);
    ImGui::PopID();
  }
  if (card.lights.size() > kListed)
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kDim), "and %d weaker ones", int(card.lights.size() - kListed));
}

}  // namespace

void draw_pixel_panel(const PanelContext& context) {
  Session& session = context.session;
  const std::optional<PixelCard>& card = session.card();
  if (!card) {
    heading(context, "Pixel");
    ImGui::TextWrapped("%s", session.waits() ? "\xE2\x80\xA6" : "Click a pixel of the picture.");
    return;
  }
  char title[64];
  std::snprintf(title, sizeof title, "Pixel %d, %d", card->x, card->y);
  heading(context, title);
  const float side = ImGui::GetTextLineHeight();
  ImGui::SameLine();
  ImGui::ColorButton("##color",
                     {float(card->word >> 16 & 255) / 255.0f, float(card->word >> 8 & 255) / 255.0f,
                      float(card->word & 255) / 255.0f, 1.0f},
                     ImGuiColorEditFlags_NoTooltip, {2 * side, side});
  if (card->revision != session.state().revision) {
    ImGui::SameLine();
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kDim), "of an earlier picture");
  }
  ImGui::SameLine(ImGui::GetWindowWidth() - context.size(64));
  if (ImGui::SmallButton("copy")) ImGui::SetClipboardText(card->text.c_str());
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("The whole text, as `trueshade explain` prints it");
  draw_quantities(context, card->account);
  draw_lights(context, *card);
  heading(context, "Step by step");
  draw_steps(context, card->account);
}

}  // namespace trueshade::viewer
