#include "scenes/files/gltf/reading.h"

// Buffers, views of them, and accessors of these.
namespace trueshade::gltf {
namespace {

constexpr std::string_view kShapes[] = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};

Component component_of(const json::Node& node) {
  constexpr int64_t kFirst = 5120, kLast = 5126, kInt32 = 5124;
  const int64_t type = node.integer(kFirst, kLast);
  if (type == kInt32) node.fail("component type 5124 (INT) is not in glTF", "5120 to 5123, 5125 or 5126");
  return Component(type < kInt32 ? type - kFirst : type - kFirst - 1);
}

Buffer read_buffer(const json::Node& node) {
  Buffer buffer;
  buffer.bytes = uint64_t(node.member("byteLength").integer(1, kLargestCount));
  if (const auto uri = node.find("uri")) buffer.uri = uri->string();
  const auto extensions = extensions_of(node);
  const auto packed = extensions ? extensions->find("EXT_meshopt_compression") : std::nullopt;
  if (packed) buffer.fallback = boolean_or(*packed, "fallback", false);
  return buffer;
}

void check_inside(const json::Node& node, uint64_t offset, uint64_t bytes, uint32_t buffer, const Document& document) {
  const uint64_t all = document.buffers[buffer].bytes;
  if (offset > all || bytes > all - offset)
    node.fail("the bytes from " + std::to_string(offset) + " to " + std::to_string(offset + bytes) +
                  " do not fit into buffer " + std::to_string(buffer) + " of " + std::to_string(all),
              "an offset and a length inside the buffer");
}

Packing read_packing(const json::Node& node, uint64_t view_bytes, const Counts& counts, const Document& document) {
  constexpr std::string_view kModes[] = {"ATTRIBUTES", "TRIANGLES", "INDICES"};
  constexpr std::string_view kFilters[] = {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"};
  using Mode = Packing::Mode;
  using Filter = Packing::Filter;
  Packing p;
  p.buffer = index(node.member("buffer"), counts.buffers, "buffer");
  p.offset = whole_or(node, "byteOffset", 0);
  p.bytes = uint64_t(node.member("byteLength").integer(1, kLargestCount));
  check_inside(node, p.offset, p.bytes, p.buffer, document);
  p.stride = uint32_t(node.member("byteStride").integer(1, 256));
  p.count = uint64_t(node.member("count").integer(1, kLargestCount / 256));
  p.mode = Mode(node.member("mode").choice(kModes));
  if (const auto filter = node.find("filter")) p.filter = Filter(filter->choice(kFilters));
  const bool attributes = p.mode == Mode::attributes;
  if (attributes ? p.stride % 4 != 0 : p.stride != 2 && p.stride != 4)
    node.fail("a stride of " + std::to_string(p.stride) + " does not go with the mode",
              "a multiple of 4 for ATTRIBUTES, 2 or 4 for the others");
  if (p.mode == Mode::triangles && p.count % 3 != 0)
    node.fail("the count of a list of triangles is no multiple of 3", "3 indices a triangle");
  const bool fits = p.filter == Filter::none || (attributes && p.filter == Filter::exponential) ||
                    (attributes && p.filter == Filter::octahedral && (p.stride == 4 || p.stride == 8)) ||
                    (attributes && p.filter == Filter::quaternion && p.stride == 8);
  if (!fits) node.fail("the filter does not go with mode and stride", "filters as EXT_meshopt_compression lists them");
  if (p.count * p.stride != view_bytes)
    node.fail("count times byteStride is not the view's byteLength", "a view of " + std::to_string(p.count * p.stride));
  return p;
}

/// 0: the view has none.
uint32_t read_stride(const json::Node& stride, bool is_of_indices, uint64_t view_bytes, Document& document) {
  constexpr int64_t kLeast = 4, kMost = 252;
  const auto fault = [&](const std::string& reason, const char* remedy) {
    document.pass(Fault::stride, stride.pointer(), reason, remedy);
  };
  const int64_t bytes = stride.integer(0, UINT32_MAX);
  if (bytes < kLeast || bytes > kMost) fault("the stride is " + std::to_string(bytes), "a stride from 4 to 252");
  if (bytes % 4 != 0) fault("the stride is no multiple of 4", "a multiple of 4");
  if (is_of_indices) fault("a view of indices has a stride", "remove it");
  if (uint64_t(bytes) > view_bytes) fault("the stride is over the view's byteLength", "a longer view");
  return uint32_t(bytes);
}

BufferView read_view(const json::Node& node, const Counts& counts, Document& document) {
  constexpr int64_t kVertices = 34962, kIndices = 34963;
  BufferView view;
  view.buffer = index(node.member("buffer"), counts.buffers, "buffer");
  view.offset = whole_or(node, "byteOffset", 0);
  view.bytes = uint64_t(node.member("byteLength").integer(1, kLargestCount));
  check_inside(node, view.offset, view.bytes, view.buffer, document);
  const auto target = node.find("target");
  const int64_t aim = target ? target->integer(0, kLargestCount) : 0;
  if (target && aim != kVertices && aim != kIndices) target->fail("found " + std::to_string(aim), "34962 or 34963");
  if (const auto stride = node.find("byteStride"))
    view.stride = read_stride(*stride, aim == kIndices, view.bytes, document);
  const auto extensions = extensions_of(node);
  const auto packing = extensions ? extensions->find("EXT_meshopt_compression") : std::nullopt;
  if (packing) view.packing = read_packing(*packing, view.bytes, counts, document);
  return view;
}

/// Checks that `count` elements of `size` bytes from `offset` on, `stride` apart, lie in a view, and on multiples of
/// the component's size.
void check_elements(const json::Node& node, const BufferView& view, uint64_t offset, uint64_t count, uint64_t size,
                    uint64_t stride, uint32_t component_bytes, Document& document) {
  if (offset % component_bytes != 0 || (view.offset + offset) % component_bytes != 0)
    document.pass(
        Fault::alignment, node.pointer(),
        "the data do not start on a multiple of " + std::to_string(component_bytes) + " bytes, the size of a component",
        "aligned offsets");
  if (stride < size)
    document.pass(
        Fault::stride, node.pointer(),
        "the view's stride of " + std::to_string(stride) + " is below an element's " + std::to_string(size) + " bytes",
        "a larger stride");
  const bool fits =
      offset <= view.bytes && size <= view.bytes - offset && (count - 1) <= (view.bytes - offset - size) / stride;
  if (!fits)
    node.fail(std::to_string(count) + " elements from byte " + std::to_string(offset) +
                  " on do not fit into the view of " + std::to_string(view.bytes) + " bytes",
              "fewer elements or a longer view");
}

Sparse read_sparse(const json::Node& node, const Accessor& accessor, const Counts& counts, Document& document) {
  Sparse sparse;
  sparse.count = uint64_t(node.member("count").integer(1, kLargestCount));
  if (sparse.count > accessor.count) node.fail("there are more sparse elements than elements", "at most all");
  const json::Node indices = node.member("indices"), values = node.member("values");
  sparse.indices_view = index(indices.member("bufferView"), counts.views, "buffer view");
  sparse.indices_offset = whole_or(indices, "byteOffset", 0);
  const json::Node type = indices.member("componentType");
  sparse.index_type = component_of(type);
  using enum Component;
  if (sparse.index_type != uint8 && sparse.index_type != uint16 && sparse.index_type != uint32)
    type.fail("sparse indices are of a signed or floating type", "5121, 5123 or 5125");
  sparse.values_view = index(values.member("bufferView"), counts.views, "buffer view");
  sparse.values_offset = whole_or(values, "byteOffset", 0);
  const BufferView &index_view = document.views[sparse.indices_view], &value_view = document.views[sparse.values_view];
  if (index_view.stride != 0) indices.fail("a view of sparse data has a stride", "a view without one");
  if (value_view.stride != 0) values.fail("a view of sparse data has a stride", "a view without one");
  const uint32_t index_bytes = bytes_of(sparse.index_type);
  check_elements(indices, index_view, sparse.indices_offset, sparse.count, index_bytes, index_bytes, index_bytes,
                 document);
  const uint64_t size = element_bytes(accessor.type, accessor.shape);
  check_elements(values, value_view, sparse.values_offset, sparse.count, element_end(accessor.type, accessor.shape),
                 size, bytes_of(accessor.type), document);
  return sparse;
}

Accessor read_accessor(const json::Node& node, const Counts& counts, Document& document) {
  Accessor a;
  const auto offset = node.find("byteOffset");
  a.view = index_or_none(node, "bufferView", counts.views, "buffer view");
  if (offset && a.view == kNone) offset->fail("an accessor without a bufferView has a byteOffset", "remove it");
  a.offset = offset ? uint64_t(offset->integer(0, kLargestCount)) : 0;
  const json::Node type = node.member("componentType");
  a.type = component_of(type);
  a.count = uint64_t(node.member("count").integer(1, kLargestCount));
  a.shape = Shape(known_or_other(node.member("type"), kShapes));
  a.normalized = boolean_or(node, "normalized", false);
  if (a.normalized && (a.type == Component::float32 || a.type == Component::uint32))
    type.fail("floats and 32-bit integers cannot be normalized", "8 or 16 bits");
  for (const std::string_view bound : {"min", "max"})
    for_each(node, bound, [&](const json::Node& value, size_t) {
      const double number = value.number(-3.5e38, 3.5e38);
      if (bound == "max" && a.shape == Shape::scalar) a.largest = number;
    });
  if (a.shape == Shape::unknown) return a;
  const uint64_t size = element_bytes(a.type, a.shape);
  const bool is_matrix = a.shape >= Shape::mat2;
  if (a.view != kNone) {
    const BufferView& view = document.views[a.view];
    if (is_matrix && a.offset % 4 != 0)
      document.pass(Fault::alignment, node.pointer(), "a matrix is not aligned to 4 bytes", "align it");
    check_elements(node, view, a.offset, a.count, element_end(a.type, a.shape), view.stride != 0 ? view.stride : size,
                   bytes_of(a.type), document);
  }
  if (const auto sparse = node.find("sparse")) a.sparse = read_sparse(*sparse, a, counts, document);
  return a;
}

}  // namespace

uint64_t element_bytes(Component type, Shape shape) {
  const uint64_t component = bytes_of(type);
  if (shape < Shape::mat2 || shape == Shape::unknown) return component * components_of(shape);
  const uint64_t columns = rows_of(shape);
  return columns * ((columns * component + 3) / 4 * 4);
}

uint64_t element_end(Component type, Shape shape) {
  const uint64_t all = element_bytes(type, shape);
  if (shape < Shape::mat2 || shape == Shape::unknown) return all;
  const uint64_t column = rows_of(shape) * bytes_of(type);
  return all - ((column + 3) / 4 * 4 - column);
}

void read_data(const json::Node& root, const Counts& counts, Document& document) {
  for_each(root, "buffers", [&](const json::Node& node, size_t) { document.buffers.push_back(read_buffer(node)); });
  for_each(root, "bufferViews",
           [&](const json::Node& node, size_t) { document.views.push_back(read_view(node, counts, document)); });
  for_each(root, "accessors", [&](const json::Node& node, size_t) {
    document.accessors.push_back(read_accessor(node, counts, document));
  });
}

}  // namespace trueshade::gltf
