// Preloaded, leaves the process another floating-point environment than the usual one, as a library of some host may:
// TRUESHADE_ROUNDING is `up` or `down`, or `traps`, which leaves all exceptions unmasked.
#include <cfenv>
#include <cstdlib>
#include <string_view>

[[gnu::constructor]] static void round_otherwise() {
  const char* const name = std::getenv("TRUESHADE_ROUNDING");
  const std::string_view way = name == nullptr ? "" : name;
  if (way == "up") std::fesetround(FE_UPWARD);
  if (way == "down") std::fesetround(FE_DOWNWARD);
  if (way == "traps") feenableexcept(FE_ALL_EXCEPT);
}
