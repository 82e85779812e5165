#include <algorithm>
#include <cstdio>

#include "cli/json_text.h"
#include "cli/validation.h"
#include "cli/version.h"
#include "core/image.h"

namespace trueshade {
namespace {

using oracle::AggregateTest;
using oracle::Evidence;
using oracle::kPixelClasses;
using oracle::PixelClass;
using oracle::StageVerdict;
using oracle::WorstPixel;

std::string verdict_row(const std::string& name, const std::string& value) {
  return name + std::string(name.size() < 12 ? 12 - name.size() : 1, ' ') + value + '\n';
}

std::string real(double value, const char* format = "%.6g") {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string right(const std::string& text, size_t width) {
  return std::string(text.size() < width ? width - text.size() : 0, ' ') + text;
}

std::string left(const std::string& text, size_t width) {
  return text + std::string(text.size() < width ? width - text.size() : 0, ' ');
}

std::string class_rows(const StageVerdict& s) {
  std::string lines;
  for (size_t c = 0; c < kPixelClasses; ++c) {
    if (s.counts[c] == 0 && PixelClass(c) != PixelClass::violation) continue;
    const double share = 100.0 * double(s.counts[c]) / double(std::max<uint64_t>(s.judged(), 1));
    lines += "  " + left(std::string(text(PixelClass(c))), 10) + right(std::to_string(s.counts[c]), 10) +
             right(real(share, "%.4f"), 10) + " %\n";
  }
  return lines;
}

std::string aggregate_rows(const Evidence& evidence, double least_chance) {
  std::string lines;
  for (const AggregateTest& t : evidence.tests) {
    if (t.passes(least_chance) && (t.observed == 0 || !t.where.empty())) continue;
    lines += "  " + left(t.name, 21) + " found " + real(t.observed, "%.5g") + ", expected " +
             (t.low < 0 ? real(t.low, "%.5g") + " to " : "at most ") + real(t.high, "%.5g");
    if (!t.passes(least_chance))
      lines += (t.where.empty() ? "" : " in " + t.where) + ", NOT what chance makes (one in " +
               oracle::one_in(t.chance) + ")";
    lines += '\n';
  }
  return lines;
}

std::string worst_row(const WorstPixel& w) {
  return "  " + left(std::to_string(w.x) + ',' + std::to_string(w.y), 11) + left(std::string(text(w.pixel_class)), 11) +
         (w.plane.empty() ? ""
                          : w.plane + " gave " + real(w.given, "%.9g") + ", legal " + real(w.low, "%.9g") + " .. " +
                                real(w.high, "%.9g") + ", nominal " + real(w.nominal, "%.9g")) +
         (w.note.empty() ? "" : (w.plane.empty() ? "" : "; ") + w.note) + '\n';
}

}  // namespace

std::string judged_window_line(const LocalWindow& w) {
  std::string line = std::to_string(w.side) + 'x' + std::to_string(w.side) + " at " + std::to_string(w.x) + ',' +
                     std::to_string(w.y) + ": of " + std::to_string(w.seen) + " pixels " + std::to_string(w.found) +
                     " in no legal set, " + std::to_string(w.others) + " other surfaces or branches";
  return w.found == 0 ? line
                      : line + "; outside by " + real(w.sum / double(w.found), "%.4g") +
                            " units of the last place on " + "average, " + real(w.largest, "%.4g") + " at most";
}

namespace {

std::string stage_text(const StageVerdict& s, const Evidence& evidence, double least_chance) {
  constexpr size_t kShown = 8;
  std::string lines = "\n" + s.stage + ": " + std::to_string(s.judged()) + " pixels, " + std::to_string(s.covered) +
                      " with a surface" + (s.left_out > 0 ? "; " + std::to_string(s.left_out) + " left out" : "") +
                      '\n';
  lines += class_rows(s);
  lines += "  other surfaces or branches: " + std::to_string(s.explained()) + " seen, " +
           real(s.predicted_other, "%.1f") + " predicted, " + std::to_string(s.ambiguous) + " possible\n";
  if (s.worst_error > 0)
    lines += "  largest error of a float channel: " + real(s.worst_error, "%.3f") + " of its bound\n";
  lines += aggregate_rows(evidence, least_chance);
  for (const LocalWindow& w : oracle::worst_windows(s)) lines += "  worst window " + judged_window_line(w) + '\n';
  if (!s.worst.empty()) lines += "  worst pixels (x,y from the top left):\n";
  for (size_t i = 0; i < std::min(kShown, s.worst.size()); ++i) lines += "  " + worst_row(s.worst[i]);
  return lines;
}

}  // namespace

std::string profile_line(const oracle::Profile& p) {
  return p.name + ": " + std::to_string(p.subpixel_bits) + " subpixel bits, rounding " + oracle::text(p.snap) +
         "; planes " + oracle::text(p.plane_origin) + "; half " + oracle::text(p.half) + "; unorm within " +
         real(p.unorm_reach);
}

std::string tightest_line(const oracle::Inference& inferred) {
  const std::string sample = inferred.sampled_rows == 0
                                 ? std::string()
                                 : "; what is kept explains all rows, what is refused fails in " +
                                       std::to_string(inferred.sampled_rows) + " of them";
  if (!inferred.known_as.empty()) return text(inferred) + "; as " + inferred.known_as + sample;
  const auto nearest = std::find_if(inferred.tried.begin(), inferred.tried.end(),
                                    [&](const oracle::Hypothesis& h) { return h.value == inferred.nearest; });
  const std::string line = text(inferred) + "; no named profile explains it";
  if (nearest == inferred.tried.end()) return line + sample;
  return line + ", " + nearest->value + " comes nearest with " + std::to_string(nearest->violations()) +
         " pixels against it" + sample;
}

/// What share of the pixels a fault predicts, or says to be anything.
std::string share_text(const oracle::Finding& f) {
  const std::string pixels = " % of some " + std::to_string(f.changed) + " pixels that are not as expected";
  if (f.explained > 0 || !(f.located > 0))
    return (f.together ? "together they explain " : "explains ") + real(100 * f.explained, "%.1f") + pixels;
  return "holds " + real(100 * f.located, "%.1f") + pixels + ", without their numbers";
}

std::string finding_line(const oracle::Finding& f) {
  return f.name + " (" + f.plane + "): " + f.text + "; " + share_text(f) +
         (f.left > 0.0005 ? ", leaves " + real(100 * std::min(f.left, 1.0), "%.1f") + " % far off" : "") +
         (f.contradicted > 0.0005 ? ", and contradicts " + real(100 * f.contradicted, "%.1f") + " % of the others"
                                  : "");
}

std::vector<std::string> program_lines(const oracle::Finding& f) {
  std::vector<std::string> lines;
  if (f.it_reads.empty()) return lines;
  constexpr size_t kMost = 400;  // characters of a line
  const auto add = [&](const char* what, const std::string& text) {
    lines.push_back(what + text.substr(0, kMost) + (text.size() > kMost ? "..." : ""));
  };
  add("it reads: ", f.it_reads);
  if (!f.drawn_as.empty()) add("drawn as: ", f.drawn_as);
  return lines;
}

std::string proof_line(const oracle::Finding& f) {
  if (f.proof.plane.empty()) return "no pixel of those looked at is explained";
  return "at " + std::to_string(f.proof.x) + ',' + std::to_string(f.proof.y) + ' ' + f.proof.plane + " is " +
         real(f.proof.given, "%.9g") + "; expected " + real(f.proof.right, "%.9g") +
         (f.proof.by_both ? ", by both faults " : ", by this fault ") +
         (f.proof.anything ? "anything" : real(f.proof.predicted, "%.9g"));
}

bool passes(const Validation& v) {
  return v.verdict.violations() == 0 && v.repeat_changes.value_or(0) == 0 && (v.lenient || !v.verdict.convicted());
}

std::string invariance_line(const Validation& v) {
  if (!v.repeat_changes) return {};
  const std::string again = "drawn again " + std::to_string(*v.repeat_changes) + " pixels change";
  return v.move_changes ? again + "; moved by (64, 32) " + std::to_string(*v.move_changes) + " do" : again;
}

uint64_t violating_pixels(const oracle::Verdict& v) {
  uint64_t count = 0;
  for (size_t i = 0; i < v.stages.front().classes.size(); ++i)
    count += std::any_of(v.stages.begin(), v.stages.end(),
                         [i](const StageVerdict& s) { return s.classes[i] == PixelClass::violation; });
  return count;
}

namespace {

/// Where they are, if more than one stage was judged: ` (gbuffer 12, lighting 307)`.
std::string stages_of_violations(const oracle::Verdict& v) {
  if (v.stages.size() < 2) return {};
  std::string line;
  for (const StageVerdict& s : v.stages)
    if (const uint64_t count = s.count(PixelClass::violation); count > 0)
      line += (line.empty() ? " (" : ", ") + s.stage + ' ' + std::to_string(count);
  return line + ')';
}

}  // namespace

std::string conclusion(const Validation& validation) {
  const oracle::Verdict& v = validation.verdict;
  const uint64_t violations = violating_pixels(v);
  const uint64_t left_out = validation.capture.mask.count();
  const std::string post = std::string(validation.pipeline.post.active() ? "; the post chain is not judged" : "") +
                           (left_out > 0 ? "; " + std::to_string(left_out) + " are left out" : "");
  uint64_t undefined = 0;
  for (const StageVerdict& s : v.stages) undefined += s.count(oracle::PixelClass::undefined);
  const std::string judged =
      undefined == 0 ? "" : ", but for " + std::to_string(undefined) + " UNDEFINED, of which nothing can be said";
  if (violations > 0)
    return std::to_string(violations) + (violations == 1 ? " pixel is" : " pixels are") + " in no legal set" +
           stages_of_violations(v) + post;
  if (validation.repeat_changes.value_or(0) > 0)
    return "every pixel is explained, yet the same frame drawn again is another" + post;
  if (!v.convicted()) return "every pixel is explained" + judged + post;
  const char* lenient = " (a remark, as --lenient asks)";
  const char* what = v.rounds_unlike_any() ? "rounding" : "texture filter or blend";
  return std::string("each pixel is legal, yet no ") + what + " that is known makes such an image" +
         std::string(validation.lenient ? lenient : "") + post;
}

std::string rounding_line(const oracle::Verdict& v) {
  std::string line;
  for (size_t i = 0; i < v.stages.size(); ++i) {
    const Evidence& e = v.evidence[i];
    if (v.stages[i].stored_values == 0 || e.against || e.as_stated) continue;
    line += (line.empty() ? "" : "; ") + v.stages[i].stage + ": " + text(e.rule) + ", as known implementations do";
  }
  return line;
}

std::string blind_spot_line(const Validation& v) {
  const Image& color = v.capture.color;
  const FormatInfo layout = info(color.format);
  if (color.width == 0 || (layout.number_class == NumberClass::floating && !layout.small_float())) return {};
  if (layout.small_float())
    return std::string(layout.name) + " hides what changes a pixel by less than 1 part in " +
           std::to_string(1 << std::min(10, layout.bits[2] == 16 ? 10 : layout.bits[2] - 5)) + "; rgba32f shows it";
  double codes = 0;  // all stored, so that an error of e changes e * codes of them
  for (int y = 0; y < color.height; ++y)
    for (int x = 0; x < color.width; ++x)
      for (int k = 0; k < 3 && !v.capture.mask.has(x, y); ++k) codes += double(color.code(layout, x, y, k));
  constexpr double kTold = 30;        // stores that a rule rules out and that the tests tell
  constexpr double kSmallest = 1e-3;  // percent: what sums of floats may be off
  const double one = 100.0 / double(layout.largest_code(0)), all = codes > 0 ? 100 * kTold / codes : 100;
  return std::string(layout.name) + " hides what changes a pixel by less than a code, " + real(one, "%.2g") +
         " % of white, and of an error of all light what is below " + real(std::clamp(all, kSmallest, 100.0), "%.2g") +
         " %; rgba16f and rgba32f show it";
}

std::vector<std::string> hidden_by_materials(const oracle::Verdict& v) {
  std::vector<std::string> lines;
  std::string key;
  for (const oracle::MaterialEvidence& e : v.materials) {
    if (e.is_of_channel || e.cause == "order") continue;
    const bool is_relative = e.cause == "gain" || e.cause == "scale";
    const std::string now = e.subject() + ", " + (e.map.empty() ? "glass" : e.map) + " in " + e.plane;
    const std::string limit =
        e.cause + ' ' + real(is_relative ? 100 * e.least : e.least, "%.2g") + (is_relative ? " %" : "");
    if (now == key)
      lines.back() += ", " + limit;
    else
      lines.push_back(now + ": what is off by less than " + limit);
    key = now;
  }
  return lines;
}

std::string power_line(const oracle::Verdict& v) {
  for (const StageVerdict& s : v.stages)
    if (s.power >= 1)
      return "half of the lit pixels show no error of light by themselves";
    else if (s.power > 0)
      return "light that is " + real(100 * s.power, "%.2g") + " % more is in no legal set at half of the lit pixels";
  return "";
}

const StageVerdict* failed_stage(const oracle::Verdict& v) {
  for (const StageVerdict& s : v.stages)
    if (!s.passes()) return &s;
  for (size_t i = 0; i < v.stages.size(); ++i)
    if (v.evidence[i].against) return &v.stages[i];
  for (const StageVerdict& s : v.stages)
    for (const oracle::MaterialEvidence& e : v.materials)
      if (e.against && e.stage == s.stage) return &s;
  return nullptr;
}

double exact_share(const StageVerdict& stage) {
  return double(stage.count(PixelClass::exact) + stage.count(PixelClass::store_2)) /
         double(std::max<uint64_t>(stage.judged(), 1));
}

std::string left_out_line(const Validation& v) {
  const uint64_t count = v.capture.mask.count(), all = v.capture.mask.left_out.size();
  return v.left_out_by + ": " + std::to_string(count) + " of " + std::to_string(all) + " pixels left out, " +
         real(all > 0 ? 100.0 * double(count) / double(all) : 0.0, "%.3g") + " %";
}

std::string lights_of(const Pipeline& pipeline) {
  return pipeline.light_program.used() ? "light program " + pipeline.light_program.file : "preset " + pipeline.preset;
}

namespace {

bool is_explained(const Validation& v) { return !v.findings.empty() && !v.findings[0].partial; }

/// Whether the quotient's law leaves next to nothing, so that it says what the light is.
bool is_told_by_quotient(const Validation& v) {
  constexpr double kNextToNothing = 0.02;
  return v.quotient && v.quotient->left < kNextToNothing;
}

/// Where no fault explains the light: the quotient's description in words, and eight steps of its curve.
std::string quotient_text(const oracle::LightQuotient& q) {
  std::string lines =
      verdict_row("its light", q.text + "; that leaves " + real(100 * q.left, "%.2g") + " % of the difference");
  if (q.against == "light") return lines;
  constexpr size_t kMost = 8;
  std::string curve;
  const size_t steps = std::min(kMost, q.curve.size());
  for (size_t i = 0; i < steps; ++i) {
    const auto& step = q.curve[steps > 1 ? i * (q.curve.size() - 1) / (steps - 1) : 0];
    curve += (i > 0 ? ", " : "") + real((step.from + step.to) / 2, "%.3g") + ": " + real(step.factor, "%.3g");
  }
  return lines + verdict_row("", "times what it should be, by " + q.against + ": " + curve);
}

}  // namespace

std::string validation_text(const Validation& v) {
  std::string lines = verdict_row("scene", v.verdict.scene);
  lines +=
      verdict_row("pipeline", lights_of(v.pipeline) + ", " + std::to_string(v.pipeline.width) + 'x' +
                                  std::to_string(v.pipeline.height) + ", " + std::string(info(v.pipeline.target).name));
  lines += verdict_row("driver", v.verdict.driver) + verdict_row("profile", profile_line(v.profile));
  for (const std::string& note : v.notes) lines += verdict_row("note", note);
  if (!v.left_out_by.empty()) lines += verdict_row("mask", left_out_line(v));
  std::string times;
  for (const DriverFrame::Pass& pass : v.passes) times += pass.name + ' ' + real(pass.ms, "%.1f") + " ms, ";
  if (v.timed_frames > 1) times += "(median of " + std::to_string(v.timed_frames) + " frames) ";
  lines += verdict_row("times", times + "judged in " + real(v.judge_ms / 1000, "%.2f") + " s");
  if (v.repeat_changes) lines += verdict_row("invariance", invariance_line(v));
  for (size_t i = 0; i < v.verdict.stages.size(); ++i)
    lines += stage_text(v.verdict.stages[i], v.verdict.evidence[i], v.verdict.least_chance(v.verdict.stages.size()));
  lines += '\n';
  const auto add_row = [&lines](const char* name, const std::string& value) {
    if (!value.empty()) lines += verdict_row(name, value);
  };
  add_row("rounding", rounding_line(v.verdict));
  add_row("power", power_line(v.verdict));
  add_row("hidden", blind_spot_line(v));
  constexpr size_t kMostHidden = 12;
  const std::vector<std::string> hidden = hidden_by_materials(v.verdict);
  for (size_t i = 0; i < std::min(kMostHidden, hidden.size()); ++i) add_row(i == 0 ? "hidden" : "", hidden[i]);
  if (hidden.size() > kMostHidden)
    add_row("", "and of " + std::to_string(hidden.size() - kMostHidden) + " more, which --json has under `materials`");
  add_row("evidence", v.verdict.evidence_line());
  if (v.verdict.inferred) lines += verdict_row("tightest", tightest_line(*v.verdict.inferred));
  lines += verdict_row("verdict", conclusion(v));
  if (v.is_diagnosed && !is_explained(v) && !is_told_by_quotient(v))
    lines += verdict_row("looks like", "no fault that is known");
  if (v.quotient) lines += quotient_text(*v.quotient);
  for (const oracle::Finding& f : v.findings) {
    lines += verdict_row(f.together  ? "and"
                         : f.tied    ? "or as well"
                         : f.partial ? "may be part"
                                     : "looks like",
                         finding_line(f));
    for (const std::string& line : program_lines(f)) lines += verdict_row("", line);
    lines += verdict_row("", proof_line(f)) + (f.command.empty() ? "" : verdict_row("", "try: " + f.command));
  }
  return lines;
}

std::string validation_json(const Validation& v) {
  JsonArray passes, notes;
  for (const DriverFrame::Pass& pass : v.passes)
    passes.add_raw(JsonObject().put("name", pass.name).put("ms", pass.ms).text());
  for (const std::string& note : v.notes) notes.add_raw(json_string(note));
  for (const std::string& note : v.scene_notes.lines) notes.add_raw(json_string(note));
  JsonObject json;
  json.put("version", kVersion);
  json.put_raw("pipeline", pipeline_json(v.pipeline));
  if (v.capture.color.width > 0) json.put("hash", "sha256:" + image_hash(v.capture.color));
  json.put("subpixel_bits", v.profile.subpixel_bits)
      .put_raw("passes", passes.text())
      .put("timed_frames", v.timed_frames)
      .put_raw("notes", notes.text())
      .put("post_chain", v.pipeline.post.active() ? "not judged" : "none");
  if (const std::string hidden = blind_spot_line(v); !hidden.empty()) json.put("hidden", hidden);
  if (!v.left_out_by.empty()) json.put("left_out_by", v.left_out_by).put("left_out_pixels", v.capture.mask.count());
  json.put("lenient", v.lenient).put_raw("ignored", ignored_json(v.scene_notes));
  if (v.repeat_changes) json.put("repeat_changes", *v.repeat_changes);
  if (v.move_changes) json.put("move_changes", *v.move_changes);
  json.put("draw_ms", v.draw_ms)
      .put("judge_ms", v.judge_ms)
      .put_raw("verdict", oracle::verdict_json(v.verdict))
      .put_raw("diagnosis", oracle::findings_json(v.findings));
  if (v.quotient) json.put_raw("quotient", oracle::quotient_json(*v.quotient));
  return json.text();
}

void find_explanation(const Scene& scene, Validation& v, std::span<const std::string> supposed) {
  v.findings = oracle::diagnose(scene, v.pipeline, v.profile, v.capture, v.verdict.stages, supposed);
  constexpr double kWell = 0.95, kHardlyWrong = 0.05;
  size_t last = 0;  // of the faults that are the likeliest together
  while (last + 1 < v.findings.size() && v.findings[last + 1].together) ++last;
  const bool is_told = is_explained(v) && v.findings[last].explained + v.findings[last].located > kWell &&
                       v.findings[last].contradicted < kHardlyWrong;
  if (is_told || !supposed.empty()) return;
  for (const oracle::StageVerdict& stage : v.verdict.stages)
    if (stage.stage == "lighting") v.quotient = oracle::light_quotient(scene, v.pipeline, v.profile, v.capture, stage);
}

}  // namespace trueshade
