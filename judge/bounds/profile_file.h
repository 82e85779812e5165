#pragma once
// A profile as a file: JSON that `trueshade probe` writes and `validate --profile FILE` reads.
#include <string>
#include <string_view>

#include "judge/bounds/profile.h"

namespace trueshade::oracle {

/// All fields of a profile in a fixed order, a line each: equal profiles are equal texts.
std::string profile_json(const Profile& profile);

/// Reads a profile. Fields that the text does not give are those of `unknown`. Error(bad_input) with a JSON pointer
/// behind `where` for what is no JSON, for unknown keys, and for values of another type or out of range.
Profile profile_from_json(std::string_view text, std::string_view where);

}  // namespace trueshade::oracle
