#pragma once
#include "judge/bounds/profile.h"

namespace trueshade::oracle {

/// Whether every value that `tight` allows is one that `loose` allows, as far as their knobs tell; false where they do
/// not tell. What is nominal, the likely rule of stores, does not count.
bool allows_all_of(const Profile& loose, const Profile& tight);

}  // namespace trueshade::oracle
