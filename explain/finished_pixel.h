#pragma once
#include <string>

#include "explain/account.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade {

/// What is explained is the target; where a post chain follows, the picture's value comes last in the account instead.
/// `pipeline`: with the chain; (x, y) of the picture, from the top left.
void add_finished_pixel(const Scene& scene, const Pipeline& pipeline, int x, int y, Account& account);

/// account_text(), and a line with the stored pixel: it is among the first lines, where people look for it, and the
/// last, where programs do.
std::string explanation_text(const Account& account);

}  // namespace trueshade
