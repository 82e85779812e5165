#include <cstdio>

#include "view/window/panels.h"

namespace trueshade::viewer {
namespace {

struct Band {
  const char* name;
  ImU32 color;
  double (*ms)(const PictureTimes&);
};

// Core time by stage, over all threads.
constexpr Band kStages[] = {
    {"visibility", IM_COL32(92, 141, 232, 255), [](const PictureTimes& t) { return t.core_ms.visibility; }},
    {"surfaces", IM_COL32(86, 190, 168, 255), [](const PictureTimes& t) { return t.core_ms.surfaces; }},
    {"light", IM_COL32(242, 169, 72, 255), [](const PictureTimes& t) { return t.core_ms.light; }},
    {"store", IM_COL32(196, 110, 190, 255), [](const PictureTimes& t) { return t.core_ms.store; }},
};

// Wall time of the window's own work.
constexpr Band kOwn[] = {
    {"convert", IM_COL32(92, 141, 232, 255), [](const PictureTimes& t) { return t[Part::convert]; }},
    {"compose", IM_COL32(86, 190, 168, 255), [](const PictureTimes& t) { return t[Part::compose]; }},
    {"panels", IM_COL32(242, 169, 72, 255), [](const PictureTimes& t) { return t[Part::panels]; }},
    {"present", IM_COL32(196, 110, 190, 255), [](const PictureTimes& t) { return t[Part::present]; }},
};

double median_of(const FrameTimes& times, double (*ms)(const PictureTimes&)) {
  std::vector<double> values;
  for (const PictureTimes& shown : times.shown()) values.push_back(ms(shown));
  return quantile(std::move(values), 0.5);
}

/// Bands upon each other, a column a picture, the newest at the right; below them their names and medians.
void draw_graph(const PanelContext& context, const char* id, std::span<const Band> bands) {
  const std::vector<PictureTimes>& shown = context.times.shown();
  const float width = ImGui::GetContentRegionAvail().x, height = context.size(72);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::InvisibleButton(id, {width, height});
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(at, {at.x + width, at.y + height}, IM_COL32(255, 255, 255, 12), context.size(4));
  std::vector<double> sums;
  for (const PictureTimes& times : shown) {
    double sum = 0.0;
    for (const Band& band : bands) sum += band.ms(times);
    sums.push_back(sum);
  }
  double top = 1.0;
  while (top < 1.1 * quantile(sums, 0.98)) top *= 2.0;
  const float column = width / float(FrameTimes::kShown);
  for (size_t i = 0; i < shown.size(); ++i) {
    const float x = at.x + width - float(shown.size() - i) * column;
    double below = 0.0;
    for (const Band& band : bands) {
      const double above = std::min(below + band.ms(shown[i]), top);
      list.AddRectFilled({x, at.y + height - height * float(above / top)},
                         {x + column, at.y + height - height * float(below / top)}, band.color);
      below = above;
    }
  }
  char text[32];
  std::snprintf(text, sizeof text, "%.0f ms", top);
  list.AddText({at.x + context.size(5), at.y + context.size(2)}, kDim, text);
  for (const Band& band : bands) {
    const ImVec2 dot = ImGui::GetCursorScreenPos();
    const float side = ImGui::GetTextLineHeight();
    list.AddRectFilled({dot.x, dot.y + side * 0.25f}, {dot.x + side * 0.6f, dot.y + side * 0.85f}, band.color, 2.0f);
    ImGui::Dummy({side * 0.6f, side});
    ImGui::SameLine();
    ImGui::TextUnformatted(band.name);
    ImGui::SameLine(context.size(104));
    ImGui::Text("%.2f ms", median_of(context.times, band.ms));
  }
}

void count_row(const PanelContext& context, const char* name, uint64_t value) {
  std::string digits = std::to_string(value);
  for (size_t at = digits.size(); at > 3;) digits.insert(at -= 3, "\xE2\x80\x89");
  ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kDim), "%s", name);
  ImGui::SameLine(context.size(124));
  ImGui::TextUnformatted(digits.c_str());
}

}  // namespace

void draw_statistics_panel(const PanelContext& context) {
  const FrameStats& stats = context.picture.frame.stats;
  heading(context, "A picture, over all threads");
  draw_graph(context, "stages", kStages);
  heading(context, "The window");
  draw_graph(context, "own", kOwn);
  heading(context, "Counts");
  count_row(context, "Triangles", stats.triangles);
  count_row(context, "Lights", stats.lights);
  count_row(context, "Covered pixels", stats.covered_pixels);
  count_row(context, "Fragments", stats.fragments);
  count_row(context, "Pairs lit", stats.lit_pixel_lights);
  count_row(context, "Evaluated", stats.evaluated_pixel_lights);
  ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kDim), "Picture");
  ImGui::SameLine(context.size(124));
  ImGui::Text("%.2f ms, %d threads, tiles of %d", context.picture.draw_ms, stats.threads, stats.tile);
}

}  // namespace trueshade::viewer
