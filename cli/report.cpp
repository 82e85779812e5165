#include "cli/report.h"

#include <algorithm>
#include <array>

#include "cli/page.h"
#include "cli/version.h"
#include "core/threads/parallel_for.h"
#include "shading/output/derived_planes.h"
#include "shading/output/heat_map.h"
#include "shading/output/view_image.h"

namespace trueshade {
namespace {

constexpr std::string_view kReportPlanes[] = {"Z", "position", "normal", "albedo", "light.count", "id.object"};

std::string value_of(const std::vector<StatLine>& lines, std::string_view key) {
  return std::find_if(lines.begin(), lines.end(), [key](const StatLine& line) { return line.key == key; })->value;
}

std::string heat_ramp(uint32_t most) {
  std::string stops;
  for (int i = 0; i <= 10; ++i) {
    const std::array<uint8_t, 3> rgb = heat_color(256 * i / 10);
    stops += ", rgb(" + std::to_string(rgb[0]) + ' ' + std::to_string(rgb[1]) + ' ' + std::to_string(rgb[2]) + ')';
  }
  return "<span class=ramp>0 <i style=\"background: linear-gradient(to right" + stops + ")\"></i> " +
         std::to_string(most) + "</span>";
}

std::string heading(const RenderedFrame& result, const std::vector<StatLine>& lines) {
  const Image& color = result.frame.color;
  const std::string simd(result.execution.simd == "best" ? simd_targets().front() : result.execution.simd);
  const std::string size = std::to_string(color.width) + " \xc3\x97 " + std::to_string(color.height);
  return "<h1>" + escaped(result.scene.spec) + "</h1>\n<p class=quiet>preset " + escaped(result.pipeline.preset) +
         ", " + size + " pixels, " + std::string(info(color.format).name) + ", trueshade " + kVersion +
         "</p>\n<div class=facts>" +
         fact(value_of(lines, "frame_ms") + " ms",
              "time per frame, median of " + std::to_string(result.repeated_ms.size()) + "; " +
                  std::to_string(thread_count(result.execution.threads)) + " threads, " + simd) +
         fact(grouped(value_of(lines, "triangles")), "triangles") + fact(grouped(value_of(lines, "lights")), "lights") +
         fact(grouped(value_of(lines, "lit_pixel_lights")), "pixel-light pairs lit") +
         "</div>\n<p>Image <code>sha256:" + result.image_hash + "</code><br>Scene <code>sha256:" + result.scene_hash +
         "</code></p>\n" + notes_part(result.notes.lines);
}

std::string pictures(const RenderedFrame& result) {
  const std::vector<NamedImage>& planes = result.frame.aovs;
  const Image& counts = plane_named(planes, "light.count");
  const uint32_t most = heat_scale(counts);
  const int threads = result.execution.threads;
  std::string html = "<h2>G-buffer</h2>\n<div class=pictures>\n";
  // A statement each, so that no two pictures are in memory at once.
  html += figure(view_image(ImageView::normal, threads, planes), "Normal", "world space, (N + 1) / 2");
  html += figure(view_image(ImageView::albedo, threads, planes), "Albedo", "sRGB-encoded");
  html +=
      figure(view_image(ImageView::depth, threads, planes), "Depth", "distance along the view axis, near is bright");
  html += figure(view_image(ImageView::position, threads, planes), "Position",
                 "world x, y, z as red, green, blue, each over its extent");
  html += figure(heat_image(counts, most, threads), "Lights per pixel", "that reach and face it" + heat_ramp(most));
  return html + "</div>\n";
}

std::string table(const std::vector<StatLine>& lines) {
  std::string html = "<h2>Counts and times</h2>\n<table>\n";
  for (const StatLine& line : lines) html += "<tr><td>" + escaped(line.label) + "<td>" + grouped(line.value) + '\n';
  return html + "</table>\n";
}

/// Says whether a page's picture shows the codes of the target, or codes made of the target's floats.
std::string about_codes(const Image& color) {
  if (info(color.format).number_class == NumberClass::unorm) return "as stored in the target";
  return "sRGB-encoded from " + std::string(info(color.format).name) + " and clamped to [0, 1]";
}

}  // namespace

std::span<const std::string_view> report_planes() { return kReportPlanes; }

std::string report_page(const RenderedFrame& result) {
  const std::vector<StatLine> lines = stat_lines(result);
  return page_head(result.scene.spec) + heading(result, lines) +
         figure(result.frame.color, "Image", about_codes(result.frame.color)) + pictures(result) + table(lines) +
         "<h2>Pipeline</h2>\n<details><summary>All that may change a pixel beside the scene</summary><pre>" +
         escaped(pipeline_json(result.pipeline)) + "</pre></details>\n" + std::string(kPageEnd);
}

}  // namespace trueshade
