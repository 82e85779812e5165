#pragma once
// Rows of known values in short.
#include <bit>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <utility>
#include <vector>

#include "tests/programs/oracle/known_values.h"

namespace trueshade::testing::known {

inline constexpr float kInf = std::numeric_limits<float>::infinity(), kNaN = std::numeric_limits<float>::quiet_NaN();
inline constexpr float kLeast = 0x1p-149f, kMost = 0x1.fffffep127f, kPi = 3.14159265358979f;
inline constexpr uint32_t kMinus = 0x80000000u;

inline KnownValue real(const char* expression, std::vector<float> floats, float expected) {
  return {expression, 'f', std::move(floats), {}, std::bit_cast<uint32_t>(expected)};
}
inline KnownValue truth(const char* expression, std::vector<float> floats, bool expected) {
  return {expression, 'b', std::move(floats), {}, expected};
}
inline KnownValue whole(const char* expression, std::vector<uint32_t> integers, int64_t expected) {
  return {expression, 'i', {}, std::move(integers), uint32_t(expected)};
}
inline KnownValue bits(const char* expression, std::vector<uint32_t> integers, uint32_t expected) {
  return {expression, 'u', {}, std::move(integers), expected};
}
inline KnownValue of_real(const char* expression, char type, std::vector<float> floats, int64_t expected) {
  return {expression, type, std::move(floats), {}, uint32_t(expected)};
}
inline KnownValue real_of(const char* expression, std::vector<uint32_t> integers, float expected) {
  return {expression, 'f', {}, std::move(integers), std::bit_cast<uint32_t>(expected)};
}

using Values = std::vector<KnownValue>;

inline void add(Values& all, std::initializer_list<KnownValue> more) { all.insert(all.end(), more); }

void add_integers(Values& all);
void add_parts(Values& all);
void add_functions(Values& all);

}  // namespace trueshade::testing::known
