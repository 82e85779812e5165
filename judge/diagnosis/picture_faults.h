#pragma once
// What people get wrong of the picture: how its light is computed, and what becomes of it afterwards.
#include <array>
#include <span>
#include <string>
#include <string_view>

#include "judge/diagnosis/fault_parameter.h"
#include "judge/diagnosis/light_pass.h"

namespace trueshade::oracle {

using Color = std::array<double, 4>;

/// How the picture is flipped and shifted.
struct Move {
  bool flip_x = false, flip_y = false;
  int x = 0, y = 0;  ///< added afterwards, from the top left; outside, the edge's pixel
};

/// How a fault's parameter is found where nobody gives it.
enum class Search : uint8_t {
  none,            ///< it has none
  one_of,          ///< the best of `starts`
  smooth,          ///< from the best of `starts` by least squares
  missing_light,   ///< the light without which most pixels are as given
  doubled_light,   ///< the light that, drawn twice, makes most pixels as given
  count,           ///< how many lights are drawn, by the sums of the first ones
  count_at_pixel,  ///< how many of the lights that reach a pixel are drawn there, likewise
  one_light,       ///< a light and what is changed of it, by least squares
  vector           ///< three numbers of all lights, by least squares
};

/// A row of the tables of picture faults: what a renderer does wrong, and how it changes the prediction.
struct PictureFault {
  std::string_view name, text;  ///< text: `%s` stands for the parameter, `%v` for its vector
  void (*light)(LightPass&, double) = nullptr;
  void (*value)(Color&, double, int x, int y) = nullptr;  ///< of what the picture stands for
  bool (*can)(const LightPass&) = nullptr;                ///< whether it can change anything; null: always
  Search search = Search::none;
  std::span<const double> starts{};
  void (*move)(Move&, double) = nullptr;
  double doubt = 0;  ///< what naming it costs beyond its parameter: the more it can explain by chance
  double reach = 0;  ///< steps that a value may be off before its store: a dither's
  int tile = 0;      ///< side in pixels of tiles lit by a neighbour's light list; the parameter says which
  std::string (*says)(double) = nullptr;  ///< the parameter in words; null: the number
  int stale = 0;                          ///< side in pixels of tiles, a few of which hold something else
  /// For Search::one_light: changes the light by the vector. A vector of `start` changes nothing.
  void (*one_light)(Light&, const std::array<double, 3>& vector) = nullptr;
  bool (*of_light)(const Light&) = nullptr;                               ///< whether the light can have the fault
  double start = 0;                                                       ///< of each component
  void (*by_vector)(LightPass&, const std::array<double, 3>&) = nullptr;  ///< of Search::vector
  int numbers = 3;                                                        ///< components that the fault has
  std::span<const std::array<double, 3>> from{};                          ///< other vectors to start from
  bool counts = false;  ///< the lists of `tile` are its own, and hold the parameter's number of lights at most

  /// Which numbers the fault's parameter has.
  ParameterForm form() const {
    if (search == Search::none) return {};
    if (search == Search::vector) return {false, false, numbers};
    return {true, false, search == Search::one_light ? numbers : 0};
  }
};

/// The values from which the search for a factor starts.
inline constexpr double kFactorsNearOne[] = {0.5, 0.9, 0.99, 1.01, 1.1, 2};

/// Whether the target holds unorm codes.
inline bool holds_codes(const LightPass& p) { return info(p.pipeline.target).number_class == NumberClass::unorm; }

/// Faults of what is done to the picture after it is lit (picture_faults.cpp).
std::span<const PictureFault> picture_value_faults();
/// Faults of how the picture is lit (light_faults.cpp).
std::span<const PictureFault> light_faults();

}  // namespace trueshade::oracle
