#pragma once
#include <string>

#include "explain/account.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade {

/// Where the pipeline has a post chain, appends the finished picture's pixel to the target's account as `stored`, and
/// renames the target's own value there to `target`. Renders the whole picture to do so. Without a post chain, does
/// nothing.
///   pipeline: with the post chain
///   x, y: of the picture, from the top left
void add_finished_pixel(const Scene& scene, const Pipeline& pipeline, int x, int y, Account& account);

/// account_text() with the stored pixel repeated in a last line, where programs look for it. The account's last
/// quantity must be the stored pixel.
std::string explanation_text(const Account& account);

}  // namespace trueshade
