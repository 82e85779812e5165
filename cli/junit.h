#pragma once
#include <string>

#include "cli/picture_rows.h"
#include "core/error.h"
#include "core/printable_text.h"

namespace trueshade {

/// What CI services read of a test run: a testcase a picture, with a failure where it does not pass and an error where
/// it cannot be read. Characters that XML does not allow are shown as `?`.
std::string junit_xml(const FolderComparison& folders);

/// Writes the error that ends a command, `trueshade compare` say, into its report, in place of what an earlier run wrote:
/// CI services would show that. A report that cannot be written is left as it is, since the first error is the one to
/// tell.
///   checked: what the command was to check
void report_error(const std::string& report, const std::string& command, const std::string& checked, const Error& error);

/// Text as content or attribute of XML.
std::string xml_text(std::string_view text, Lines lines = Lines::one);

}  // namespace trueshade
