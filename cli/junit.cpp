#include "cli/junit.h"

#include <cstdio>

#include "cli/written_files.h"
#include "core/printable_text.h"

namespace trueshade {
namespace {

std::string seconds_text(double seconds) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3f", seconds);
  return text;
}

std::string attribute(const char* name, std::string_view value) {
  return std::string(" ") + name + "=\"" + xml_text(value) + '"';
}

constexpr std::string_view kOutcomeNames[] = {"", "failure", "error", "skipped"};

std::string attributes_of(std::span<const JUnitCase> cases, std::optional<double> of_all) {
  size_t count[std::size(kOutcomeNames)] = {};
  double seconds = 0.0;
  for (const JUnitCase& one : cases) ++count[size_t(one.outcome)], seconds += one.seconds;
  std::string text = attribute("tests", std::to_string(cases.size())) +
                     attribute("failures", std::to_string(count[size_t(JUnitOutcome::failure)]));
  if (const size_t skipped = count[size_t(JUnitOutcome::skipped)]; skipped > 0)
    text += attribute("skipped", std::to_string(skipped));
  return text + attribute("errors", std::to_string(count[size_t(JUnitOutcome::error)])) +
         attribute("time", seconds_text(of_all.value_or(seconds)));
}

std::string testcase(const std::string& checked, const JUnitCase& one) {
  const std::string xml = "    <testcase" + attribute("classname", checked) + attribute("name", one.name) +
                          attribute("time", seconds_text(one.seconds));
  const bool passed = one.outcome == JUnitOutcome::passed;
  if (passed && one.body.empty()) return xml + "/>\n";
  if (passed) return xml + ">\n      <system-out>" + xml_text(one.body) + "</system-out>\n    </testcase>\n";
  const std::string element(kOutcomeNames[size_t(one.outcome)]);
  const std::string opened = xml + ">\n      <" + element +
                             (one.type.empty() ? std::string() : attribute("type", one.type)) +
                             attribute("message", one.message);
  if (one.body.empty()) return opened + "/>\n    </testcase>\n";
  return opened + ">" + xml_text(one.body, Lines::several) + "</" + element + ">\n    </testcase>\n";
}

}  // namespace

std::string xml_text(std::string_view text, Lines lines) {
  std::string xml;
  for (const char c : printable(text, lines)) {
    if (c == '&')
      xml += "&amp;";
    else if (c == '<')
      xml += "&lt;";
    else if (c == '>')
      xml += "&gt;";
    else if (c == '"')
      xml += "&quot;";
    else if (c == '\'')
      xml += "&apos;";
    else
      xml += c;
  }
  return xml;
}

std::string junit_xml(const std::string& command, const std::string& checked, std::span<const JUnitCase> cases,
                      std::optional<double> seconds) {
  const std::string figures = attributes_of(cases, seconds);
  std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites" + attribute("name", command) + figures +
                    ">\n  <testsuite" + attribute("name", checked) + figures + ">\n";
  for (const JUnitCase& one : cases) xml += testcase(checked, one);
  return xml + "  </testsuite>\n</testsuites>\n";
}

std::vector<JUnitCase> junit_cases(const FolderComparison& folders) {
  std::vector<JUnitCase> cases;
  for (const PictureRow& row : folders.rows) {
    const JUnitOutcome outcome = passes(row)                         ? JUnitOutcome::passed
                                 : row.state == RowState::unreadable ? JUnitOutcome::error
                                                                     : JUnitOutcome::failure;
    std::string body = row.details.empty() ? row.reason : row.details;
    if (!row.not_accepted.empty()) body += "; not accepted: " + row.not_accepted;
    if (passes(row)) body = row.left_out_pixels == 0 ? std::string() : row.reason;
    cases.push_back({row.name, row.seconds, outcome, std::string(name_of(row.state)), row.reason, std::move(body)});
  }
  return cases;
}

void report_error(const std::string& report, const std::string& command, const std::string& checked,
                  const Error& error) {
  const JUnitCase ended{checked, 0.0, JUnitOutcome::error, "ended", error.what(), error.what()};
  try {
    write_text(report, junit_xml(command, checked, {&ended, 1}));
  } catch (const Error&) {
  }
}

}  // namespace trueshade
