#include "explain/finished_pixel.h"

#include "explain/against.h"
#include "explain/explain.h"
#include "shading/frame.h"

namespace trueshade {

void add_finished_pixel(const Scene& scene, const Pipeline& pipeline, int x, int y, Account& account) {
  if (!pipeline.post.active()) return;
  const int n = pipeline.post.samples;
  const std::string which =
      n > 1 ? "the upper left of the pixel's " + std::to_string(n) + 'x' + std::to_string(n) + " samples, " : "";
  Quantity& target = account.quantities.back();
  target.name = "target";
  target.meaning = which + target.meaning + ", before the post chain";
  const Image picture = render_frame(scene, pipeline).color;
  const std::string format(info(picture.format).name);
  account.quantities.push_back({"stored",
                                format + ", after the post chain (docs/post.md)",
                                values_in_format(picture.format, stored_in(picture, x, y)),
                                true,
                                {}});
}

std::string explanation_text(const Account& account) {
  const Quantity& stored = account.quantities.back();
  return account_text(account) + "\nstored  " + values_text(stored.values) + "  " + stored.meaning + '\n';
}

}  // namespace trueshade
