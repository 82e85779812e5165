#include "scenes/files/ply_header.h"

#include <algorithm>
#include <charconv>

#include "core/error.h"

namespace trueshade::ply {
namespace {

constexpr size_t kMaxParts = 256;  // elements, and properties of one: names are compared pairwise; lines left out
constexpr size_t kMaxLine = 4096;  // bytes; a file that is no PLY must not be searched for line ends to its end

std::optional<Type> type_from_name(std::string_view name) {
  struct Spelling {
    std::string_view name;
    Type type;
  };
  constexpr Spelling kSpellings[] = {
      {"char", Type::int8},   {"uchar", Type::uint8},   {"short", Type::int16},     {"ushort", Type::uint16},
      {"int", Type::int32},   {"uint", Type::uint32},   {"float", Type::float32},   {"double", Type::float64},
      {"int8", Type::int8},   {"uint8", Type::uint8},   {"int16", Type::int16},     {"uint16", Type::uint16},
      {"int32", Type::int32}, {"uint32", Type::uint32}, {"float32", Type::float32}, {"float64", Type::float64}};
  for (const Spelling& s : kSpellings)
    if (s.name == name) return s.type;
  return std::nullopt;
}

class HeaderReader {
 public:
  HeaderReader(std::span<const uint8_t> file, std::string_view where, Faults& faults)
      : text_(reinterpret_cast<const char*>(file.data()), file.size()), where_(where), faults_(faults) {}

  Header read() {
    next_line();
    if (words_.size() != 1 || words_[0] != "ply") fail("the file does not start with 'ply'", "a PLY file");
    next_line();
    read_format();
    for (;;) {
      next_line();
      if (words_.empty()) {
        leave_out("the line is empty", "a keyword of a PLY header");
        continue;
      }
      const std::string_view keyword = words_[0];
      if (keyword == "comment" || keyword == "obj_info") continue;
      if (keyword == "end_header" && words_.size() == 1) break;
      if (keyword == "element")
        read_element();
      else if (keyword == "property")
        read_property();
      else
        leave_out("'" + std::string(keyword.substr(0, 40)) + "' is no keyword of a PLY header",
                  "comment, obj_info, element, property or end_header");
    }
    header_.bytes = position_;
    header_.lines = line_;
    return std::move(header_);
  }

 private:
  std::string place() const { return std::string(where_) + ": line " + std::to_string(line_); }

  [[noreturn]] void fail(const std::string& reason, const std::string& remedy) const {
    throw Error(ErrorKind::bad_input, place(), reason, remedy);
  }

  void leave_out(const std::string& reason, const std::string& remedy) {
    check_room(left_out_++, "lines of no keyword");
    faults_.pass(Fault::statement, place(), reason, remedy);
  }

  void check_room(size_t parts, const char* what) const {
    if (parts < kMaxParts) return;
    throw Error(ErrorKind::limit, place(), std::string("there are too many ") + what,
                "at most " + std::to_string(kMaxParts));
  }

  void next_line() {
    ++line_;
    const size_t end = text_.substr(0, position_ + kMaxLine).find('\n', position_);
    if (end == std::string_view::npos) fail("the header has no end", "a header that ends with end_header");
    std::string_view line = text_.substr(position_, end - position_);
    if (line.ends_with('\r')) line.remove_suffix(1);
    position_ = end + 1;
    words_.clear();
    for (size_t start = line.find_first_not_of(" \t"); start != std::string_view::npos;) {
      const size_t stop = std::min(line.find_first_of(" \t", start), line.size());
      words_.push_back(line.substr(start, stop - start));
      start = line.find_first_not_of(" \t", stop);
    }
  }

  void read_format() {
    if (words_.size() != 3 || words_[0] != "format" || words_[2] != "1.0")
      fail("the second line is no format", "'format ascii 1.0' or alike");
    if (words_[1] == "ascii")
      header_.encoding = Encoding::ascii;
    else if (words_[1] == "binary_little_endian")
      header_.encoding = Encoding::little_endian;
    else if (words_[1] == "binary_big_endian")
      header_.encoding = Encoding::big_endian;
    else
      fail("the format is unknown", "ascii, binary_little_endian or binary_big_endian");
  }

  void read_element() {
    if (words_.size() != 3) fail("an element has a name and a count", "'element vertex 8'");
    check_room(header_.elements.size(), "elements");
    Element element{std::string(words_[1]), 0, {}};
    const char* end = words_[2].data() + words_[2].size();
    const auto [stop, code] = std::from_chars(words_[2].data(), end, element.count);
    if (code != std::errc() || stop != end) fail("the count is no whole number", "digits");
    for (const Element& other : header_.elements)
      if (other.name == element.name) fail("element " + element.name + " is given twice", "one of each name");
    header_.elements.push_back(std::move(element));
  }

  void read_property() {
    if (header_.elements.empty()) fail("a property before any element", "an element first");
    check_room(header_.elements.back().properties.size(), "properties of one element");
    const bool list = words_.size() == 5 && words_[1] == "list";
    if (!list && words_.size() != 3)
      fail("a property has a type and a name", "'property float x' or 'property list uchar int vertex_indices'");
    Property property{std::string(words_.back()), type(words_[words_.size() - 2]), std::nullopt};
    if (list) {
      property.count = type(words_[2]);
      if (!is_integer(*property.count)) fail("the length of a list is a float", "an integer type");
    }
    for (const Property& other : header_.elements.back().properties)
      if (other.name == property.name) fail("property " + property.name + " is given twice", "one of each name");
    header_.elements.back().properties.push_back(std::move(property));
  }

  Type type(std::string_view name) const {
    if (const auto found = type_from_name(name)) return *found;
    fail("'" + std::string(name.substr(0, 40)) + "' is no type", "char uchar short ushort int uint float double");
  }

  std::string_view text_, where_;
  Faults& faults_;
  size_t left_out_ = 0;
  std::vector<std::string_view> words_;
  size_t position_ = 0;
  int line_ = 0;
  Header header_;
};

}  // namespace

Header header_of(std::span<const uint8_t> file, std::string_view where, Faults& faults) {
  return HeaderReader(file, where, faults).read();
}

}  // namespace trueshade::ply
