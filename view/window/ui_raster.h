#pragma once
#include <cstdint>

struct ImDrawData;
struct ImFontAtlas;

namespace trueshade::viewer {

/// Words 0x00RRGGBB of a window, rows top first.
struct Canvas {
  uint32_t* words;
  int width, height;
  int stride;  ///< words from one row to the next
  uint32_t* row(int y) const { return words + int64_t(y) * stride; }
};

/// Draws ImGui's lists over what is on the canvas. Their only texture is the atlas of the fonts, one byte a texel; its
/// texels are taken as they lie, nearest first, so texts have to be drawn at the size of their font. Callbacks are
/// passed over. A pixel whose centre lies on the edge of two triangles belongs to one of them.
void draw_ui(const ImDrawData& data, ImFontAtlas& atlas, const Canvas& canvas);

}  // namespace trueshade::viewer
