#pragma once
#include <string>

#include "cli/picture_rows.h"
#include "core/printable_text.h"

namespace trueshade {

/// What CI services read of a test run: a testcase a picture, with a failure where it does not pass and an error where
/// it cannot be read. Characters that XML does not allow are shown as `?`.
std::string junit_xml(const FolderComparison& folders);

/// Text as content or attribute of XML.
std::string xml_text(std::string_view text, Lines lines = Lines::one);

}  // namespace trueshade
