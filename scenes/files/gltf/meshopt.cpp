#include "scenes/files/gltf/meshopt.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/error.h"

// Streams are decoded by the library; filters are ours, in f64, because the library's depend on the processor.
namespace trueshade::gltf {
namespace {

static_assert(std::endian::native == std::endian::little);

template <typename T>
T value_at(const uint8_t* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

/// Rounds to the nearest; values beyond the type, which only broken data give, become the type's least or largest.
template <typename T>
void put(double value, uint8_t* to) {
  const double least = double(std::numeric_limits<T>::min()), most = double(std::numeric_limits<T>::max());
  const T rounded = T(std::clamp(value >= 0.0 ? value + 0.5 : value - 0.5, least, most));
  std::memcpy(to, &rounded, sizeof rounded);
}

/// Octahedral directions: x and y with z's scale beside them become x, y, z; the fourth component stays.
template <typename T>
void unfold_octahedral(uint8_t* element) {
  const double most = double(std::numeric_limits<T>::max());
  double x = double(value_at<T>(element)), y = double(value_at<T>(element + sizeof(T)));
  const double one = double(value_at<T>(element + 2 * sizeof(T)));
  const double z = (one - std::fabs(x)) - std::fabs(y), fold = std::max(-z, 0.0);
  x += x >= 0.0 ? -fold : fold;
  y += y >= 0.0 ? -fold : fold;
  const double length = std::sqrt((x * x + y * y) + z * z), scale = length > 0.0 ? most / length : 0.0;
  put<T>(x * scale, element);
  put<T>(y * scale, element + sizeof(T));
  put<T>(z * scale, element + 2 * sizeof(T));
}

/// Quaternions without their largest component, whose place stands in the low bits of the fourth.
void unfold_quaternion(uint8_t* element) {
  int16_t in[4];
  std::memcpy(in, element, sizeof in);
  const double scale = 1.0 / (std::sqrt(2.0) * double(in[3] | 3));
  double c[4] = {double(in[0]) * scale, double(in[1]) * scale, double(in[2]) * scale, 0.0};
  c[3] = std::sqrt(std::max(0.0, ((1.0 - c[0] * c[0]) - c[1] * c[1]) - c[2] * c[2]));
  const int largest = in[3] & 3;
  for (int k = 0; k < 4; ++k) put<int16_t>(c[k] * 32767.0, element + 2 * ((largest + 1 + k) % 4));
}

/// 24 bits of a mantissa under 8 of an exponent.
void unfold_exponential(uint8_t* element, uint32_t stride) {
  for (uint32_t k = 0; k < stride; k += 4) {
    const int32_t bits = value_at<int32_t>(element + k);
    const int32_t mantissa = int32_t(uint32_t(bits) << 8) >> 8;
    const float value = float(std::ldexp(double(mantissa), bits >> 24));
    std::memcpy(element + k, &value, sizeof value);
  }
}

void unfilter(const Packing& packing, Bytes& bytes) {
  using Filter = Packing::Filter;
  if (packing.filter == Filter::none) return;
  for (size_t at = 0; at < bytes.size(); at += packing.stride) {
    uint8_t* element = bytes.data() + at;
    if (packing.filter == Filter::octahedral && packing.stride == 4) unfold_octahedral<int8_t>(element);
    if (packing.filter == Filter::octahedral && packing.stride == 8) unfold_octahedral<int16_t>(element);
    if (packing.filter == Filter::quaternion) unfold_quaternion(element);
    if (packing.filter == Filter::exponential) unfold_exponential(element, packing.stride);
  }
}

int decode(const Packing& packing, std::span<const uint8_t> packed, Bytes& out) {
  const size_t count = size_t(packing.count), stride = packing.stride;
  switch (packing.mode) {
    case Packing::Mode::attributes:
      return meshopt_decodeVertexBuffer(out.data(), count, stride, packed.data(), packed.size());
    case Packing::Mode::triangles:
      return meshopt_decodeIndexBuffer(out.data(), count, stride, packed.data(), packed.size());
    case Packing::Mode::indices:
      return meshopt_decodeIndexSequence(out.data(), count, stride, packed.data(), packed.size());
  }
  return -1;  // unreachable
}

/// A byte of a stream stands for few elements: of vertices a block of 256 for at least one byte each stride, of
/// triangles one for at least a byte. A count that no stream of this length holds is refused before memory is taken.
bool could_hold(const Packing& packing, size_t packed_bytes) {
  const uint64_t bytes = packed_bytes;
  if (packing.mode == Packing::Mode::attributes) return packing.count / 256 * packing.stride / 4 <= bytes;
  return packing.count / 3 <= bytes;
}

}  // namespace

Bytes unpacked_by_meshopt(const Packing& packing, std::span<const uint8_t> packed, const std::string& where) {
  const auto refuse = [&](const char* reason) {
    throw Error(ErrorKind::bad_input, where, reason, "pack the data again");
  };
  if (!could_hold(packing, packed.size())) refuse("the packed data are too short for the count");
  Bytes out(size_t(packing.count * packing.stride));
  if (decode(packing, packed, out) != 0) refuse("the packed data are broken");
  unfilter(packing, out);
  return out;
}

}  // namespace trueshade::gltf
