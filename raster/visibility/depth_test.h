#pragma once
#include <bit>
#include <cstdint>

#include "scenes/pipeline/pipeline.h"

namespace trueshade {

/// How the depth test decides between equal depths: by the order of submission, which ids ascend in. So the order in
/// which a tile draws is free.
enum class Tie { none, first_wins, last_wins };
constexpr Tie tie_of(DepthFunc func) {
  switch (func) {
    case DepthFunc::less:
    case DepthFunc::greater:
      return Tie::first_wins;
    case DepthFunc::lequal:
    case DepthFunc::gequal:
      return Tie::last_wins;
    default:
      return Tie::none;
  }
}

/// Whether a fragment wins a pixel: its depth `z` and id against those that are there. depth_test-inl.h is the same for
/// vectors.
constexpr bool wins(DepthFunc func, float z, float there, uint32_t id, uint32_t there_id) {
  switch (func) {
    case DepthFunc::never:
      return false;
    case DepthFunc::less:
      return z < there || (z == there && id < there_id);
    case DepthFunc::lequal:
      return z < there || (z == there && id > there_id);
    case DepthFunc::greater:
      return z > there || (z == there && id < there_id);
    case DepthFunc::gequal:
      return z > there || (z == there && id > there_id);
    case DepthFunc::equal:
      return z == there;
    case DepthFunc::notequal:
      return z != there;
    case DepthFunc::always:
      return true;
  }
  return false;
}

/// Depth and id of a fragment as one number, of which LESS and LEQUAL keep the least: wins() of depths that are not
/// negative, whose bits ascend with them. `id_mask`: tie_mask() of the function.
constexpr uint64_t nearest_key(float z, uint32_t id, uint32_t id_mask) {
  return uint64_t(std::bit_cast<uint32_t>(z)) << 32 | (id ^ id_mask);
}
constexpr uint32_t tie_mask(DepthFunc func) { return tie_of(func) == Tie::last_wins ? ~0u : 0u; }

}  // namespace trueshade
