#pragma once
#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace trueshade {

/// An array that owns its elements, in a std::vector, or shows elements that lie elsewhere: in a file that is mapped.
/// Copies of such an array show the same elements. An array that is written owns its elements from then on. What reads
/// an array is the same for both.
template <class T, class Vector = std::vector<T>>
class Array {
 public:
  using value_type = T;
  using iterator = T*;
  using const_iterator = const T*;

  Array() = default;
  Array(Vector elements) : own_(std::move(elements)), seen_(own_) {}  // NOLINT: a vector is an array
  Array(std::initializer_list<T> elements) : own_(elements), seen_(own_) {}
  /// Shows `elements`, which are there as long as `keeper` is. `keeper` is not null.
  Array(std::span<const T> elements, std::shared_ptr<const void> keeper)
      : seen_(elements), keeper_(std::move(keeper)) {}
  Array(const Array& other) : own_(other.own_), seen_(other.owned() ? own_ : other.seen_), keeper_(other.keeper_) {}
  Array(Array&& other) noexcept
      : own_(std::move(other.own_)), seen_(std::exchange(other.seen_, {})), keeper_(std::move(other.keeper_)) {}
  Array& operator=(Array other) noexcept {
    own_.swap(other.own_), std::swap(seen_, other.seen_), keeper_.swap(other.keeper_);
    return *this;
  }
  ~Array() = default;

  bool owned() const { return keeper_ == nullptr; }
  size_t size() const { return seen_.size(); }
  bool empty() const { return seen_.empty(); }
  const T* data() const { return seen_.data(); }
  const T& operator[](size_t i) const { return seen_[i]; }
  const T* begin() const { return seen_.data(); }
  const T* end() const { return seen_.data() + seen_.size(); }
  const T& front() const { return seen_.front(); }
  const T& back() const { return seen_.back(); }

  // As std::vector has them.
  T* data() { return vector().data(); }
  T& operator[](size_t i) { return vector()[i]; }
  T* begin() { return vector().data(); }
  T* end() { return begin() + own_.size(); }
  T& front() { return vector().front(); }
  T& back() { return vector().back(); }
  size_t capacity() const { return own_.capacity(); }
  void reserve(size_t count) { vector().reserve(count), see(); }
  void resize(size_t count, const T& value = {}) { vector().resize(count, value), see(); }
  void assign(size_t count, const T& value) { vector().assign(count, value), see(); }
  template <class Iterator>
  requires(!std::is_integral_v<Iterator>) void assign(Iterator first, Iterator last) {
    vector().assign(first, last), see();
  }
  void push_back(const T& value) { vector().push_back(value), see(); }
  void pop_back() { vector().pop_back(), see(); }
  void clear() { *this = Array(); }
  template <class... From>  // as vector::insert() behind `place`
  void insert(const T* place, From... from) {
    const auto at = place - seen_.data();
    Vector& elements = vector();
    elements.insert(elements.begin() + at, from...), see();
  }
  void insert(const T* place, std::initializer_list<T> values) { insert(place, values.begin(), values.end()); }

  friend bool operator==(const Array& a, const Array& b) { return std::ranges::equal(a.seen_, b.seen_); }

 private:
  Vector& vector() {
    if (!owned()) *this = Array(Vector(seen_.begin(), seen_.end()));
    return own_;
  }
  void see() { seen_ = own_; }

  Vector own_;  ///< empty where elements are shown
  std::span<const T> seen_;
  std::shared_ptr<const void> keeper_;  ///< null where elements are owned
};

}  // namespace trueshade
