#include "judge/legal/pixel_class.h"

#include <algorithm>
#include <iterator>

namespace trueshade::oracle {

std::string_view text(PixelClass c) {
  switch (c) {
    case PixelClass::exact:
      return "EXACT";
    case PixelClass::store_2:
      return "STORE-2";
    case PixelClass::edge:
      return "EDGE";
    case PixelClass::depth_tie:
      return "DEPTH-TIE";
    case PixelClass::clip:
      return "CLIP";
    case PixelClass::branch:
      return "BRANCH";
    case PixelClass::tex:
      return "TEX";
    case PixelClass::undefined:
      return "UNDEFINED";
    case PixelClass::violation:
      return "VIOLATION";
    case PixelClass::left_out:
      return "LEFT OUT";
  }
  return {};
}

bool worse(PixelClass a, PixelClass b) {
  const auto rank = [](PixelClass c) {
    constexpr PixelClass order[] = {
        PixelClass::exact, PixelClass::left_out, PixelClass::store_2,   PixelClass::tex,       PixelClass::branch,
        PixelClass::clip,  PixelClass::edge,     PixelClass::depth_tie, PixelClass::undefined, PixelClass::violation};
    return std::find(std::begin(order), std::end(order), c) - std::begin(order);
  };
  return rank(a) > rank(b);
}

}  // namespace trueshade::oracle
