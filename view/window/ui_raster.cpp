#include "view/window/ui_raster.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

namespace trueshade::viewer {
namespace {

struct Box {
  int x0, y0, x1, y1;  // x1 and y1 are outside
  bool empty() const { return x0 >= x1 || y0 >= y1; }
};

Box both(const Box& a, const Box& b) {
  return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

/// The first pixel whose centre is not before x.
int first_centre(float x) { return int(std::ceil(std::clamp(x, -1e6f, 1e6f) - 0.5f)); }

struct Atlas {
  const uint8_t* texels;
  int width, height;
  uint32_t at(float u, float v) const {
    const int x = std::clamp(int(u * float(width)), 0, width - 1),
              y = std::clamp(int(v * float(height)), 0, height - 1);
    return texels[y * width + x];
  }
};

/// ImGui's colour, A B G R from the highest byte, as a word of the canvas.
uint32_t word_of(ImU32 color) { return (color & 0xffu) << 16 | (color & 0xff00u) | (color >> 16 & 0xffu); }
uint32_t alpha_of(ImU32 color) { return color >> 24; }

/// `alpha`: 0 to 255.
uint32_t blended(uint32_t below, uint32_t above, uint32_t alpha) {
  const uint32_t a = alpha + (alpha >> 7);  // 0 to 256
  const uint32_t rb = below & 0xff00ffu, g = below & 0x00ff00u;
  return ((rb + (((above & 0xff00ffu) - rb) * a >> 8)) & 0xff00ffu) |
         ((g + (((above & 0x00ff00u) - g) * a >> 8)) & 0x00ff00u);
}

class UiRaster {
 public:
  UiRaster(const Atlas& atlas, const Canvas& canvas) : atlas_(atlas), canvas_(canvas) {}

  void draw(const ImDrawList& list, const ImDrawCmd& command, const ImVec2& origin) {
    const ImVec4& r = command.ClipRect;
    clip_ = both({int(r.x - origin.x), int(r.y - origin.y), int(r.z - origin.x), int(r.w - origin.y)},
                 {0, 0, canvas_.width, canvas_.height});
    if (clip_.empty()) return;
    const ImDrawIdx* const index = list.IdxBuffer.Data + command.IdxOffset;
    const ImDrawVert* const vertex = list.VtxBuffer.Data + command.VtxOffset;
    for (unsigned i = 0; i + 2 < command.ElemCount; i += 3) {
      if (i + 5 < command.ElemCount && draw_box(vertex, index + i)) {
        i += 3;
        continue;
      }
      draw_triangle(vertex[index[i]], vertex[index[i + 1]], vertex[index[i + 2]]);
    }
  }

 private:
  /// Two triangles that are a box along the axes in one colour, as nearly all of ImGui's are. Whether it was one.
  bool draw_box(const ImDrawVert* vertex, const ImDrawIdx* index) {
    if (index[3] != index[0] || index[4] != index[2]) return false;
    const ImDrawVert &a = vertex[index[0]], &b = vertex[index[1]], &c = vertex[index[2]], &d = vertex[index[5]];
    const bool is_box = a.pos.y == b.pos.y && b.pos.x == c.pos.x && c.pos.y == d.pos.y && d.pos.x == a.pos.x &&
                        a.pos.x <= c.pos.x && a.pos.y <= c.pos.y;
    if (!is_box || a.col != b.col || a.col != c.col || a.col != d.col) return false;
    const Box box =
        both({first_centre(a.pos.x), first_centre(a.pos.y), first_centre(c.pos.x), first_centre(c.pos.y)}, clip_);
    const bool textured = a.uv.x != c.uv.x || a.uv.y != c.uv.y;
    const float du = textured ? (c.uv.x - a.uv.x) / (c.pos.x - a.pos.x) : 0.0f;
    const float dv = textured ? (c.uv.y - a.uv.y) / (c.pos.y - a.pos.y) : 0.0f;
    const uint32_t word = word_of(a.col), alpha = alpha_of(a.col);
    for (int y = box.y0; y < box.y1; ++y) {
      uint32_t* const row = canvas_.row(y);
      const float v = a.uv.y + (float(y) + 0.5f - a.pos.y) * dv;
      if (!textured && alpha == 255) {
        std::fill(row + box.x0, row + std::max(box.x0, box.x1), word);
        continue;
      }
      for (int x = box.x0; x < box.x1; ++x) {
        uint32_t share = alpha;
        if (textured) {
          const uint32_t texel = atlas_.at(a.uv.x + (float(x) + 0.5f - a.pos.x) * du, v);
          if (texel == 0) continue;
          share = (alpha * texel + 127) / 255;
        }
        row[x] = blended(row[x], word, share);
      }
    }
    return true;
  }

  static float cross(const ImVec2& from, const ImVec2& to, float x, float y) {
    return (to.x - from.x) * (y - from.y) - (to.y - from.y) * (x - from.x);
  }
  /// Of a triangle that runs clockwise on a screen: whether the edge owns the points on it.
  static bool owns(const ImVec2& from, const ImVec2& to) { return to.y < from.y || (to.y == from.y && to.x > from.x); }

  /// The pixels of a row that may lie to the inner side of the edge of a triangle that runs clockwise on a screen:
  /// those that cross() finds there, and a few more, as it rounds.
  static void cut(Box& span, const ImVec2& from, const ImVec2& to, float y) {
    const double dx = double(to.x) - double(from.x), dy = double(to.y) - double(from.y);
    if (std::fabs(dy) < 1e-6) return;
    const double along = dx * (double(y) - double(from.y)) / dy, x = double(from.x) + along;
    const double far = std::fabs(double(from.x)) + std::max(std::abs(span.x0), std::abs(span.x1)) + 1.0;
    const double rounding = 1e-6 * (std::fabs(along) + far);
    if (dy < 0.0) span.x0 = std::max(span.x0, first_centre(float(std::clamp(x - rounding, -1e6, 1e6))) - 1);
    if (dy > 0.0) span.x1 = std::min(span.x1, first_centre(float(std::clamp(x + rounding, -1e6, 1e6))) + 1);
  }

  void draw_triangle(const ImDrawVert& a, const ImDrawVert& p, const ImDrawVert& q) {
    const float area = cross(a.pos, p.pos, q.pos.x, q.pos.y);
    if (area == 0.0f || !std::isfinite(area)) return;
    const ImDrawVert &b = area > 0.0f ? p : q, &c = area > 0.0f ? q : p;
    const auto [left, right] = std::minmax({a.pos.x, b.pos.x, c.pos.x});
    const auto [top, bottom] = std::minmax({a.pos.y, b.pos.y, c.pos.y});
    const Box box =
        both({first_centre(left), first_centre(top), first_centre(right) + 1, first_centre(bottom) + 1}, clip_);
    const bool own_a = owns(b.pos, c.pos), own_b = owns(c.pos, a.pos), own_c = owns(a.pos, b.pos);
    const float scale = 1.0f / std::fabs(area);
    const bool even = a.col == b.col && a.col == c.col;
    const uint32_t texel = atlas_.at(a.uv.x, a.uv.y);  // shapes have the uv of a white texel
    for (int y = box.y0; y < box.y1; ++y) {
      uint32_t* const row = canvas_.row(y);
      const float py = float(y) + 0.5f;
      Box span = box;
      cut(span, b.pos, c.pos, py), cut(span, c.pos, a.pos, py), cut(span, a.pos, b.pos, py);
      for (int x = span.x0; x < span.x1; ++x) {
        const float px = float(x) + 0.5f;
        const float wa = cross(b.pos, c.pos, px, py), wb = cross(c.pos, a.pos, px, py),
                    wc = cross(a.pos, b.pos, px, py);
        if (!(wa > 0.0f || (wa == 0.0f && own_a)) || !(wb > 0.0f || (wb == 0.0f && own_b)) ||
            !(wc > 0.0f || (wc == 0.0f && own_c)))
          continue;
        const ImU32 color = even ? a.col : mixed(a.col, wa * scale, b.col, wb * scale, c.col, wc * scale);
        row[x] = blended(row[x], word_of(color), alpha_of(color) * texel / 255);
      }
    }
  }

  static ImU32 mixed(ImU32 a, float wa, ImU32 b, float wb, ImU32 c, float wc) {
    ImU32 out = 0;
    for (int shift = 0; shift < 32; shift += 8) {
      const float value = wa * float(a >> shift & 0xff) + wb * float(b >> shift & 0xff) + wc * float(c >> shift & 0xff);
      out |= ImU32(std::clamp(value + 0.5f, 0.0f, 255.0f)) << shift;
    }
    return out;
  }

  const Atlas& atlas_;
  const Canvas& canvas_;
  Box clip_{};
};

}  // namespace

void draw_ui(const ImDrawData& data, ImFontAtlas& atlas, const Canvas& canvas) {
  unsigned char* texels = nullptr;
  Atlas texture{};
  atlas.GetTexDataAsAlpha8(&texels, &texture.width, &texture.height);
  texture.texels = texels;
  UiRaster raster(texture, canvas);
  for (int n = 0; n < data.CmdListsCount; ++n) {
    const ImDrawList& list = *data.CmdLists[n];
    for (const ImDrawCmd& command : list.CmdBuffer)
      if (command.UserCallback == nullptr) raster.draw(list, command, data.DisplayPos);
  }
}

}  // namespace trueshade::viewer
