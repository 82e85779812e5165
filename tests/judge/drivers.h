#pragma once
// Real drivers for the judge. A process keeps the first Mesa driver it opened: what needs two has the second draw in a
// process of its own.
#include <optional>
#include <string>

#include "oracle/capture.h"
#include "tests/gl/opened_driver.h"

namespace trueshade::testing {

/// What the hidden test case `drawer` of this program drew in a process of its own and handed over by
/// hand_over(). Nothing where it had no driver; then the test has said SKIPPED and why.
std::optional<oracle::Capture> drawn_elsewhere(const std::string& drawer);

/// For a drawer: false in a process that was not started by drawn_elsewhere().
bool is_elsewhere();
void hand_over(const oracle::Capture& capture);

}  // namespace trueshade::testing
