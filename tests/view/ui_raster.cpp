#include "view/window/ui_raster.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/catch.hpp"

namespace trueshade::viewer {
namespace {

/// A canvas of one colour, and ImGui to draw shapes over it.
struct Sheet {
  static constexpr int kWidth = 64, kHeight = 48;
  std::vector<uint32_t> words = std::vector<uint32_t>(kWidth * kHeight, 0);

  Sheet() {
    ImGui::CreateContext();
    ImGui::GetIO().DisplaySize = {kWidth, kHeight};
    ImGui::GetIO().IniFilename = nullptr;
    ImGui::GetStyle().AntiAliasedLinesUseTex = false;
    ImGui::GetIO().Fonts->Build();
    ImGui::NewFrame();
  }
  ~Sheet() { ImGui::DestroyContext(); }
  ImDrawList& list() { return *ImGui::GetForegroundDrawList(); }
  void draw() {
    ImGui::Render();
    draw_ui(*ImGui::GetDrawData(), *ImGui::GetIO().Fonts, {words.data(), kWidth, kHeight, kWidth});
  }
  int count(uint32_t word) const { return int(std::count(words.begin(), words.end(), word)); }
  uint32_t at(int x, int y) const { return words[size_t(y * kWidth + x)]; }
};

TEST_CASE("A box covers the pixels whose centres are in it, in its colour") {
  Sheet sheet;
  sheet.list().AddRectFilled({10, 5}, {20, 9}, IM_COL32(1, 2, 3, 255));
  sheet.draw();
  CHECK(sheet.count(0x010203) == 10 * 4);
  CHECK(sheet.at(10, 5) == 0x010203);
  CHECK(sheet.at(19, 8) == 0x010203);
  CHECK(sheet.at(20, 8) == 0);
}

TEST_CASE("Half transparent colours are mixed, and clipping holds") {
  Sheet sheet;
  std::fill(sheet.words.begin(), sheet.words.end(), 0x204060u);
  sheet.list().PushClipRect({0, 0}, {16, 48});
  sheet.list().AddRectFilled({-5, -5}, {100, 100}, IM_COL32(224, 192, 160, 128));
  sheet.list().PopClipRect();
  sheet.draw();
  CHECK(sheet.count(0x204060) == (64 - 16) * 48);
  const uint32_t mixed = sheet.at(3, 3);
  for (const auto& [shift, expected] : {std::pair(16, 0x80), {8, 0x80}, {0, 0x80}})
    CHECK(std::abs(int(mixed >> shift & 255) - expected) <= 1);
}

TEST_CASE("Triangles that share an edge cover each pixel once") {
  Sheet sheet;
  sheet.list().Flags = ImDrawListFlags_None;  // no soft edges
  const ImVec2 corners[] = {{3.3f, 4.1f}, {60.7f, 9.2f}, {50.1f, 44.9f}, {8.6f, 40.2f}};
  const ImVec2 middle = {30.5f, 22.5f};
  for (int i = 0; i < 4; ++i)
    sheet.list().AddTriangleFilled(corners[i], corners[(i + 1) % 4], middle, IM_COL32(255, 255, 255, 128));
  sheet.draw();
  const uint32_t once = sheet.at(30, 10);
  CHECK(once != 0);
  CHECK(sheet.count(once) + sheet.count(0) == Sheet::kWidth * Sheet::kHeight);
  CHECK(sheet.count(once) > 1500);
}

/// Which pixels' centres are in a triangle by its edge functions; of a centre on an edge nothing is said.
struct Expected {
  bool inside, on_edge;
};
Expected expected_at(const ImVec2 (&corner)[3], int x, int y) {
  int left = 0, right = 0;
  for (int i = 0; i < 3; ++i) {
    const ImVec2 &a = corner[i], &b = corner[(i + 1) % 3];
    const double cross =
        (double(b.x) - double(a.x)) * (y + 0.5 - double(a.y)) - (double(b.y) - double(a.y)) * (x + 0.5 - double(a.x));
    const double size = 1.0 + std::fabs(double(b.x) - double(a.x)) + std::fabs(double(b.y) - double(a.y));
    if (std::fabs(cross) < 1e-4 * size) return {false, true};
    ++(cross > 0.0 ? right : left);
  }
  return {left == 0 || right == 0, false};
}

TEST_CASE("Triangles cover the pixels in them and no others, be they slender, tiny or far larger than the canvas") {
  uint32_t state = 7;
  const auto number = [&state](float low, float high) {
    state = state * 1664525u + 1013904223u;
    return low + (high - low) * float(state >> 8) * 0x1p-24f;
  };
  int covered = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const float reach = trial % 4 == 0 ? 3.0f : trial % 4 == 1 ? 900.0f : 70.0f;
    ImVec2 corner[3];
    for (ImVec2& at : corner) at = {number(-reach, reach) + 30.0f, number(-reach, reach) + 20.0f};
    if (trial % 4 == 3) corner[2] = {corner[0].x + number(-1, 1), corner[0].y + number(-1, 1)};
    Sheet sheet;
    sheet.list().Flags = ImDrawListFlags_None;
    sheet.list().AddTriangleFilled(corner[0], corner[1], corner[2], IM_COL32(255, 255, 255, 255));
    sheet.draw();
    int wrong = 0;
    for (int y = 0; y < Sheet::kHeight; ++y)
      for (int x = 0; x < Sheet::kWidth; ++x) {
        const Expected expected = expected_at(corner, x, y);
        wrong += !expected.on_edge && expected.inside != (sheet.at(x, y) != 0);
        covered += expected.inside;
      }
    INFO("triangle " << trial);
    CHECK(wrong == 0);
  }
  CHECK(covered > 50000);
}

TEST_CASE("Texts are drawn in their colour, and nothing is drawn outside the canvas") {
  Sheet sheet;
  sheet.list().AddText({2, 2}, IM_COL32(255, 0, 0, 255), "Trueshade");
  sheet.list().AddText({-20, 40}, IM_COL32(255, 0, 0, 255), "outside");
  sheet.list().AddCircle({64, 48}, 30, IM_COL32(0, 255, 0, 255), 24, 3.0f);
  sheet.list().AddTriangleFilled({-1e9f, 5}, {1e9f, 5}, {NAN, 9}, IM_COL32(0, 0, 255, 255));
  sheet.draw();
  CHECK(sheet.count(0xff0000) > 40);
  CHECK(sheet.count(0x0000ff) == 0);
}

}  // namespace
}  // namespace trueshade::viewer
