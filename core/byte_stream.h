#pragma once
// Values as bytes for another process, one behind the other. Both processes have one byte order.
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace trueshade {

class ByteWriter {
 public:
  template <class Number>
  void number(Number value) {
    static_assert(std::is_arithmetic_v<Number>);
    append(&value, sizeof value);
  }
  /// Their count, then they.
  void run(std::span<const uint8_t> bytes) {
    number(uint64_t(bytes.size()));
    append(bytes.data(), bytes.size());
  }
  /// The same of pieces that are one run.
  void run(std::span<const std::vector<uint8_t>> pieces) {
    uint64_t bytes = 0;
    for (const std::vector<uint8_t>& piece : pieces) bytes += piece.size();
    number(bytes);
    for (const std::vector<uint8_t>& piece : pieces) append(piece.data(), piece.size());
  }
  void text(std::string_view text) { run({reinterpret_cast<const uint8_t*>(text.data()), text.size()}); }

  void reserve(size_t bytes) { bytes_.reserve(bytes); }
  const std::vector<uint8_t>& bytes() const { return bytes_; }
  std::vector<uint8_t> take() { return std::move(bytes_); }

 private:
  void append(const void* first, size_t bytes) {
    const auto* const from = static_cast<const uint8_t*>(first);
    bytes_.insert(bytes_.end(), from, from + bytes);
  }
  std::vector<uint8_t> bytes_;
};

/// What is thrown for bytes that are not what a writer has made.
struct BadBytes {};

/// Takes values in the order that a ByteWriter got them in. Each function throws BadBytes where the bytes end early,
/// and never reads or allocates more than there is. Borrows the bytes.
class ByteReader {
 public:
  explicit ByteReader(std::span<const uint8_t> bytes) : rest_(bytes) {}

  template <class Number>
  Number number() {
    static_assert(std::is_arithmetic_v<Number> && !std::is_same_v<Number, bool>);
    Number value{};
    std::memcpy(&value, next(sizeof value).data(), sizeof value);
    return value;
  }
  /// A number that is an enumerator, of which `last` is the last.
  template <class Enumeration>
  Enumeration enumerator(Enumeration last) {
    const auto value = number<std::underlying_type_t<Enumeration>>();
    if (value < 0 || value > std::underlying_type_t<Enumeration>(last)) throw BadBytes();
    return Enumeration(value);
  }
  /// A uint64_t: how many values follow, each of which takes `least` bytes or more.
  size_t count(size_t least) {
    const auto count = number<uint64_t>();
    if (count > rest_.size() / least) throw BadBytes();
    return size_t(count);
  }
  std::span<const uint8_t> run() { return next(number<uint64_t>()); }
  std::string text() {
    const std::span<const uint8_t> bytes = run();
    return {bytes.begin(), bytes.end()};
  }

  bool at_end() const { return rest_.empty(); }
  /// Throws BadBytes where bytes are left.
  void end() const {
    if (!at_end()) throw BadBytes();
  }

 private:
  std::span<const uint8_t> next(uint64_t bytes) {
    if (bytes > rest_.size()) throw BadBytes();
    const std::span<const uint8_t> taken = rest_.first(size_t(bytes));
    rest_ = rest_.subspan(size_t(bytes));
    return taken;
  }
  std::span<const uint8_t> rest_;
};

}  // namespace trueshade
