#include "scenes/pipeline/post_chain.h"

#include "core/fp_env.h"

namespace trueshade {

bool PostChain::active() const {
  const FpScope fp;
  return samples > 1 || marker_radius > 0.0f || bloom.strength > 0.0f || tone_map != ToneMap::none ||
         encode != Encode::linear || edge_filter;
}

}  // namespace trueshade
