#pragma once
#include <glm/mat4x3.hpp>
#include <string>
#include <vector>

#include "scenes/files/gltf/buffers.h"

namespace trueshade::gltf {

/// Values of a document's accessors: sparse ones completed, normalized ones divided. What is read is counted against
/// limits.geometry_bytes before memory for it is taken. Zeros that stand for no data are held to limits.expansion.
class Accessors {
 public:
  Accessors(Buffers& buffers, const SceneLimits& limits);

  /// One component of every element. Floats as they are; integers converted, normalized ones c / (2^n - 1), or
  /// max(c / (2^(n-1) - 1), -1) where signed, rounded once. Error(bad_input) for numbers that are not finite or over
  /// 1e18, and for sparse indices that do not ascend or lie beyond the elements.
  std::vector<float> floats(uint32_t accessor, uint32_t component);
  std::vector<double> doubles(uint32_t accessor, uint32_t component);

  /// One component of unsigned integers.
  std::vector<uint32_t> integers(uint32_t accessor, uint32_t component);

  /// Every matrix of MAT4, whose last row is 0, 0, 0, 1.
  std::vector<glm::dmat4x3> matrices(uint32_t accessor);

  const Accessor& at(uint32_t accessor) const { return document_.accessors[accessor]; }
  const Document& document() const { return document_; }

  /// Error(limit) where `bytes` more would be over the limit.
  void take(uint64_t bytes, const std::string& pointer);

  /// Adds up what reading so many components will take, before any is read. Error(limit) as reading them gives.
  void plan(uint32_t accessor, uint32_t components);

 private:
  template <typename Out>
  std::vector<Out> read(uint32_t accessor, uint32_t component);
  template <typename Out>
  void read_sparse(uint32_t accessor, uint32_t component, std::vector<Out>& out);
  void check_left(uint64_t bytes, uint64_t left, const std::string& pointer) const;
  void take_zeros(uint64_t bytes, uint32_t accessor);

  Buffers& buffers_;
  const Document& document_;
  uint64_t left_, limit_;
  uint64_t left_of_plan_;
  uint64_t expansion_;         ///< limits.expansion
  uint64_t buffer_bytes_ = 0;  ///< of all buffers that have data
  uint64_t zeros_ = 0;         ///< bytes that were read of accessors without a view
};

}  // namespace trueshade::gltf
