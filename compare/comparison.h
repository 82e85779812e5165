#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compare/criteria.h"
#include "compare/differences.h"
#include "compare/flip.h"
#include "compare/pairing.h"
#include "compare/stored_value.h"

namespace trueshade::compare {

/// What is asked of two pictures.
struct CompareRules {
  std::vector<Criterion> criteria;        ///< all must hold; empty: stored values are equal
  bool allow_not_finite = false;          ///< infinities and NaN pass where both pictures have the same
  std::optional<ColorSpace> color_space;  ///< what both pictures' colours are, whatever their files say
  enum class Range : uint8_t { by_storage, low, high } range = Range::by_storage;  ///< FLIP or HDR-FLIP
  FlipOptions flip;
  bool wants_flip = false;  ///< measure FLIP though no criterion asks for it
  PixelMask mask;           ///< pixels that nothing is asked of; of the size of every part, or empty
  int threads = 0;          ///< 0: one a core. Never changes a figure
};

/// A pixel with the values of all its channels, as they are stored.
struct PixelValues {
  struct Value {
    std::string channel, reference, test;  ///< stored_text()
    NumberPair numbers;                    ///< what is compared
  };
  std::string part;  ///< empty where there is one
  int x, y;          ///< from the top left
  std::vector<Value> values;
};

enum class Outcome : uint8_t {
  same,       ///< every stored value is equal, and finite or allowed not to be
  within,     ///< not the same, and all criteria hold
  different,  ///< a criterion does not hold, or a value is not finite
  mismatched  ///< sizes, parts or channels do not fit together
};

/// Two pictures, compared. `pairing` points into the pictures.
struct Comparison {
  Outcome outcome = Outcome::same;
  Pairing pairing;
  Decoding decoding;
  std::string colors;  ///< how colours were compared, in one line
  Differences differences;
  std::vector<Judged> criteria;
  std::optional<FlipResult> flip;
  std::string no_flip;  ///< why `flip`, which was asked for, is not there
  std::optional<PixelValues> first, worst, first_not_finite;
  std::vector<std::string> failures;  ///< why the pictures do not pass, a line each
  std::vector<std::string> notes;     ///< what a reader must know before the figures

  bool passes() const { return outcome == Outcome::same || outcome == Outcome::within; }
};

/// Compares what of the pictures belongs together. Where anything does not, the outcome is `mismatched`, and the rest
/// is measured all the same.
Comparison compared(const PictureFile& reference, const PictureFile& test, const CompareRules& rules);

/// R, G and B of a picture's first part as linear light, or Y as all three; what is not finite as 0. Nothing where it
/// has neither. `decode`: they are sRGB values.
std::optional<LinearPicture> linear_picture(const ChannelFile& part, bool decode);

}  // namespace trueshade::compare
