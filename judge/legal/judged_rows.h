#pragma once
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace trueshade::oracle {

/// Which rows of an image are judged: all of them, or some whole bands. Rows count from the top.
class JudgedRows {
 public:
  static constexpr int kBand = 16;  ///< rows; bands count from the top as well

  JudgedRows() = default;  ///< all rows
  /// Judges the bands whose entry is not 0.
  explicit JudgedRows(std::vector<uint8_t> bands) : some_(true), bands_(std::move(bands)) {}

  /// How many bands an image of this height in rows has.
  static int bands_of(int height) { return (height + kBand - 1) / kBand; }
  /// Whether all rows are judged.
  bool all() const { return !some_; }
  /// For each band, from the top, whether it is judged (not 0); empty where all rows are.
  const std::vector<uint8_t>& bands() const { return bands_; }
  /// Whether a band, counted from the top, is judged.
  bool has_band(int band) const { return !some_ || bands_[size_t(band)] != 0; }
  /// Whether a row, counted from the top, is judged.
  bool has(int y) const { return has_band(y / kBand); }

 private:
  bool some_ = false;
  std::vector<uint8_t> bands_;
};

}  // namespace trueshade::oracle
