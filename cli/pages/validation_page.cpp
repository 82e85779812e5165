#include <algorithm>
#include <cstdio>

#include "cli/pages/page.h"
#include "cli/pages/pixel_classes.h"
#include "cli/pages/validation_parts.h"
#include "cli/pages/validation_viewer.h"
#include "cli/validation.h"
#include "cli/version.h"

namespace trueshade {
namespace {

using oracle::AggregateTest;
using oracle::kPixelClasses;
using oracle::PixelClass;
using oracle::StageVerdict;
using oracle::WorstPixel;

std::string number(double value, const char* format = "%.9g") {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string counts_table(const StageVerdict& s) {
  const std::vector<LayerClass> classes = classes_of(s);
  std::string html =
      "<div class=scroll><table><thead><tr><th>class<th class=number>pixels<th class=number>share<th>what it "
      "means</thead>\n";
  for (size_t c = 0; c < kPixelClasses; ++c) {
    if (s.counts[c] == 0 && PixelClass(c) != PixelClass::violation) continue;
    html += "<tr><td>" + class_key(PixelClass(c)) + "<td class=number>" + grouped(std::to_string(s.counts[c])) +
            "<td class=number>" +
            number(100.0 * double(s.counts[c]) / double(std::max<uint64_t>(s.judged(), 1)), "%.4f") +
            " %<td class=meaning>" + escaped(classes[c].meaning) + '\n';
  }
  return html + "</table></div>\n";
}

std::string how_rare(const AggregateTest& t, double least_chance) {
  constexpr double kUsual = 0.01;
  if (t.chance >= kUsual) return "as chance makes it";
  const std::string rare = "one legal image in " + oracle::one_in(t.chance);
  return t.passes(least_chance) ? rare + ", which passes" : "<span class=bad>" + rare + "</span>";
}

std::string aggregates_table(const oracle::Evidence& evidence, double least_chance) {
  std::string html =
      "<div class=scroll><table><thead><tr><th>test of the whole image<th>found<th>expected<th>where<th>how "
      "rare</thead>\n";
  for (const AggregateTest& t : evidence.tests)
    html += "<tr><td>" + escaped(t.name) + "<td>" + number(t.observed, "%.5g") + "<td>" +
            (t.low < 0 ? number(t.low, "%.5g") + " to " : "at most ") + number(t.high, "%.5g") + "<td>" +
            escaped(t.where) + "<td>" + how_rare(t, least_chance) + '\n';
  return html +
         "</table></div>\n<p class=quiet>An image each pixel of which is legal may still be one that no rounding "
         "makes: each test counts pixels that took their second choice, against the most that chance makes by this "
         "rounding: " +
         escaped(text(evidence.rule)) + ".</p>\n";
}

std::string worst_table(const StageVerdict& s) {
  if (s.worst.empty()) return "";
  std::string html = "<h3>Worst pixels of " + escaped(s.stage) +
                     "</h3>\n<p class=quiet>Violations first, the farthest outside first. A place shows its pixel "
                     "above.</p>\n<div class=scroll><table><thead><tr><th>x, y from the top left<th>class<th>channel"
                     "<th>gave<th>legal<th>nominal<th>surface</thead>\n";
  for (const WorstPixel& w : s.worst) {
    const std::string x = std::to_string(w.x), y = std::to_string(w.y);
    html += "<tr><td><a href=\"#" + x + ',' + y + "\" data-pixel=\"" + x + ',' + y + "\">" + x + ", " + y + "</a><td>" +
            class_key(w.pixel_class) + "<td>" + escaped(w.plane);
    if (w.plane.empty())
      html += "<td><td><td>";
    else
      html += "<td>" + number(w.given) + "<td>" + number(w.low) + " \xe2\x80\xa6 " + number(w.high) + "<td>" +
              number(w.nominal);
    html += "<td>" + escaped(w.note) + '\n';
  }
  return html + "</table></div>\n";
}

std::string windows_list(const StageVerdict& s) {
  std::string html;
  for (const LocalWindow& w : oracle::worst_windows(s)) {
    const std::string middle = std::to_string(w.x + w.width / 2) + ',' + std::to_string(w.y + w.height / 2);
    html += "<li><a href=\"#" + middle + "\" data-pixel=\"" + middle + "\">Worst window</a> " +
            escaped(judged_window_line(w)) + ".\n";
  }
  return html.empty() ? "" : "<ul>\n" + html + "</ul>\n";
}

std::string stage_part(const StageVerdict& s, const oracle::Evidence& evidence, double least_chance) {
  return "<h2 id=\"stage-" + escaped(s.stage) + "\">Stage " + escaped(s.stage) + "</h2>\n" + counts_table(s) +
         "<p class=quiet>" + grouped(std::to_string(s.explained())) +
         " pixels show another surface or branch than the nominal one; " + number(s.predicted_other, "%.1f") +
         " are predicted if errors are spread evenly over their bounds, and " + grouped(std::to_string(s.ambiguous)) +
         " pixels have more than one legal surface or branch.</p>\n" + windows_list(s) +
         aggregates_table(evidence, least_chance) + worst_table(s);
}

std::string inference_part(const oracle::Verdict& v) {
  if (!v.inferred) return "";
  std::string html =
      "<h2>Tightest profile that explains it</h2>\n<p>" + escaped(tightest_line(*v.inferred)) +
      "</p>\n<details><summary>What was tried</summary><div class=scroll><table><thead><tr><th>knob<th>guess<th>pixels "
      "against it" +
      (v.inferred->sampled_rows > 0 ? " in " + std::to_string(v.inferred->sampled_rows) + " rows" : std::string()) +
      "<th>of the G-buffer<th>of the target</thead>\n";
  for (const oracle::Hypothesis& h : v.inferred->tried)
    html += "<tr><td>" + escaped(h.knob) + "<td>" + escaped(h.value) + "<td>" +
            grouped(std::to_string(h.violations())) + "<td>" + grouped(std::to_string(h.surfaces)) + "<td>" +
            (h.lights ? grouped(std::to_string(*h.lights)) : "not judged") + '\n';
  return html + "</table></div></details>\n";
}

/// The evidence, the rounding that stages follow, and what the target hides: a paragraph each.
std::string remarks(const Validation& v) {
  std::string html;
  for (const std::string& line :
       {v.verdict.evidence_line(), rounding_line(v.verdict), power_line(v.verdict), blind_spot_line(v)})
    if (!line.empty()) html += "<p>" + escaped(line) + ".</p>\n";
  return html;
}

/// What was judged, in a line.
std::string subject(const Validation& v) {
  return "<p class=quiet>" + escaped(v.verdict.driver) + "; " + escaped(lights_of(v.pipeline)) + ", " +
         std::to_string(v.pipeline.width) + " \xc3\x97 " + std::to_string(v.pipeline.height) + " pixels, " +
         std::string(info(v.pipeline.target).name) + "</p>\n";
}

/// What it was held to, and what a reader must know of the figures.
std::string about_part(const Validation& v) {
  std::string html =
      "<h2>About this judgement</h2>\n<p>Held to " + escaped(profile_line(v.profile)) + ".</p>\n" + remarks(v);
  if (!v.left_out_by.empty()) html += "<p>Mask: " + escaped(left_out_line(v)) + ".</p>\n";
  for (const std::string& note : v.notes) html += "<p>" + escaped(note) + ".</p>\n";
  if (v.capture.color.width > 0)
    html += "<p>The image that was judged has the hash <code>sha256:" + image_hash(v.capture.color) + "</code>.</p>\n";
  return html + "<p class=quiet>trueshade " + kVersion + "</p>\n";
}

std::string facts(const Validation& v) {
  std::string html =
      "<div class=facts>" + fact(grouped(std::to_string(violating_pixels(v.verdict))), "pixels in no legal set",
                                 "Nothing that keeps the profile's promises stores these; none may be.");
  if (const uint64_t left_out = v.capture.mask.count(); left_out > 0)
    html += fact(grouped(std::to_string(left_out)), "pixels left out", "By the mask, or for what they show.");
  for (const StageVerdict& s : v.verdict.stages)
    html += fact(number(100 * exact_share(s), "%.3f") + " %", "EXACT or STORE-2, " + s.stage,
                 "Pixels of the nominal surface, with the nominal value or the neighbour that rounding may give.");
  for (const DriverFrame::Pass& pass : v.passes)
    html += fact(
        number(pass.ms, "%.1f") + " ms", pass.name,
        "Time of this pass by the driver, " +
            (v.timed_frames > 1 ? "the median of " + std::to_string(v.timed_frames) + " frames." : "of one frame."));
  return html +
         fact(number(v.judge_ms / 1000, "%.1f") + " s", "judging",
              "Wall time to find the legal set of each pixel and to test the whole image.") +
         "</div>\n";
}

std::string way_to_failed_stage(const Validation& v) {
  const StageVerdict* const failed = failed_stage(v.verdict);
  if (failed == nullptr) return "";
  return " <a href=\"#stage-" + escaped(failed->stage) + "\">What stage " + escaped(failed->stage) + " found</a>";
}

std::string heading(const Validation& v) {
  return heading_part(v.verdict.scene) + "<p class=\"verdict " + (passes(v) ? "good" : "bad") +
         "\">Verdict: " + escaped(conclusion(v)) + "." + way_to_failed_stage(v) + "</p>\n" + subject(v) +
         notes_part(v.scene_notes.lines);
}

}  // namespace

std::string diagnosis_part(const Validation& v) {
  if (v.findings.empty()) return "";
  std::string html = "<h2>What it looks like</h2>\n";
  for (const oracle::Finding& f : v.findings) {
    std::string program;
    for (const std::string& line : program_lines(f)) program += "<br><code>" + escaped(line) + "</code>";
    html += "<p>" +
            std::string(f.together  ? "And "
                        : f.tied    ? "Or as well "
                        : f.partial ? "May be part of it: "
                                    : "") +
            escaped(finding_line(f)) + "." + program + "<br><span class=quiet>" + escaped(proof_line(f)) +
            ".</span></p>\n" +
            (f.command.empty() ? "" : "<div class=command><code>" + escaped(f.command) + "</code></div>\n");
  }
  return html;
}

std::string stages_part(const Validation& v) {
  std::string html;
  for (size_t i = 0; i < v.verdict.stages.size(); ++i)
    html += stage_part(v.verdict.stages[i], v.verdict.evidence[i], v.verdict.least_chance(v.verdict.stages.size()));
  return html;
}

std::string validation_page(const Validation& v, const Scene& scene) {
  std::string html = page_head(v.verdict.scene + ", judged") + heading(v) + diagnosis_part(v) +
                     validation_viewer(v, scene) + facts(v) + about_part(v);
  html += stages_part(v);
  return html + inference_part(v.verdict) + pipeline_part(pipeline_json(v.pipeline)) + reproduce_part(v.command) +
         page_end();
}

}  // namespace trueshade
