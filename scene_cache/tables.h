#pragma once
#include <array>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "core/array.h"
#include "scene_cache/checked_file.h"

// Values as the bytes of tables, in the order in which they are handed over. What has no pointers is stored as it lies
// in memory; strings, vectors and structs that hold such are stored member by member (scene_values.h). The elements of
// an Array are not in the tables: the tables have the place in the file.
namespace trueshade {

template <class T>
struct IsArray : std::false_type {};
template <class T, class Vector>
struct IsArray<Array<T, Vector>> : std::true_type {};
template <class T>
struct IsVector : std::false_type {};
template <class T>
struct IsVector<std::vector<T>> : std::true_type {};
template <class T>
struct IsOptional : std::false_type {};
template <class T>
struct IsOptional<std::optional<T>> : std::true_type {};
template <class T>
struct IsStdArray : std::false_type {};
template <class T, size_t N>
struct IsStdArray<std::array<T, N>> : std::true_type {};

/// Puts values into tables, and the elements of arrays into the file. Error(io).
class TableWriter {
 public:
  explicit TableWriter(CheckedFileWriter& file) : file_(file) {}

  template <class T>
  void operator()(const T& value) {
    if constexpr (std::is_trivially_copyable_v<T> && !IsStdArray<T>::value) {
      put(&value, sizeof value);
    } else if constexpr (IsArray<T>::value) {
      const uint64_t bytes = value.size() * sizeof(typename T::value_type);
      (*this)(file_.add({reinterpret_cast<const uint8_t*>(value.data()), size_t(bytes)}));
      (*this)(uint64_t(value.size()));
    } else if constexpr (IsVector<T>::value || std::is_same_v<T, std::string>) {
      using Element = typename T::value_type;
      (*this)(uint64_t(value.size()));
      if constexpr (std::is_trivially_copyable_v<Element>)
        put(value.data(), value.size() * sizeof(Element));
      else
        for (const Element& element : value) (*this)(element);
    } else if constexpr (IsOptional<T>::value) {
      (*this)(value.has_value());
      if (value) (*this)(*value);
    } else if constexpr (IsStdArray<T>::value) {
      for (const auto& element : value) (*this)(element);
    } else {
      each_member(*this, value);
    }
  }

  std::span<const uint8_t> bytes() const { return bytes_; }

 private:
  void put(const void* first, size_t bytes) {
    const auto* const from = static_cast<const uint8_t*>(first);
    bytes_.insert(bytes_.end(), from, from + bytes);
  }

  CheckedFileWriter& file_;
  std::vector<uint8_t> bytes_;
};

/// What is thrown where tables are not what TableWriter made.
struct BadTables {};

/// Takes values from the tables of a file. Arrays show what is in the file. Throws BadTables where the tables end early
/// or name a place that the file does not have.
class TableReader {
 public:
  explicit TableReader(std::shared_ptr<const CheckedFile> file) : file_(std::move(file)), left_(file_->tables()) {}

  template <class T>
  void operator()(T& value) {
    if constexpr (std::is_trivially_copyable_v<T> && !IsStdArray<T>::value) {
      take(&value, sizeof value);
    } else if constexpr (IsArray<T>::value) {
      using Element = typename T::value_type;
      const auto offset = taken<uint64_t>(), count = taken<uint64_t>();
      const auto bytes = file_->bytes_at(offset, count * sizeof(Element));
      if (!bytes || count > SIZE_MAX / sizeof(Element) || offset % alignof(Element) != 0) throw BadTables();
      if (count > 0) value = T(std::span(reinterpret_cast<const Element*>(bytes->data()), size_t(count)), file_);
    } else if constexpr (IsVector<T>::value || std::is_same_v<T, std::string>) {
      using Element = typename T::value_type;
      const auto count = taken<uint64_t>();
      constexpr size_t kLeast = std::is_trivially_copyable_v<Element> ? sizeof(Element) : 1;
      if (count > left_.size() / kLeast) throw BadTables();
      value.resize(size_t(count));
      if constexpr (std::is_trivially_copyable_v<Element>)
        take(value.data(), value.size() * sizeof(Element));
      else
        for (Element& element : value) (*this)(element);
    } else if constexpr (IsOptional<T>::value) {
      if (taken<bool>()) (*this)(value.emplace());
    } else if constexpr (IsStdArray<T>::value) {
      for (auto& element : value) (*this)(element);
    } else {
      each_member(*this, value);
    }
  }

  template <class T>
  T taken() {
    T value{};
    (*this)(value);
    return value;
  }

 private:
  void take(void* to, size_t bytes) {
    if (bytes > left_.size()) throw BadTables();
    if (bytes > 0) std::memcpy(to, left_.data(), bytes);
    left_ = left_.subspan(bytes);
  }

  std::shared_ptr<const CheckedFile> file_;
  std::span<const uint8_t> left_;
};

}  // namespace trueshade
