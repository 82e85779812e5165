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

/// What a reader of the report sees beneath the message.
std::string body(const PictureRow& row) {
  std::string text = row.details.empty() ? row.reason : row.details;
  if (!row.not_accepted.empty()) text += "; not accepted: " + row.not_accepted;
  return xml_text(text, Lines::several);
}

std::string testcase(const FolderComparison& folders, const PictureRow& row) {
  std::string xml = "    <testcase" + attribute("classname", folders.reference) + attribute("name", row.name) +
                    attribute("time", seconds_text(row.seconds));
  if (passes(row)) return xml + "/>\n";
  const std::string element = row.state == RowState::unreadable ? "error" : "failure";
  return xml + ">\n      <" + element + attribute("type", name_of(row.state)) + attribute("message", row.reason) + ">" +
         body(row) + "</" + element + ">\n    </testcase>\n";
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

std::string junit_xml(const FolderComparison& folders) {
  double seconds = 0.0;
  size_t errors = 0;
  for (const PictureRow& row : folders.rows) {
    seconds += row.seconds;
    errors += !passes(row) && row.state == RowState::unreadable ? 1 : 0;
  }
  const std::string figures = attribute("tests", std::to_string(folders.rows.size())) +
                              attribute("failures", std::to_string(folders.failures() - errors)) +
                              attribute("errors", std::to_string(errors)) + attribute("time", seconds_text(seconds));
  std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites" + attribute("name", "trueshade compare") +
                    figures + ">\n  <testsuite" + attribute("name", folders.reference) + figures + ">\n";
  for (const PictureRow& row : folders.rows) xml += testcase(folders, row);
  return xml + "  </testsuite>\n</testsuites>\n";
}

void report_error(const std::string& report, const std::string& command, const std::string& checked,
                  const Error& error) {
  const std::string figures =
      attribute("tests", "1") + attribute("failures", "0") + attribute("errors", "1") + attribute("time", "0");
  const std::string reason = error.what();
  try {
    write_text(report, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites" + attribute("name", command) +
                           figures + ">\n  <testsuite" + attribute("name", checked) + figures + ">\n    <testcase" +
                           attribute("classname", command) + attribute("name", checked) + ">\n      <error" +
                           attribute("type", "ended") + attribute("message", reason) + ">" + xml_text(reason) +
                           "</error>\n    </testcase>\n  </testsuite>\n</testsuites>\n");
  } catch (const Error&) {
  }
}

}  // namespace trueshade
