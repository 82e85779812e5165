#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cli/picture_rows.h"
#include "core/error.h"
#include "core/printable_text.h"

namespace trueshade {

enum class JUnitOutcome : uint8_t { passed, failure, error, skipped };

/// A testcase of a report for CI services.
struct JUnitCase {
  std::string name;
  double seconds = 0.0;
  JUnitOutcome outcome = JUnitOutcome::passed;
  std::string type, message;  ///< of what has not passed: its kind in a word, and the reason in a line
  std::string body;           ///< all that is to be said; of what has passed too, if there is something
};

/// The report of a command, `trueshade compare` say, in JUnit's XML. Characters that XML does not allow are shown as
/// `?`.
///   checked: the folder or file whose parts the cases are
///   seconds: of all together; absent: the sum of the cases'
std::string junit_xml(const std::string& command, const std::string& checked, std::span<const JUnitCase> cases,
                      std::optional<double> seconds = {});

/// A case for each picture: a failure where it does not pass, and an error where it cannot be read.
std::vector<JUnitCase> junit_cases(const FolderComparison& folders);

/// Writes the error that ends a command into its report, in place of what an earlier run wrote: CI services would show
/// that. A report that cannot be written is left as it is, since the first error is the one to tell.
///   checked: what the command was to check
void report_error(const std::string& report, const std::string& command, const std::string& checked,
                  const Error& error);

/// Text as content or attribute of XML.
std::string xml_text(std::string_view text, Lines lines = Lines::one);

}  // namespace trueshade
