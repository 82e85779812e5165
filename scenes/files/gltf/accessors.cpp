#include "scenes/files/gltf/accessors.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/error.h"
#include "core/memory_cap.h"
#include "scenes/scene_limits.h"

namespace trueshade::gltf {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr double kMostValue = 1e18;

template <typename In>
In loaded(const uint8_t* from) {
  In value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

template <typename Out, typename In>
Out converted(In value, bool normalized) {
  if constexpr (std::is_integral_v<Out>) {
    return Out(value);
  } else if constexpr (std::is_floating_point_v<In>) {
    return Out(value);
  } else {
    if (!normalized) return Out(value);
    const double quotient = double(value) / double(std::numeric_limits<In>::max());
    return Out(quotient < -1.0 ? -1.0 : quotient);
  }
}

template <typename Out, typename In>
void copy_as(std::span<const uint8_t> bytes, size_t offset, size_t stride, bool normalized, std::vector<Out>& out) {
  const uint8_t* from = bytes.data() + offset;
  for (size_t i = 0; i < out.size(); ++i) out[i] = converted<Out>(loaded<In>(from + i * stride), normalized);
}

/// Fills `out` with the components `stride` bytes apart from `offset` on.
template <typename Out>
void copy(Component type, std::span<const uint8_t> bytes, size_t offset, size_t stride, bool normalized,
          std::vector<Out>& out) {
  switch (type) {
    case Component::int8:
      return copy_as<Out, int8_t>(bytes, offset, stride, normalized, out);
    case Component::uint8:
      return copy_as<Out, uint8_t>(bytes, offset, stride, normalized, out);
    case Component::int16:
      return copy_as<Out, int16_t>(bytes, offset, stride, normalized, out);
    case Component::uint16:
      return copy_as<Out, uint16_t>(bytes, offset, stride, normalized, out);
    case Component::uint32:
      return copy_as<Out, uint32_t>(bytes, offset, stride, normalized, out);
    case Component::float32:
      return copy_as<Out, float>(bytes, offset, stride, normalized, out);
  }
}

/// Bytes from the start of an element to a component of it; columns of matrices start on multiples of 4.
size_t component_offset(const Accessor& a, uint32_t component) {
  const uint32_t size = bytes_of(a.type);
  if (a.shape < Shape::mat2) return component * size;
  const uint32_t rows = rows_of(a.shape);
  return component / rows * ((rows * size + 3) / 4 * 4) + component % rows * size;
}

}  // namespace

Accessors::Accessors(Buffers& buffers, const SceneLimits& limits)
    : buffers_(buffers),
      document_(buffers.document()),
      left_(limits.geometry_bytes),
      limit_(limits.geometry_bytes),
      left_of_plan_(limits.geometry_bytes),
      expansion_(limits.expansion) {
  for (const Buffer& buffer : document_.buffers)
    if (!buffer.fallback) buffer_bytes_ += buffer.bytes;
}

void Accessors::check_left(uint64_t bytes, uint64_t left, const std::string& pointer) const {
  if (bytes > left)
    throw Error(ErrorKind::limit, document_.file + ": " + pointer,
                "with these " + std::to_string(bytes) + " bytes the geometry is over the limit",
                within_limit(limit_, "bytes in all", "--max-geometry-memory"));
}

void Accessors::take(uint64_t bytes, const std::string& pointer) {
  check_left(bytes, left_, pointer);
  left_ -= bytes;
  require_memory(bytes, document_.file + ": " + pointer, "the geometry");
}

void Accessors::plan(uint32_t accessor, uint32_t components) {
  for (uint32_t k = 0; k < components; ++k) {
    const uint64_t bytes = at(accessor).count * sizeof(float);
    check_left(bytes, left_of_plan_, pointer_to("accessors", accessor));
    left_of_plan_ -= bytes;
  }
}

/// A count of zeros takes a few bytes of the file, whatever it is.
void Accessors::take_zeros(uint64_t bytes, uint32_t accessor) {
  zeros_ += bytes;
  if (is_expanded(zeros_, buffer_bytes_, expansion_))
    throw Error(ErrorKind::limit, document_.file + ": " + pointer_to("accessors", accessor),
                "with it the accessors without a buffer view are " + std::to_string(zeros_) +
                    " bytes and all buffers " + std::to_string(buffer_bytes_),
                within_limit(expansion_, "times as many", "--max-expansion"));
}

template <typename Out>
std::vector<Out> Accessors::read(uint32_t accessor, uint32_t component) {
  const Accessor& a = document_.accessors[accessor];
  if (a.shape == Shape::unknown)
    document_.fail(pointer_to("accessors", accessor, "type"), "this type is not in glTF", "SCALAR, VEC2 to MAT4");
  take(a.count * sizeof(Out), pointer_to("accessors", accessor));
  if (a.view == kNone) take_zeros(a.count * sizeof(Out), accessor);
  std::vector<Out> out(size_t(a.count), Out(0));
  if (a.view != kNone) {
    const uint32_t stride = document_.views[a.view].stride;
    copy(a.type, buffers_.view(a.view), size_t(a.offset) + component_offset(a, component),
         stride != 0 ? stride : size_t(element_bytes(a.type, a.shape)), a.normalized, out);
  }
  if (a.sparse) read_sparse(accessor, component, out);
  if constexpr (std::is_floating_point_v<Out>) {
    for (size_t i = 0; i < out.size(); ++i)
      if (!(std::fabs(double(out[i])) <= kMostValue))
        document_.fail(pointer_to("accessors", accessor),
                       "element " + std::to_string(i) + " is not finite or over 1e18", "finite numbers");
  }
  return out;
}

template <typename Out>
void Accessors::read_sparse(uint32_t accessor, uint32_t component, std::vector<Out>& out) {
  const Accessor& a = document_.accessors[accessor];
  const Sparse& sparse = *a.sparse;
  std::vector<uint32_t> indices(size_t(sparse.count));
  std::vector<Out> values(size_t(sparse.count));
  const size_t size = bytes_of(sparse.index_type);
  copy(sparse.index_type, buffers_.view(sparse.indices_view), size_t(sparse.indices_offset), size, false, indices);
  copy(a.type, buffers_.view(sparse.values_view), size_t(sparse.values_offset) + component_offset(a, component),
       size_t(element_bytes(a.type, a.shape)), a.normalized, values);
  for (size_t i = 0; i < indices.size(); ++i) {
    if (indices[i] >= out.size() || (i > 0 && indices[i] <= indices[i - 1]))
      document_.fail(pointer_to("accessors", accessor, "sparse", "indices"),
                     "index " + std::to_string(indices[i]) + " is beyond the elements or not above the one before it",
                     "ascending indices below " + std::to_string(out.size()));
    out[indices[i]] = values[i];
  }
}

std::vector<float> Accessors::floats(uint32_t accessor, uint32_t component) { return read<float>(accessor, component); }
std::vector<double> Accessors::doubles(uint32_t accessor, uint32_t component) {
  return read<double>(accessor, component);
}
std::vector<uint32_t> Accessors::integers(uint32_t accessor, uint32_t component) {
  return read<uint32_t>(accessor, component);
}

std::vector<glm::dmat4x3> Accessors::matrices(uint32_t accessor) {
  constexpr double kRowError = 1e-6;
  take(std::min(at(accessor).count, limit_) * sizeof(glm::dmat4x3), pointer_to("accessors", accessor));
  std::vector<glm::dmat4x3> out(size_t(at(accessor).count), glm::dmat4x3(0.0));
  const bool has_data = at(accessor).view != kNone || at(accessor).sparse.has_value();  // without, all is 0
  for (uint32_t component = 0; component < 16; ++component) {
    const std::vector<double> values = doubles(accessor, component);
    const int column = int(component / 4), row = int(component % 4);
    for (size_t i = 0; i < out.size(); ++i) {
      if (row < 3)
        out[i][column][row] = values[i];
      else if (has_data && !(std::fabs(values[i] - (column == 3 ? 1.0 : 0.0)) <= kRowError))
        document_.fail(pointer_to("accessors", accessor),
                       "matrix " + std::to_string(i) + " does more than move, turn, scale and shear",
                       "a last row of 0, 0, 0, 1");
    }
  }
  return out;
}

}  // namespace trueshade::gltf
