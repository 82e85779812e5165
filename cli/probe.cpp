// `trueshade probe`.
#include "judge/probe/probe.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "cli/activity.h"
#include "cli/commands.h"
#include "cli/json_text.h"
#include "cli/vulkan_capture.h"
#include "cli/written_files.h"
#include "core/error.h"
#include "core/image_files/image_io.h"
#include "judge/bounds/profile_file.h"

namespace trueshade {
namespace {

using oracle::ProbeCheck;
using oracle::ProbedField;
using oracle::ProbeFrame;
using oracle::ProbePlan;
using oracle::ProbeResult;

/// The target after each light, kept, since the driver is closed before it is asked for.
oracle::LightSteps kept(const oracle::LightSteps& steps) {
  auto images = std::make_shared<std::vector<std::pair<int, Image>>>();
  steps([&](int light, const Image& target) { images->emplace_back(light, target); });
  return [images](const oracle::StepSink& sink) {
    for (const auto& [light, target] : *images) sink(light, target);
  };
}

struct DrawnPlans {
  std::vector<ProbeFrame> frames;
  std::vector<std::string> not_drawn;  ///< the frame, and what the driver lacks
};

/// Throws where the driver draws none of them.
DrawnPlans drawn(const std::optional<std::string>& driver, const std::vector<ProbePlan>& plans) {
  DrawnPlans out;
  for (const ProbePlan& plan : plans) {
    try {
      DriverFrame frame = drawn_by(driver, plan.scene, plan.pipeline);
      out.frames.push_back({&plan, std::move(frame.capture), {}});
      if (frame.steps) out.frames.back().steps = kept(frame.steps);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::no_gl_driver || out.frames.empty()) throw;
      out.not_drawn.push_back(plan.name + ": " + error.what());
    }
  }
  return out;
}

std::string line_of(const ProbedField& field) {
  constexpr const char* kOpen[] = {"", "unknown: several values explain every frame",
                                   "unknown: no value explains every frame"};
  std::string line = field.field;
  line.resize(std::max<size_t>(34, line.size() + 1), ' ');
  line += field.state == ProbedField::State::told ? field.value : kOpen[size_t(field.state)];
  if (!field.against.empty())
    line += (field.state == ProbedField::State::told ? "  (others fail on " : "  (the last fails on ") + field.against +
            ')';
  return line + '\n';
}

struct Totals {
  uint64_t pixels = 0, exact = 0, violations = 0;
};

Totals totals_of(const std::vector<ProbeCheck>& checks) {
  Totals t;
  for (const ProbeCheck& c : checks) t.pixels += c.pixels, t.exact += c.exact, t.violations += c.violations;
  return t;
}

std::string verdict_line(const std::vector<ProbeCheck>& checks) {
  const Totals t = totals_of(checks);
  char share[32];
  std::snprintf(share, sizeof share, "%.3f", 100.0 * double(t.exact) / double(std::max<uint64_t>(t.pixels, 1)));
  return "verdict     " +
         (t.violations == 0 ? std::string("the profile explains ")
                            : std::to_string(t.violations) + " pixels are in no legal set of the profile, in ") +
         std::to_string(checks.size()) + " held-out frames, " + share + " % of pixels EXACT\n";
}

std::string report_of(const std::string& driver, const std::vector<std::string>& not_drawn, const ProbeResult& result,
                      const std::vector<ProbeCheck>& checks) {
  std::string text = "driver      " + driver + '\n';
  for (const std::string& frame : not_drawn) text += "not drawn   " + frame + '\n';
  for (const std::string& frame : result.set_aside)
    text += "set aside   " + frame + ": no OpenGL draws this, so nothing is learnt of it\n";
  for (const ProbedField& field : result.fields) text += line_of(field);
  for (const ProbeCheck& check : checks)
    if (check.violations > 0)
      text += "held out    " + check.frame + ": " + std::to_string(check.violations) + " pixels in no legal set\n";
  return text + verdict_line(checks);
}

std::string report_json(const std::string& driver, const std::vector<std::string>& not_drawn, const ProbeResult& result,
                        const std::vector<ProbeCheck>& checks) {
  constexpr const char* kStates[] = {"told", "open", "refuted"};
  JsonArray fields, frames, set_aside, lacking;
  for (const std::string& frame : not_drawn) lacking.add_raw(json_string(frame));
  for (const std::string& frame : result.set_aside) set_aside.add_raw(json_string(frame));
  for (const ProbedField& f : result.fields)
    fields.add_raw(JsonObject()
                       .put("field", f.field)
                       .put("state", kStates[size_t(f.state)])
                       .put("value", f.value)
                       .put("tried", f.tried)
                       .put("against", f.against)
                       .text());
  for (const ProbeCheck& c : checks)
    frames.add_raw(JsonObject()
                       .put("frame", c.frame)
                       .put("pixels", c.pixels)
                       .put("exact", c.exact)
                       .put("violations", c.violations)
                       .text());
  return JsonObject()
             .put("driver", driver)
             .put_raw("profile", oracle::profile_json(result.profile))
             .put_raw("fields", fields.text())
             .put_raw("not_drawn", lacking.text())
             .put_raw("set_aside", set_aside.text())
             .put_raw("held_out", frames.text())
             .put("pass", totals_of(checks).violations == 0)
             .text() +
         '\n';
}

}  // namespace

bool probe_driver(const ProbeOptions& options) {
  constexpr uint64_t kProbed = 1, kHeldOut = 2;
  if (!options.output.empty()) check_writable(options.output);
  Activity activity("drawing");
  const std::vector<ProbePlan> plans = oracle::probe_plans(kProbed), others = oracle::probe_plans(kHeldOut);
  const DrawnPlans probed = drawn(options.driver, plans), held_out = drawn(options.driver, others);
  const std::string driver = probed.frames.front().capture.driver;
  activity.now("telling one rule from another");
  const ProbeResult result = oracle::probe_profile(probed.frames, options.name.value_or(driver.substr(0, 100)));
  activity.now("judging frames that were held out");
  std::vector<ProbeCheck> checks;
  for (const ProbeFrame& frame : held_out.frames)
    if (std::find(result.set_aside.begin(), result.set_aside.end(), frame.plan->name) == result.set_aside.end())
      checks.push_back(oracle::check_profile(frame, result.profile));
  if (!options.output.empty()) {
    const std::string text = oracle::profile_json(result.profile);
    write_file(options.output, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
  }
  print(options.json ? report_json(driver, probed.not_drawn, result, checks)
                     : shown_report(report_of(driver, probed.not_drawn, result, checks)));
  if (!options.output.empty())
    say_written(options.output, "profile", options.json ? StandardOutput::answer : StandardOutput::files);
  return totals_of(checks).violations == 0;
}

}  // namespace trueshade
