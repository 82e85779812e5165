#pragma once
// What the ranks of share_tasks() say to each other.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace trueshade {

/// One message of a rank to another. Members that its kind (`what`) does not use keep their defaults.
struct RankSays {
  enum class What : uint8_t {
    beat,     ///< the sender is there
    hello,    ///< to rank 0: it is ready; words: names and values of the identity, in turn; number: tasks at once
    work,     ///< from rank 0: number: a task; bytes: its brief
    result,   ///< to rank 0: number: the task; bytes
    failure,  ///< to rank 0: number: the task, or -1 before there were any; kind; words: the text
    end,      ///< from rank 0: nothing is left to do; numbers: ranks that are lost; number: 1: another round follows
    bye,      ///< to rank 0: it has seen the end
  };
  What what;
  uint32_t round = 0;  ///< which call of share_tasks(), from 0
  int32_t number = -1;
  int32_t kind = 0;  ///< an ErrorKind, 0 for an exception of another class
  std::vector<int32_t> numbers{};
  std::vector<std::string> words{};
  std::vector<uint8_t> bytes{};
};

/// The time between two signs of life (beats) of a rank: a fifth of `lost_after`, and at most a second.
inline std::chrono::milliseconds beat_interval(std::chrono::milliseconds lost_after) {
  return std::min(std::chrono::milliseconds(1000), lost_after / 5);
}

/// A message as bytes, which unpacked() of the same program version reads.
std::vector<uint8_t> packed(const RankSays& says);
/// Reads bytes that packed() made. Nothing where they are not a message of this version.
std::optional<RankSays> unpacked(std::span<const uint8_t> message);

}  // namespace trueshade
