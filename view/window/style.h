#pragma once
#include <imgui.h>

namespace trueshade::viewer {

/// Colours of the window that ImGui's style has no place for.
inline constexpr ImU32 kAccent = IM_COL32(242, 169, 72, 255), kDim = IM_COL32(150, 156, 166, 255),
                       kText = IM_COL32(230, 232, 236, 255), kBad = IM_COL32(255, 118, 106, 255),
                       kPaper = IM_COL32(17, 19, 23, 224), kLine = IM_COL32(255, 255, 255, 26);

struct Fonts {
  ImFont *text = nullptr, *bold = nullptr, *mono = nullptr;
};

/// Sets ImGui's style, and loads fonts of this machine: Noto Sans, DejaVu Sans or Liberation Sans; else ImGui's own.
/// `scale`: 1 on a display of 96 dots an inch.
Fonts set_style(double scale);

}  // namespace trueshade::viewer
