// Preloaded, leaves the process another rounding mode than the usual one, as a library of some host may: up or down, as
// TRUESHADE_ROUNDING says.
#include <cfenv>
#include <cstdlib>

[[gnu::constructor]] static void round_otherwise() {
  const char* const way = std::getenv("TRUESHADE_ROUNDING");
  if (way != nullptr) std::fesetround(*way == 'u' ? FE_UPWARD : FE_DOWNWARD);
}
