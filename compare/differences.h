#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compare/stored_value.h"

namespace trueshade::compare {

/// A pixel of a part, from the top left.
struct Place {
  size_t part = 0;  ///< of Pairing::parts
  int x = 0, y = 0;
};

/// How one channel differs. Sums are over pixels whose two values are finite.
struct ChannelDifferences {
  std::string name;
  std::string reference_storage, test_storage;  ///< storage_text()
  uint64_t pixels = 0, unequal = 0;
  uint64_t not_finite_reference = 0, not_finite_test = 0;
  double largest = 0.0;      ///< difference; infinite where a value is not finite and the other is another
  double largest_ulp = 0.0;  ///< the same
  Place worst;               ///< where `largest` is first; meaningless while that is 0
  double sum = 0.0, sum_of_squares = 0.0;
  uint64_t finite = 0;
  double peak = 1.0;  ///< of PSNR: 1 of codes, else the reference's largest finite magnitude, at least 1

  double mean() const { return finite > 0 ? sum / double(finite) : 0.0; }
  double rms() const;
  double psnr() const;  ///< dB; infinite where nothing differs, NaN where a pixel differs without an end
};

/// How two pictures differ.
struct Differences {
  std::vector<ChannelDifferences> channels;  ///< of all parts, in their order
  uint64_t pixels = 0;                       ///< of all parts
  uint64_t unequal_pixels = 0;               ///< with a channel whose stored values are not equal
  uint64_t unequal_other_pixels = 0;         ///< the same of channels other than R, G, B and Y of the first part
  uint64_t pixels_beyond = 0;                ///< with a channel that differs by more than asked for
  uint64_t not_finite_pixels = 0;            ///< with a value in either picture that is not finite
  uint64_t apart_pixels = 0;                 ///< those of them in which the two values are not the same
  std::optional<Place> first, worst, first_not_finite;
};

/// Which of the two have R, G, B and Y decoded from sRGB values.
struct Decoding {
  bool reference = false, test = false;
};

/// Whether colour management is about this channel: R, G, B or Y, as they are named in a picture without layers.
bool is_color(const Channel& channel);

/// Counts over all pixels, on `threads` threads (0: one a core). `beyond`: of pixels_beyond. The same figures for every
/// number of threads: they are summed a band of rows at a time, and bands from the top down.
Differences differences(const Pairing& pairing, Decoding decoding, double beyond, int threads);

}  // namespace trueshade::compare
