#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "compare/pairing.h"

namespace trueshade::compare {

/// What two stored numbers of a pair of channels are to each other.
struct NumberPair {
  double reference, test;  ///< what they stand for
  bool equal;              ///< stored alike: the same bits, or of two kinds of storage the same value
  bool reference_finite, test_finite;
  double
      difference;  ///< of the values, 0 where both are the same infinity or both NaN; infinite where one is not finite
  double ulp;      ///< steps of the storage between them, of two storages of the coarser: floats, halves, codes, whole
                   ///< numbers. Infinite where one is not finite
};

/// How the numbers of a pair of channels are read.
///
/// A code k of b bits stands for k / (2^b - 1), for that rounded to float where the other channel holds floats, and an
/// sRGB code for an sRGB value. Two codes of equal bits differ by their codes' difference over 2^b - 1.
/// `decode_...`: the numbers are sRGB values, and are decoded to linear light (IEC 61966-2-1), as the other picture's
/// are.
class PairReader {
 public:
  PairReader(const ChannelPair& pair, bool decode_reference, bool decode_test);

  NumberPair at(size_t pixel) const;

  /// Whether the words of pixels are compared alone: one kind of storage on both sides, and nothing is decoded.
  bool same_storage() const { return same_storage_; }
  const ChannelPair& pair() const { return *pair_; }

 private:
  double value_of(const Channel& channel, size_t pixel, bool decode) const;
  double steps(size_t pixel, double reference, double test) const;

  const ChannelPair* pair_;
  bool decode_reference_, decode_test_, same_storage_, to_float_;
};

/// A number as it is stored: the code and what it stands for, a whole number, or a float in the digits that give it
/// back; and what it is compared as, if it is decoded.
std::string stored_text(const Channel& channel, size_t pixel, bool decode);

/// `unorm 8`, `half`, `float`, `uint 32`, ...
std::string storage_text(const Channel& channel);

/// The linear light of an sRGB value; values outside [0, 1] by the same curve, mirrored at 0.
double linear_of_srgb(double srgb);
/// The other way.
double srgb_of_linear(double light);

}  // namespace trueshade::compare
