#pragma once
// A profile as a file: JSON that `trueshade probe` writes and `validate --profile FILE` reads.
#include <string>
#include <string_view>

#include "judge/bounds/profile.h"

namespace trueshade::oracle {

/// The profile as JSON: all fields in a fixed order, one a line, so that equal profiles give equal texts.
std::string profile_json(const Profile& profile);

/// Reads a profile from JSON. A field that the text lacks has its value in `unknown`. Error(bad_input) for text that is
/// no JSON, for unknown keys, and for values of another type or out of range; the error names `where` and a JSON
/// pointer.
Profile profile_from_json(std::string_view text, std::string_view where);

}  // namespace trueshade::oracle
