#include "tests/shading/nan_search.h"

#include <cmath>

#include "shading/frame.h"

namespace trueshade::testing {

std::string fault_of(const Scene& scene, Pipeline pipeline, Format target) {
  pipeline.width = 32, pipeline.height = 24;
  pipeline.target = target;
  Execution execution;
  execution.threads = 1;
  const Image image = render_frame(scene, pipeline, execution).color;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int channel = 0; channel < info(image.format).channels; ++channel)
        if (std::isnan(image.value(x, y, channel)))
          return "NaN at " + std::to_string(x) + "," + std::to_string(y) + " channel " + std::to_string(channel);
  return {};
}

}  // namespace trueshade::testing
