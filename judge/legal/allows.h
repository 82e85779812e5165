#pragma once
#include "judge/bounds/profile.h"

namespace trueshade::oracle {

/// Whether `loose` allows every value that `tight` allows; false also where their fields cannot be compared. The field
/// `likely`, which makes one of the allowed values the nominal one, is not compared.
bool allows_all_of(const Profile& loose, const Profile& tight);

}  // namespace trueshade::oracle
