#pragma once
#include <optional>
#include <string_view>

#include "programs/values/program.h"

namespace trueshade::programs {

/// The type of a field of programs/light_interface.glsl by the name of one of its scalars, "light.user[2].w"; nothing
/// where there is no such field. "sum.x" is one; parameters are not.
std::optional<Type> type_of_field(std::string_view name);

}  // namespace trueshade::programs
