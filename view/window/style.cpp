#include "view/window/style.h"

#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <string>

namespace trueshade::viewer {
namespace {

constexpr float kTextPixels = 15.0f, kMonoPixels = 13.0f;

/// The first of these fonts that there is; ImGui's own otherwise.
ImFont* font_of(std::initializer_list<const char*> names, float pixels) {
  static const ImWchar kGlyphs[] = {0x20, 0x17f, 0x2009, 0x2027, 0x2190, 0x2193, 0x2212, 0x2212, 0};
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  ImFontConfig config;
  config.OversampleH = config.OversampleV = 1;  // texels are pixels
  config.PixelSnapH = true;
  for (const char* name : names) {
    const std::string path = std::string("/usr/share/fonts/truetype/") + name + ".ttf";
    std::error_code absent;
    if (!std::filesystem::exists(path, absent)) continue;
    return atlas.AddFontFromFileTTF(path.c_str(), pixels, &config, kGlyphs);
  }
  config.SizePixels = std::floor(pixels / 13.0f) * 13.0f;  // a font of bits, in whole steps
  return atlas.AddFontDefault(&config);
}

ImVec4 color(int r, int g, int b, double alpha) {
  return {float(r) / 255.0f, float(g) / 255.0f, float(b) / 255.0f, float(alpha)};
}

void set_colors(ImVec4* colors) {
  const ImVec4 accent = ImGui::ColorConvertU32ToFloat4(kAccent), text = ImGui::ColorConvertU32ToFloat4(kText);
  const auto with_alpha = [](ImVec4 c, float alpha) { return ImVec4(c.x, c.y, c.z, alpha); };
  colors[ImGuiCol_Text] = text;
  colors[ImGuiCol_TextDisabled] = ImGui::ColorConvertU32ToFloat4(kDim);
  colors[ImGuiCol_WindowBg] = ImGui::ColorConvertU32ToFloat4(kPaper);
  colors[ImGuiCol_ChildBg] = color(0, 0, 0, 0.0);
  colors[ImGuiCol_PopupBg] = color(22, 24, 29, 0.98);
  colors[ImGuiCol_Border] = ImGui::ColorConvertU32ToFloat4(kLine);
  for (const ImGuiCol frame : {ImGuiCol_FrameBg, ImGuiCol_Button, ImGuiCol_Header})
    colors[frame] = color(255, 255, 255, 0.07);
  for (const ImGuiCol hovered : {ImGuiCol_FrameBgHovered, ImGuiCol_ButtonHovered, ImGuiCol_HeaderHovered})
    colors[hovered] = color(255, 255, 255, 0.13);
  for (const ImGuiCol active : {ImGuiCol_FrameBgActive, ImGuiCol_ButtonActive, ImGuiCol_HeaderActive})
    colors[active] = with_alpha(accent, 0.35f);
  colors[ImGuiCol_SliderGrab] = with_alpha(accent, 0.6f);  // its value stands over it
  for (const ImGuiCol mark : {ImGuiCol_CheckMark, ImGuiCol_PlotLines, ImGuiCol_NavHighlight})
    colors[mark] = with_alpha(accent, 0.9f);
  colors[ImGuiCol_SliderGrabActive] = with_alpha(accent, 0.75f);
  colors[ImGuiCol_TextSelectedBg] = with_alpha(accent, 0.35f);
  colors[ImGuiCol_ScrollbarBg] = color(0, 0, 0, 0.0);
  colors[ImGuiCol_ScrollbarGrab] = color(255, 255, 255, 0.18);
  colors[ImGuiCol_ScrollbarGrabHovered] = color(255, 255, 255, 0.3);
  colors[ImGuiCol_ScrollbarGrabActive] = color(255, 255, 255, 0.4);
  colors[ImGuiCol_Separator] = ImGui::ColorConvertU32ToFloat4(kLine);
}

}  // namespace

Fonts set_style(double scale) {
  ImGuiStyle style;
  style.WindowPadding = {12, 10};
  style.FramePadding = {8, 4};
  style.ItemSpacing = {8, 6};
  style.ItemInnerSpacing = {6, 4};
  style.ScrollbarSize = 10;
  style.GrabMinSize = 10;
  style.WindowRounding = style.PopupRounding = 6;
  style.FrameRounding = style.GrabRounding = style.ScrollbarRounding = 4;
  style.WindowBorderSize = style.PopupBorderSize = 1;
  style.FrameBorderSize = 0;
  style.IndentSpacing = 12;
  style.AntiAliasedLinesUseTex = false;  // draw_ui() draws shapes without textures
  style.ScaleAllSizes(float(scale));
  set_colors(style.Colors);
  ImGui::GetStyle() = style;
  ImGui::GetIO().Fonts->Flags |= ImFontAtlasFlags_NoBakedLines;
  const auto pixels = [scale](float size) { return std::round(size * float(scale)); };
  Fonts fonts;
  fonts.text = font_of({"noto/NotoSans-Regular", "dejavu/DejaVuSans", "liberation2/LiberationSans-Regular",
                        "liberation/LiberationSans-Regular"},
                       pixels(kTextPixels));
  fonts.bold = font_of({"noto/NotoSans-Bold", "dejavu/DejaVuSans-Bold", "liberation2/LiberationSans-Bold",
                        "liberation/LiberationSans-Bold"},
                       pixels(kTextPixels));
  fonts.mono = font_of({"dejavu/DejaVuSansMono", "noto/NotoSansMono-Regular", "liberation2/LiberationMono-Regular",
                        "liberation/LiberationMono-Regular"},
                       pixels(kMonoPixels));
  return fonts;
}

}  // namespace trueshade::viewer
