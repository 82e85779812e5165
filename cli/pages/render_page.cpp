#include <algorithm>
#include <array>

#include "cli/looks.h"
#include "cli/pages/page.h"
#include "cli/pages/viewer.h"
#include "cli/report.h"
#include "cli/version.h"
#include "core/image_files/png_codes.h"
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

/// Says whether a page's picture shows the codes of the target, or codes made of the target's floats.
std::string about_codes(const Image& color) {
  if (info(color.format).number_class == NumberClass::unorm) return "as stored in the target";
  return "sRGB-encoded from " + std::string(info(color.format).name) + " and clamped to [0, 1]";
}

bool is_shown_otherwise(const RenderedFrame& result) {
  return display_of(looks_of_text(result.looks), result.pipeline, result.scene) != DisplayTransform();
}

std::string about_shown(const RenderedFrame& result) {
  if (!is_shown_otherwise(result)) return about_codes(result.frame.color);
  return "as PNGs show it, by" + escaped(result.looks);
}

/// The picture as PNGs of it have it; the same where that is as it is.
Image shown_picture(const RenderedFrame& result) {
  ImageFileOptions options;
  options.display = display_of(looks_of_text(result.looks), result.pipeline, result.scene);
  const Image& color = result.frame.color;
  const bool are_codes =
      result.pipeline.view != ImageView::lit || result.pipeline.post.encode == PostChain::Encode::srgb;
  if (options.display == DisplayTransform() || are_codes) return color;
  const PngCodes codes(color, options);
  Image shown(color.width, color.height, Format::rgba8);
  std::vector<uint8_t> row(codes.row_bytes());
  const size_t channels = size_t(codes.channels()), bytes = size_t(codes.bits() / 8);
  for (int y = 0; y < color.height; ++y) {
    codes.row(y, row.data());
    for (size_t x = 0; x < size_t(color.width); ++x)
      for (size_t c = 0; c < 4; ++c) shown.texel(int(x), y)[c] = c < channels ? row[(x * channels + c) * bytes] : 255;
  }
  return shown;
}

std::string heading(const RenderedFrame& result) {
  const Image& color = result.frame.color;
  const std::string size = std::to_string(color.width) + " \xc3\x97 " + std::to_string(color.height);
  return heading_part(result.scene.spec) + "<p class=quiet>preset " + escaped(result.pipeline.preset) + ", " + size +
         " pixels, " + std::string(info(color.format).name) + ", trueshade " + kVersion +
         "<br>image <code>sha256:" + result.image_hash + "</code><br>scene <code>sha256:" + result.scene_hash +
         "</code></p>\n" + notes_part(result.notes.lines);
}

std::string facts(const RenderedFrame& result, const std::vector<StatLine>& lines) {
  const std::string simd(result.execution.simd == "best" ? simd_targets().front() : result.execution.simd);
  return "<div class=facts>" +
         fact(value_of(lines, "frame_ms") + " ms", "time per frame",
              "Median of " + std::to_string(result.repeated_ms.size()) + " frames drawn again without planes, on " +
                  std::to_string(thread_count(result.execution.threads)) + " threads by " + simd + ".") +
         fact(grouped(value_of(lines, "triangles")), "triangles",
              "Submitted, over all instances; those out of sight are among them.") +
         fact(grouped(value_of(lines, "lights")), "lights", "Of the scene, whether or not they reach a surface.") +
         fact(grouped(value_of(lines, "lit_pixel_lights")), "pixel-light pairs lit",
              "Pairs of a pixel with a surface and a light that reaches it and faces it.") +
         "</div>\n";
}

/// What is shown on paper, and where no script runs.
std::string pictures(const RenderedFrame& result, const Image& shown) {
  const std::vector<NamedImage>& planes = result.frame.aovs;
  const Image& counts = plane_named(planes, "light.count");
  const uint32_t most = heat_scale(counts);
  const int threads = result.execution.threads;
  std::string html = "<div class=pictures>\n" + figure(shown, "Image", about_shown(result));
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

/// The picture and its planes, value by value.
std::string viewer(const RenderedFrame& result) {
  const std::vector<NamedImage>& planes = result.frame.aovs;
  const Image shown = shown_picture(result);  // before the viewer, whose layer borrows it
  PageViewer v;
  if (is_shown_otherwise(result))
    v.add(layer_of_image("shown", "Shown", "The picture, " + about_shown(result) + ".", shown));
  v.add(layer_of_image("color", "Image", "The picture, " + about_codes(result.frame.color) + ".", result.frame.color));
  v.add(layer_of_counts("lights", "Lights per pixel", "How many lights reach and face the surface.",
                        plane_named(planes, "light.count")));
  v.add(layer_of_image("albedo", "Albedo", "The surface's colour, linear in [0, 1].", plane_named(planes, "albedo")));
  v.add(first_channels(
      layer_of_directions("normal", "Normal", "World space, of length 1.", plane_named(planes, "normal")), 3));
  v.add(layer_of_extents("Z", "Depth", "Distance from the eye along the view axis, in units of the scene.",
                         plane_named(planes, "Z")));
  v.add(first_channels(
      layer_of_extents("position", "Position", "World space, in units of the scene.", plane_named(planes, "position")),
      3));
  v.add(layer_of_ids("object", "Object", "Objects from 1 in the order of the scene; 0 is nothing drawn.",
                     plane_named(planes, "id.object")));
  v.explain_command = result.explain_command;
  return viewer_part(v, pictures(result, shown), result.execution.threads);
}

std::string table(const std::vector<StatLine>& lines) {
  std::string html = "<h2>Counts and times</h2>\n<table>\n";
  for (const StatLine& line : lines)
    html += "<tr><td>" + escaped(line.label) + "<td class=number>" + grouped(line.value) + '\n';
  return html + "</table>\n";
}

}  // namespace

std::span<const std::string_view> report_planes() { return kReportPlanes; }

std::string report_page(const RenderedFrame& result) {
  const std::vector<StatLine> lines = stat_lines(result);
  return page_head(result.scene.spec) + heading(result) + viewer(result) + facts(result, lines) + table(lines) +
         pipeline_part(pipeline_json(result.pipeline)) + reproduce_part(result.command) + page_end();
}

}  // namespace trueshade
