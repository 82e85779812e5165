#pragma once
// Conversions to codes of which only the sum is seen, as the draws of a row make them.
#include <span>
#include <vector>

#include "judge/stages/verdict.h"

namespace trueshade::oracle {

/// The draws of a row of pixels whose conversion may give either of two codes. Of rows with very many some pixels alone
/// are kept, chosen by a number that looks like chance.
class ConversionsInDoubt {
 public:
  /// Notes a draw at x that is blended over what was there.
  void add(int x, const NearThreshold& conversion);

  /// Notes that a draw at x replaces what was there: what was noted of that channel is forgotten.
  void replace(int x, int channel);

  /// The conversions of a channel of a pixel, in the order of the draws; none where the pixel is not kept. Valid until
  /// the next draw.
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
