#pragma once
#include <string>

#include "explain/account.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade {

/// Where the pipeline has a post chain, appends the picture's pixel to the target's account as `stored`, and renames
/// the target's own value to `target`. Draws the whole picture for it. Without a post chain, does nothing.
///   pipeline: with the post chain
///   x, y:     of the picture, from the top left
void add_finished_pixel(const Scene& scene, const Pipeline& pipeline, int x, int y, Account& account);

/// account_text(), and a last line with the stored pixel, where programs look for it; people find it among the first
/// lines. The last quantity of the account is the stored pixel.
std::string explanation_text(const Account& account);

}  // namespace trueshade
