#pragma once
#include <cstdint>
#include <deque>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/image_files/image_io.h"
#include "scenes/mesh.h"

namespace trueshade {

/// A float as JSON, in the fewest digits that give it back; -0 keeps its sign, and what is not finite is a string.
std::string json_of_float(float value);
std::string json_of_floats(std::span<const float> values);  ///< as an array

/// The arrays of a document: numbers in it, or bytes in a file beside it of which the document names the places.
/// Arrays in the file are borrowed until it is written, so that a scene of millions of triangles is not copied.
class ResolvedArrays {
 public:
  enum class Place : uint8_t { document, file };
  explicit ResolvedArrays(Place place) : place_(place) {}

  // Each returns the JSON of an array: nested lists, or {"type": ..., "shape": [...], "offset": ...}, offset in bytes.
  std::string streams(std::span<const FloatStream> streams);  ///< [streams, size of each]; of one size
  std::string triangles(std::span<const uint32_t> indices);  ///< [n, 3]
  std::string points(std::vector<glm::vec3> points);         ///< [n, 3]; kept here
  /// Texels of one level, [height, width, 4]: uint8, uint16 (the bits of a half) or float32.
  std::string texels(std::span<const uint8_t> bytes, int width, int height, int bytes_a_channel);

  const FilePieces& pieces() const { return pieces_; }
  uint64_t bytes() const { return bytes_; }

 private:
  std::string in_file(std::string_view type, std::span<const size_t> shape);
  void add_piece(std::span<const uint8_t> bytes);

  Place place_;
  FilePieces pieces_;
  uint64_t bytes_ = 0;
  std::deque<std::vector<glm::vec3>> kept_;
};

}  // namespace trueshade
