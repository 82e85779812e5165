#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/files/content/faults.h"

namespace trueshade::ply {

enum class Encoding : uint8_t { ascii, little_endian, big_endian };
enum class Type : uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

constexpr size_t bytes_of(Type type) {
  switch (type) {
    case Type::int8:
    case Type::uint8:
      return 1;
    case Type::int16:
    case Type::uint16:
      return 2;
    case Type::int32:
    case Type::uint32:
    case Type::float32:
      return 4;
    case Type::float64:
      return 8;
  }
  return 0;  // unreachable: every enumerator returns above
}

constexpr bool is_integer(Type type) { return type < Type::float32; }

struct Property {
  std::string name;
  Type type;
  std::optional<Type> count;  ///< of a list: the type of its length
};

struct Element {
  std::string name;
  uint64_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  Encoding encoding = Encoding::ascii;
  std::vector<Element> elements;
  size_t bytes = 0;  ///< up to and with the line end after end_header
  int lines = 0;
};

/// Error(bad_input) with `WHERE: line N`. A line of no keyword is a fault that may be passed over.
Header header_of(std::span<const uint8_t> file, std::string_view where, Faults& faults);

}  // namespace trueshade::ply
