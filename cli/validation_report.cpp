#include <algorithm>
#include <array>
#include <cstdio>

#include "cli/page.h"
#include "cli/validation.h"
#include "cli/version.h"
#include "core/image.h"

namespace trueshade {
namespace {

using oracle::AggregateTest;
using oracle::kPixelClasses;
using oracle::PixelClass;
using oracle::StageVerdict;
using oracle::WorstPixel;

using Rgb = std::array<uint8_t, 3>;

/// The colour of a class on the map. Rare classes have bright colours.
constexpr Rgb color_of(PixelClass c) {
  switch (c) {
    case PixelClass::exact:
      return {38, 44, 56};
    case PixelClass::store_2:
      return {66, 92, 140};
    case PixelClass::edge:
      return {255, 180, 84};
    case PixelClass::depth_tie:
      return {86, 208, 255};
    case PixelClass::clip:
      return {181, 132, 255};
    case PixelClass::branch:
      return {120, 220, 120};
    case PixelClass::tex:
      return {90, 160, 160};
    case PixelClass::undefined:
      return {160, 160, 160};
    case PixelClass::violation:
      return {255, 40, 80};
  }
  return {};  // unreachable: every enumerator returns above
}

constexpr const char* kTableStyle =
    "<style>table.wide { max-width: none; } .wide td, .wide th { padding: 5px 14px 5px 0; text-align: left; "
    "font-weight: 400; } .wide th { color: var(--quiet); } i.key { display: inline-block; width: 12px; "
    "height: 12px; border-radius: 3px; margin-right: 8px; } .bad { color: #ff5c7a; }</style>\n";

std::string number(double value, const char* format = "%.9g") {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// The classes of a stage as a picture. Violations are drawn 3 x 3, over whatever is beside them, so that one is seen.
Image class_map(const StageVerdict& s) {
  Image map(s.width, s.height, Format::rgba8);
  const auto paint = [&](int x, int y, PixelClass c) {
    if (x < 0 || y < 0 || x >= s.width || y >= s.height) return;
    const Rgb rgb = color_of(c);
    std::copy(rgb.begin(), rgb.end(), map.texel(x, y));
    map.texel(x, y)[3] = 255;
  };
  const auto class_at = [&](int x, int y) { return s.classes[size_t(y) * size_t(s.width) + size_t(x)]; };
  for (int y = 0; y < s.height; ++y)
    for (int x = 0; x < s.width; ++x) paint(x, y, class_at(x, y));
  for (int y = 0; y < s.height; ++y)
    for (int x = 0; x < s.width; ++x)
      for (int k = 0; k < 9 && class_at(x, y) == PixelClass::violation; ++k)
        paint(x + k % 3 - 1, y + k / 3 - 1, PixelClass::violation);
  return map;
}

std::string key(PixelClass c) {
  const Rgb rgb = color_of(c);
  return "<i class=key style=\"background: rgb(" + std::to_string(rgb[0]) + ' ' + std::to_string(rgb[1]) + ' ' +
         std::to_string(rgb[2]) + ")\"></i>" + std::string(text(c));
}

std::string counts_table(const StageVerdict& s) {
  std::string html = "<table>\n";
  for (size_t c = 0; c < kPixelClasses; ++c) {
    if (s.counts[c] == 0 && PixelClass(c) != PixelClass::violation) continue;
    html += "<tr><td>" + key(PixelClass(c)) + "<td>" + grouped(std::to_string(s.counts[c])) + "<td>" +
            number(100.0 * double(s.counts[c]) / double(s.classes.size()), "%.4f") + " %\n";
  }
  return html + "</table>\n";
}

std::string how_rare(const AggregateTest& t, double least_chance) {
  constexpr double kUsual = 0.01;
  if (t.chance >= kUsual) return "as chance makes it";
  const std::string rare = "one legal image in " + oracle::one_in(t.chance);
  return t.passes(least_chance) ? rare + ", which passes" : "<span class=bad>" + rare + "</span>";
}

std::string aggregates_table(const oracle::Evidence& evidence, double least_chance) {
  std::string html = "<table class=wide><tr><th>test of the whole image<th>found<th>expected<th>where<th>\n";
  for (const AggregateTest& t : evidence.tests)
    html += "<tr><td>" + escaped(t.name) + "<td>" + number(t.observed, "%.5g") + "<td>" +
            (t.low < 0 ? number(t.low, "%.5g") + " to " : "at most ") + number(t.high, "%.5g") + "<td>" +
            escaped(t.where) + "<td>" + how_rare(t, least_chance) + '\n';
  return html + "</table>\n<p class=quiet>By this rounding: " + escaped(text(evidence.rule)) + ".</p>\n";
}

std::string worst_table(const StageVerdict& s) {
  if (s.worst.empty()) return "";
  std::string html = "<h2>Worst pixels of " + escaped(s.stage) +
                     "</h2>\n<table class=wide><tr><th>x, y from the top "
                     "left<th>class<th>channel<th>gave<th>legal<th>nominal<th>surface\n";
  for (const WorstPixel& w : s.worst) {
    html += "<tr><td>" + std::to_string(w.x) + ", " + std::to_string(w.y) + "<td>" + key(w.pixel_class) + "<td>" +
            escaped(w.plane);
    if (w.plane.empty())
      html += "<td><td><td>";
    else
      html += "<td>" + number(w.given) + "<td>" + number(w.low) + " \xe2\x80\xa6 " + number(w.high) + "<td>" +
              number(w.nominal);
    html += "<td>" + escaped(w.note) + '\n';
  }
  return html + "</table>\n";
}

/// What was captured, and beside it how each pixel of each stage was judged.
std::string pictures(const Validation& v) {
  std::string html = "<div class=pictures>";
  if (v.capture.color.width > 0)
    html += figure(v.capture.color, "Image", "as captured, <code>sha256:" + image_hash(v.capture.color) + "</code>");
  for (const StageVerdict& s : v.verdict.stages)
    html += figure(class_map(s), "Classes of stage " + s.stage, "a colour each; violations enlarged");
  return html + "</div>\n";
}

std::string stage_part(const StageVerdict& s, const oracle::Evidence& evidence, double least_chance) {
  return "<h2>Stage " + escaped(s.stage) + "</h2>\n" + counts_table(s) + "<p class=quiet>" +
         std::to_string(s.explained()) + " pixels show another surface or branch than the nominal one; " +
         number(s.predicted_other, "%.1f") + " predicted, " + std::to_string(s.ambiguous) + " possible.</p>\n" +
         aggregates_table(evidence, least_chance) + worst_table(s);
}

/// What explains a capture that does not pass.
std::string diagnosis_part(const Validation& v) {
  if (v.findings.empty()) return "";
  std::string html = "<h2>What it looks like</h2>\n";
  for (const oracle::Finding& f : v.findings)
    html += "<p>" + std::string(f.together ? "And " : "") + escaped(finding_line(f)) + ".<br><span class=quiet>" +
            escaped(proof_line(f)) + ".</span><br><code>" + escaped(f.command) + "</code></p>\n";
  return html;
}

std::string inference_part(const oracle::Verdict& v) {
  if (!v.inferred) return "";
  std::string html =
      "<h2>Tightest profile that explains it</h2>\n<p>" + escaped(tightest_line(*v.inferred)) +
      "</p>\n<details><summary>What was tried</summary><table class=wide><tr><th>knob<th>guess<th>pixels "
      "against it<th>of the G-buffer<th>of the target\n";
  for (const oracle::Hypothesis& h : v.inferred->tried)
    html += "<tr><td>" + escaped(h.knob) + "<td>" + escaped(h.value) + "<td>" +
            grouped(std::to_string(h.violations())) + "<td>" + grouped(std::to_string(h.surfaces)) + "<td>" +
            (h.lights ? grouped(std::to_string(*h.lights)) : "not judged") + '\n';
  return html + "</table></details>\n";
}

/// The evidence, the rounding that stages follow, and what the target hides: a paragraph each.
std::string remarks(const Validation& v) {
  std::string html;
  for (const std::string& line : {v.verdict.evidence_line(), rounding_line(v.verdict), blind_spot_line(v)})
    if (!line.empty()) html += "<p>" + escaped(line) + ".</p>\n";
  return html;
}

std::string heading(const Validation& v) {
  const std::string size = std::to_string(v.pipeline.width) + " \xc3\x97 " + std::to_string(v.pipeline.height);
  std::string html = "<h1>" + escaped(v.verdict.scene) + "</h1>\n<p class=\"verdict" + (passes(v) ? "" : " bad") +
                     "\">Verdict: " + escaped(conclusion(v)) + ".</p>\n" + remarks(v) + "<p class=quiet>" +
                     escaped(v.verdict.driver) + "<br>preset " + escaped(v.pipeline.preset) + ", " + size +
                     " pixels, " + std::string(info(v.pipeline.target).name) + ", trueshade " + kVersion +
                     "<br>held to " + escaped(profile_line(v.profile)) + "</p>\n";
  for (const std::string& note : v.notes) html += "<p class=quiet>" + escaped(note) + "</p>\n";
  html += notes_part(v.scene_notes.lines);
  html += "<div class=facts>" + fact(grouped(std::to_string(violating_pixels(v.verdict))), "pixels in no legal set");
  for (const StageVerdict& s : v.verdict.stages)
    html += fact(number(100 * exact_share(s), "%.3f") + " %", "EXACT or STORE-2, " + s.stage);
  for (const DriverFrame::Pass& pass : v.passes) html += fact(number(pass.ms, "%.1f") + " ms", pass.name);
  html += fact(number(v.judge_ms / 1000, "%.1f") + " s", "judging");
  return html + "</div>\n";
}

}  // namespace

std::string validation_page(const Validation& v) {
  std::string html = page_head(v.verdict.scene + ", judged") + kTableStyle + heading(v) + diagnosis_part(v);
  html += pictures(v);
  for (size_t i = 0; i < v.verdict.stages.size(); ++i)
    html += stage_part(v.verdict.stages[i], v.verdict.evidence[i], v.verdict.least_chance(v.verdict.stages.size()));
  return html + inference_part(v.verdict) +
         "<h2>Pipeline</h2>\n<details><summary>All that may change a pixel beside the scene</summary><pre>" +
         escaped(pipeline_json(v.pipeline)) + "</pre></details>\n" + std::string(kPageEnd);
}

}  // namespace trueshade
