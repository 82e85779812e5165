#include "view/view_state.h"

#include <algorithm>
#include <cmath>

#include "core/fp_env.h"

namespace trueshade::viewer {

Pipeline drawn_pipeline(const ViewState& state) {
  const FpScope fp;
  Pipeline pipeline = state.pipeline;
  if (pipeline.light_program.used()) return pipeline;  // which reads no damping
  const double damping = double(pipeline.light_model.damping) * std::exp2(state.exposure);
  pipeline.light_model.damping = float(std::min(damping, 1e18));
  return pipeline;
}

}  // namespace trueshade::viewer
