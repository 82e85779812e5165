#include "scenes/files/load_ply.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

#include "core/error.h"
#include "core/memory_cap.h"
#include "scenes/files/ply_header.h"

namespace trueshade {
namespace {

using ply::Element;
using ply::Encoding;
using ply::Property;
using ply::Type;

static_assert(std::endian::native == std::endian::little);

/// Values one after another, from text.
class TextSource {
 public:
  TextSource(std::span<const uint8_t> file, const ply::Header& header, std::string_view where)
      : next_(reinterpret_cast<const char*>(file.data()) + header.bytes),
        end_(reinterpret_cast<const char*>(file.data()) + file.size()),
        line_(header.lines + 1),
        where_(where) {}

  std::string place() const { return std::string(where_) + ": line " + std::to_string(line_); }

  [[noreturn]] void fail(const std::string& reason, const std::string& remedy) const {
    throw Error(ErrorKind::bad_input, place(), reason, remedy);
  }

  double value(Type type) {
    const std::string_view word = next_word();
    const char* first = word.data() + (word.starts_with('+') ? 1 : 0);
    const char* last = word.data() + word.size();
    double result = 0.0;
    if (ply::is_integer(type)) {
      int64_t whole = 0;
      check(std::from_chars(first, last, whole), last, word);
      const int bits = int(8 * ply::bytes_of(type));
      const bool is_signed = type == Type::int8 || type == Type::int16 || type == Type::int32;
      const int64_t least = is_signed ? -(int64_t(1) << (bits - 1)) : 0,
                    most = (int64_t(1) << (is_signed ? bits - 1 : bits)) - 1;
      if (whole < least || whole > most)
        fail("'" + std::string(word.substr(0, 40)) + "' does not fit its type", "a number in the type's range");
      result = double(whole);
    } else if (type == Type::float32) {
      float single = 0.0f;  // straight to float: by way of double it could be rounded twice
      check(std::from_chars(first, last, single), last, word);
      result = double(single);
    } else {
      check(std::from_chars(first, last, result), last, word);
    }
    return result;
  }

  void skip(Type type) { value(type); }
  uint64_t least_bytes(Type) const { return 2; }  // a digit and the space before the next; the last may lack the space
  uint64_t left() const { return uint64_t(end_ - next_) + 1; }

  void finish() {
    skip_space();
    if (next_ != end_) fail("more data after the last element", "the counts of the header and the data to agree");
  }

 private:
  void check(const std::from_chars_result& result, const char* last, std::string_view word) const {
    if (result.ec != std::errc() || result.ptr != last)
      fail("'" + printable(word) + "' is no number of its type", "a number");
  }

  static std::string printable(std::string_view word) {
    std::string text(word.substr(0, 40));
    for (char& c : text)
      if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7e) c = '?';
    return text;
  }

  void skip_space() {
    for (; next_ != end_ && (*next_ == ' ' || *next_ == '\t' || *next_ == '\r' || *next_ == '\n'); ++next_)
      line_ += *next_ == '\n';
  }

  std::string_view next_word() {
    skip_space();
    const char* start = next_;
    while (next_ != end_ && *next_ != ' ' && *next_ != '\t' && *next_ != '\r' && *next_ != '\n') ++next_;
    if (start == next_) fail("the data end early", "as many elements as the header says");
    return {start, size_t(next_ - start)};
  }

  const char *next_, *end_;
  int line_;
  std::string_view where_;
};

/// Values one after another, from bytes.
class BinarySource {
 public:
  BinarySource(std::span<const uint8_t> file, const ply::Header& header, std::string_view where)
      : file_(file), next_(header.bytes), swapped_(header.encoding == Encoding::big_endian), where_(where) {}

  std::string place() const { return std::string(where_) + ": byte " + std::to_string(next_); }

  [[noreturn]] void fail(const std::string& reason, const std::string& remedy) const {
    throw Error(ErrorKind::bad_input, place(), reason, remedy);
  }

  double value(Type type) {
    uint8_t bytes[8];
    const size_t count = ply::bytes_of(type);
    if (file_.size() - next_ < count) fail("the data end early", "as many elements as the header says");
    std::memcpy(bytes, file_.data() + next_, count);
    next_ += count;
    if (swapped_) std::reverse(bytes, bytes + count);
    switch (type) {
      case Type::int8:
        return as<int8_t>(bytes);
      case Type::uint8:
        return as<uint8_t>(bytes);
      case Type::int16:
        return as<int16_t>(bytes);
      case Type::uint16:
        return as<uint16_t>(bytes);
      case Type::int32:
        return as<int32_t>(bytes);
      case Type::uint32:
        return as<uint32_t>(bytes);
      case Type::float32:
        return double(as<float>(bytes));
      case Type::float64:
        return as<double>(bytes);
    }
    return 0.0;  // unreachable
  }

  void skip(Type type) { value(type); }
  uint64_t least_bytes(Type type) const { return ply::bytes_of(type); }
  uint64_t left() const { return file_.size() - next_; }

  void finish() const {
    if (left() != 0)
      fail(std::to_string(left()) + " bytes after the last element", "the counts of the header and the data to agree");
  }

 private:
  template <typename T>
  static T as(const uint8_t* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
  }
  std::span<const uint8_t> file_;
  size_t next_;
  bool swapped_;
  std::string_view where_;
};

/// Where each property of a vertex goes: a stream of the mesh, or nowhere.
struct Target {
  FloatStream* stream = nullptr;
  double scale = 1.0;  ///< the value is divided by it
  bool is_color = false;
};

const Property* find(const Element& element, std::string_view name) {
  for (const Property& p : element.properties)
    if (p.name == name && !p.count) return &p;
  return nullptr;
}

template <typename Source>
class Reader {
 public:
  Reader(Source source, const ply::Header& header, std::string_view where, Faults& faults, Mesh& mesh)
      : source_(source), header_(header), where_(where), faults_(faults), mesh_(mesh) {}

  /// Whether the file had normals.
  bool read() {
    bool has_vertices = false, has_faces = false;
    for (const Element& element : header_.elements) {
      check_count(element);
      if (element.name == "vertex") {
        read_vertices(element);
        has_vertices = true;
      } else if (element.name == "face") {
        if (!has_vertices) source_.fail("faces before vertices", "element vertex first");
        read_faces(element);
        has_faces = true;
      } else {
        for (uint64_t i = 0; i < element.count; ++i)
          for (const Property& property : element.properties) skip(property);
      }
    }
    if (!has_vertices || !has_faces)
      source_.fail(has_vertices ? "there are no faces: this is a cloud of points" : "there are no vertices",
                   "elements vertex and face");
    source_.finish();
    return has_normals_;
  }

 private:
  /// Before anything is allocated: the rest of the file must be able to hold the elements.
  void check_count(const Element& element) {
    uint64_t bytes = 0;
    for (const Property& p : element.properties) bytes += source_.least_bytes(p.count.value_or(p.type));
    if (element.count > 0 && (bytes == 0 || element.count > source_.left() / bytes))
      source_.fail(
          "element " + element.name + " says " + std::to_string(element.count) + " and the file is too short for them",
          "as many as the file holds");
    if (element.name == "vertex" && element.count >= UINT32_MAX)
      source_.fail(std::to_string(element.count) + " vertices", "below 2^32");
  }

  /// What else may be wrong where the first face cannot be read: it begins where the vertices end.
  std::string count_in_doubt(uint64_t face) const {
    if (face > 0) return "";
    return "; perhaps the vertices are not " + std::to_string(mesh_.vertex_count()) + ", as the header says";
  }

  uint64_t list_length(const Property& property, const std::string& doubt = "") {
    const double length = source_.value(*property.count);
    if (length < 0.0 || uint64_t(length) > source_.left() / source_.least_bytes(property.type))
      source_.fail("a list says " + std::to_string(int64_t(length)) + " and the file is too short for it" + doubt,
                   "as many as the file holds");
    return uint64_t(length);
  }

  void skip(const Property& property) {
    const uint64_t count = property.count ? list_length(property) : 1;
    for (uint64_t i = 0; i < count; ++i) source_.skip(property.type);
  }

  /// Streams for a group of properties, all of which must be there; `required` or none.
  template <size_t N>
  bool assign(const Element& element, std::vector<Target>& targets, const std::array<std::string_view, N>& names,
              std::array<FloatStream, N>& streams, bool required) {
    size_t found = 0;
    for (const std::string_view name : names) found += find(element, name) != nullptr;
    if (found == 0 && !required) return false;
    if (found != N) {
      const std::string reason =
          "the vertices have only some of " + std::string(names[0]) + " to " + std::string(names[N - 1]);
      if (required) source_.fail(reason, "all or none");
      faults_.pass(Fault::value, source_.place(), reason, "all or none");
      return false;
    }
    for (size_t k = 0; k < N; ++k) {
      targets[size_t(find(element, names[k]) - element.properties.data())] = {&streams[k], 1.0, false};
      streams[k].reserve(element.count);
    }
    return true;
  }

  /// What a value of a colour is divided by; 0 of types that colours have not.
  static double color_scale(Type type) {
    if (type == Type::uint8) return 255.0;
    if (type == Type::uint16) return 65535.0;
    return ply::is_integer(type) ? 0.0 : 1.0;
  }

  void assign_colors(const Element& element, std::vector<Target>& targets) {
    const std::array<const Property*, 4> found{find(element, "red"), find(element, "green"), find(element, "blue"),
                                               find(element, "alpha")};
    const auto colors = std::span(found).first(3);
    if (std::count(colors.begin(), colors.end(), nullptr) == 3) return;
    if (std::count(colors.begin(), colors.end(), nullptr) > 0)
      return faults_.pass(Fault::value, source_.place(), "the vertices have only some of red, green, blue",
                          "all or none");
    if (std::any_of(found.begin(), found.end(), [](const Property* p) { return p && color_scale(p->type) == 0.0; }))
      return faults_.pass(Fault::value, source_.place(), "colours are of a signed or 32-bit type",
                          "uchar, ushort, float or double");
    for (size_t k = 0; k < found.size(); ++k) {
      if (!found[k]) continue;
      targets[size_t(found[k] - element.properties.data())] = {&mesh_.color[k], color_scale(found[k]->type), true};
      mesh_.color[k].reserve(element.count);
    }
    if (!found[3]) mesh_.color[3].assign(element.count, 1.0f);
  }

  void read_vertices(const Element& element) {
    std::vector<Target> targets(element.properties.size());
    require_memory(element.count * sizeof(float) * std::min<size_t>(targets.size(), kMostStreams), where_,
                   "its vertices");
    assign<3>(element, targets, {"x", "y", "z"}, mesh_.position, true);
    has_normals_ = assign<3>(element, targets, {"nx", "ny", "nz"}, mesh_.normal, false);
    assign<2>(element, targets, {"u", "v"}, mesh_.uv, false) ||
        assign<2>(element, targets, {"s", "t"}, mesh_.uv, false) ||
        assign<2>(element, targets, {"texture_u", "texture_v"}, mesh_.uv, false);
    assign_colors(element, targets);
    for (uint64_t i = 0; i < element.count; ++i)
      for (size_t p = 0; p < targets.size(); ++p) {
        if (!targets[p].stream) {
          skip(element.properties[p]);
          continue;
        }
        const double value = source_.value(element.properties[p].type) / targets[p].scale;
        const double least = targets[p].is_color ? 0.0 : -1e18;
        if (!(value >= least && value <= 1e18))
          source_.fail("vertex " + std::to_string(i) + ": " + element.properties[p].name + " is out of range",
                       targets[p].is_color ? "a number from 0 to 1e18" : "a number from -1e18 to 1e18");
        targets[p].stream->push_back(float(value));
      }
  }

  void read_faces(const Element& element) {
    size_t list = element.properties.size();
    for (size_t p = 0; p < element.properties.size(); ++p)
      if (element.properties[p].count &&
          (element.properties[p].name == "vertex_indices" || element.properties[p].name == "vertex_index"))
        list = p;
    if (list == element.properties.size() || !ply::is_integer(element.properties[list].type))
      source_.fail("the faces have no list of integers vertex_indices or vertex_index", "one such list");
    for (uint64_t face = 0; face < element.count; ++face)
      for (size_t p = 0; p < element.properties.size(); ++p) {
        if (p == list)
          read_polygon(element.properties[p], face);
        else
          skip(element.properties[p]);
      }
    if (thin_faces_ > 0)
      faults_.pass(Fault::value, source_.place(), "faces of fewer than 3 corners: " + std::to_string(thin_faces_),
                   "3 or more");
  }

  void read_polygon(const Property& property, uint64_t face) {
    const uint64_t corners = list_length(property, count_in_doubt(face));
    if (corners < 3 && faults_.passed()) {
      ++thin_faces_;
      for (uint64_t i = 0; i < corners; ++i) source_.skip(property.type);
      return;
    }
    if (corners < 3)
      source_.fail(
          "face " + std::to_string(face) + " has " + std::to_string(corners) + " corners" + count_in_doubt(face),
          faults_.remedy("3 or more"));
    make_room(3 * (corners - 2));
    uint32_t first = 0, previous = 0;
    for (uint64_t i = 0; i < corners; ++i) {
      const double index = source_.value(property.type);
      if (!(index >= 0.0 && index < double(mesh_.vertex_count())))
        source_.fail(
            "face " + std::to_string(face) + ": index " + std::to_string(int64_t(index)) + " is beyond the vertices",
            "from 0 to below " + std::to_string(mesh_.vertex_count()));
      const uint32_t corner = uint32_t(index);
      if (i == 0) first = corner;
      if (i >= 2) mesh_.indices.insert(mesh_.indices.end(), {first, previous, corner});
      previous = corner;
    }
  }

  /// Before indices grow, which doubles them.
  void make_room(uint64_t more) {
    const uint64_t needed = mesh_.indices.size() + more;
    if (needed <= mesh_.indices.capacity()) return;
    const uint64_t room = std::max<uint64_t>(needed, 2 * mesh_.indices.size());
    require_memory(room * sizeof(uint32_t), where_, "its triangles");
    mesh_.indices.reserve(size_t{room});
  }

  static constexpr size_t kMostStreams = 12;  // position, normal, uv, colour
  Source source_;
  const ply::Header& header_;
  std::string_view where_;
  Faults& faults_;
  Mesh& mesh_;
  bool has_normals_ = false;
  uint64_t thin_faces_ = 0;  ///< of fewer than 3 corners
};

/// Numbers that a vertex has, with a normal.
uint64_t streams_of(const Mesh& mesh) {
  uint64_t streams = 6;
  for (const auto& stream : mesh.uv) streams += !stream.empty();
  for (const auto& stream : mesh.color) streams += !stream.empty();
  return streams;
}

}  // namespace

Mesh mesh_from_ply(std::span<const uint8_t> file, std::string_view where, MissingNormals missing_normals,
                   Faults& faults) {
  const ply::Header header = ply::header_of(file, where, faults);
  Mesh mesh;
  const auto read = [&](auto source) { return Reader(source, header, where, faults, mesh).read(); };
  const bool has_normals = header.encoding == Encoding::ascii ? read(TextSource(file, header, where))
                                                              : read(BinarySource(file, header, where));
  if (!has_normals) {
    const uint64_t corners = missing_normals == MissingNormals::flat ? mesh.indices.size() : 0;
    require_memory(corners * sizeof(float) * streams_of(mesh) + 36 * uint64_t(mesh.vertex_count()), where,
                   "its normals");
    add_normals(mesh, missing_normals);
  }
  return mesh;
}

}  // namespace trueshade
