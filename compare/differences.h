#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compare/stored_value.h"
#include "core/local_windows.h"
#include "core/pixel_mask.h"

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

/// Of one side of windows, the worst over all parts. Found are the pixels beyond what is asked for; a pixel's error is
/// the largest difference of its channels.
struct WorstWindow {
  LocalWindow window;
  size_t part = 0;     ///< of Pairing::parts
  double share = 0.0;  ///< LocalWindow::share()
};

/// How two pictures differ. A pixel that is left out is in none of the figures but `left_out`.
struct Differences {
  std::vector<ChannelDifferences> channels;  ///< of all parts, in their order
  uint64_t pixels = 0;                       ///< of all parts, but for those left out
  uint64_t left_out = 0;                     ///< pixels of all parts
  uint64_t unequal_pixels = 0;               ///< with a channel whose stored values are not equal
  uint64_t unequal_other_pixels = 0;         ///< the same of channels other than R, G, B and Y of the first part
  uint64_t pixels_beyond = 0;                ///< with a channel that differs by more than asked for
  uint64_t not_finite_pixels = 0;            ///< with a value in either picture that is not finite
  uint64_t apart_pixels = 0;                 ///< those of them in which the two values are not the same
  std::optional<Place> first, worst, first_not_finite;
  double delta = 0.0;                ///< what `pixels_beyond` and windows let pass
  std::vector<WorstWindow> windows;  ///< of each side asked for that has a pixel that differs
};

/// Which of the two have R, G, B and Y decoded from sRGB values.
struct Decoding {
  bool reference = false, test = false;
};

/// Whether colour management is about this channel: R, G, B or Y, as they are named in a picture without layers.
bool is_color(const Channel& channel);

/// What is counted, and where.
struct CountRules {
  double beyond = 0.0;              ///< of pixels_beyond, and of what windows find
  int threads = 0;                  ///< 0: one a core. Never changes a figure
  std::vector<int> window_sides{};  ///< each as LocalWindows takes them
  const PixelMask* mask = nullptr;  ///< of the size of every part; null: no pixel is left out
};

/// Counts over all pixels. The same figures for every number of threads: they are summed a band of rows at a time, and
/// bands from the top down.
Differences differences(const Pairing& pairing, Decoding decoding, const CountRules& rules);

}  // namespace trueshade::compare
