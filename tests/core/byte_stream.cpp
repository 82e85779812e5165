#include "core/byte_stream.h"

#include <limits>

#include "tests/catch.hpp"

using namespace trueshade;

namespace {

enum class Fruit : uint8_t { apple, pear, plum };

struct Values {
  int32_t number = 0;
  double real = 0.0;
  Fruit fruit = Fruit::apple;
  std::string text;
  std::vector<uint8_t> run;
  std::vector<uint16_t> list;
};
const Values kValues{-7, 0.5, Fruit::plum, std::string("a\0b", 3), {1, 2, 3}, {5, 6, 7}};

std::vector<uint8_t> written() {
  ByteWriter out;
  out.number(kValues.number);
  out.number(kValues.real);
  out.number(uint8_t(kValues.fruit));
  out.text(kValues.text);
  out.run(kValues.run);
  out.number(uint64_t(kValues.list.size()));
  for (const uint16_t element : kValues.list) out.number(element);
  return out.take();
}

Values read(std::span<const uint8_t> bytes) {
  ByteReader in(bytes);
  Values values;
  values.number = in.number<int32_t>();
  values.real = in.number<double>();
  values.fruit = in.enumerator(Fruit::plum);
  values.text = in.text();
  const std::span<const uint8_t> run = in.run();
  values.run.assign(run.begin(), run.end());
  values.list.resize(in.count(sizeof(uint16_t)));
  for (uint16_t& element : values.list) element = in.number<uint16_t>();
  in.end();
  return values;
}

template <class... Numbers>
std::vector<uint8_t> bytes_of(Numbers... numbers) {
  ByteWriter out;
  (out.number(numbers), ...);
  return out.take();
}

}  // namespace

TEST_CASE("Values come out of their bytes as they were") {
  const Values values = read(written());
  CHECK(values.number == kValues.number);
  CHECK(values.real == kValues.real);
  CHECK(values.fruit == kValues.fruit);
  CHECK(values.text == kValues.text);
  CHECK(values.run == kValues.run);
  CHECK(values.list == kValues.list);
  CHECK(ByteReader({}).at_end());
}

TEST_CASE("Pieces are one run") {
  ByteWriter pieces, whole;
  pieces.run(std::vector<std::vector<uint8_t>>{{1, 2}, {}, {3}});
  whole.run(std::vector<uint8_t>{1, 2, 3});
  CHECK(pieces.bytes() == whole.bytes());
}

TEST_CASE("Bytes that end early, or go on, are refused") {
  std::vector<uint8_t> bytes = written();
  for (size_t size = 0; size < bytes.size(); ++size) {
    INFO(size << " of " << bytes.size() << " bytes");
    CHECK_THROWS_AS(read(std::span(bytes).first(size)), BadBytes);
  }
  bytes.push_back(0);
  CHECK_THROWS_AS(read(bytes), BadBytes);
  CHECK_THROWS_AS(ByteReader({}).number<uint8_t>(), BadBytes);
  CHECK_THROWS_AS(ByteReader({}).run(), BadBytes);
}

TEST_CASE("Counts that the bytes cannot hold are refused before anything is allocated") {
  constexpr uint64_t kMost = std::numeric_limits<uint64_t>::max();
  for (const uint64_t count : {uint64_t(3), uint64_t(1) << 32, uint64_t(1) << 62, kMost - 7, kMost}) {
    INFO(count);
    const std::vector<uint8_t> bytes = bytes_of(count, uint8_t(1), uint8_t(2));
    CHECK_THROWS_AS(ByteReader(bytes).run(), BadBytes);
    CHECK_THROWS_AS(ByteReader(bytes).text(), BadBytes);
    CHECK_THROWS_AS(ByteReader(bytes).count(1), BadBytes);
    CHECK_THROWS_AS(ByteReader(bytes).count(8), BadBytes);
  }
  const std::vector<uint8_t> bytes = bytes_of(uint64_t(2), uint16_t(1), uint16_t(2));
  CHECK(ByteReader(bytes).count(2) == 2);
  CHECK_THROWS_AS(ByteReader(bytes).count(3), BadBytes);
}

TEST_CASE("A number that is no enumerator is refused") {
  for (int value = 0; value < 256; ++value) {
    const std::vector<uint8_t> bytes = bytes_of(uint8_t(value));
    if (value <= int(Fruit::plum))
      CHECK(ByteReader(bytes).enumerator(Fruit::plum) == Fruit(value));
    else
      CHECK_THROWS_AS(ByteReader(bytes).enumerator(Fruit::plum), BadBytes);
  }
}
