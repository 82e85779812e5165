#pragma once
// Conversions to codes of which only the sum is seen, as the draws of a row make them.
#include <span>
#include <vector>

#include "judge/stages/verdict.h"

namespace trueshade::oracle {

/// Remembers, for a row of pixels, the draws whose conversion to a code may have given either of two codes. Of rows
/// with very many, it keeps those of some pixels only, chosen pseudo-randomly.
class ConversionsInDoubt {
 public:
  /// Notes a conversion in doubt: that of a channel of a draw in column x whose code is added to what the channel
  /// holds. Does nothing where the pixel is none of those that are kept.
  void add(int x, const NearThreshold& conversion);

  /// Notes a draw in column x that overwrites a channel: forgets what was noted of that channel there.
  void replace(int x, int channel);

  /// The conversions that were noted of one channel of the pixel in column x, in the order of the draws; none where the
  /// pixel is not kept. Valid until the next add() or replace().
  std::span<const NearThreshold> at(int x, int channel);

 private:
  struct Entry {
    uint32_t place;  ///< x and channel
    bool replaces;   ///< and is no conversion
    NearThreshold conversion;
  };
  bool is_kept(int x) const;
  void keep_fewer();
  void sort();

  std::vector<Entry> entries_;
  uint32_t one_in_ = 1;  ///< so many pixels is kept: a power of two
  std::vector<NearThreshold> sorted_;
  std::vector<uint32_t> places_;  ///< of these
  bool is_sorted_ = true;
};

}  // namespace trueshade::oracle
