#pragma once
#include <cstring>
#include <exception>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "scenes/scene.h"

namespace trueshade {

/// Bytes of a result, gathered without arithmetic: a row runs under modes that would change or trap it.
class Bytes {
 public:
  template <typename T>
  void put(const T& value) requires std::is_trivially_copyable_v<T> {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void put(const std::string& text) { bytes_ += text + '\n'; }
  void put(std::string_view text) { put(std::string(text)); }
  void put(const char* text) { put(std::string(text)); }
  template <typename T>
  void put(const std::vector<T>& values) {
    for (const T& value : values) put(value);
  }
  template <typename T>
  void put(const Array<T>& values) {
    for (const T& value : values) put(value);
  }
  void put(const Image& image) { put(image.texels); }
  void put(const Scene& scene);
  void put_light(const Light& light);  ///< field by field: between them lie bytes without a meaning

  /// Puts the text of the exception that `body` throws, and fails the comparison if it throws none.
  template <typename Body>
  void put_error(const Body& body) {
    try {
      body();
      put("nothing was thrown");
    } catch (const std::exception& error) {
      put(error.what());
    }
  }
  const std::string& all() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Functions of one installed header, and calls of them whose results are put.
struct Row {
  std::string_view header;
  std::string_view functions;  ///< names, a space between
  void (*call)(Bytes& out);
};

std::span<const Row> rows_of_values();  ///< core/ and the inline functions of scenes/
std::span<const Row> rows_of_scenes();
std::span<const Row> rows_of_frames();  ///< shading/ and core/image_files/

/// A scene with all that moves, a texture, and denormal numbers. Made once, under the default mode.
const Scene& scene_of_all();

/// The path of a file in a folder for this run.
std::string scratch_path(std::string_view name);

}  // namespace trueshade
