#include "judge/legal/pixel_class.h"

#include <algorithm>
#include <iterator>

namespace trueshade::oracle {

std::string_view text(PixelClass c) {
  static constexpr std::string_view names[kPixelClasses] = {"EXACT",  "STORE-2", "EDGE",      "DEPTH-TIE", "CLIP",
                                                            "BRANCH", "TEX",     "UNDEFINED", "VIOLATION"};
  return names[size_t(c)];
}

bool worse(PixelClass a, PixelClass b) {
  const auto rank = [](PixelClass c) {
    constexpr PixelClass order[] = {PixelClass::exact,     PixelClass::store_2,   PixelClass::tex,
                                    PixelClass::branch,    PixelClass::clip,      PixelClass::edge,
                                    PixelClass::depth_tie, PixelClass::undefined, PixelClass::violation};
    return std::find(std::begin(order), std::end(order), c) - std::begin(order);
  };
  return rank(a) > rank(b);
}

}  // namespace trueshade::oracle
