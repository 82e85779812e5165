#include "scenes/files/obj/read_mtl.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>

#include "scenes/files/obj/statements.h"
#include "scenes/texture.h"
#include "scenes/uv_transform.h"

namespace trueshade::obj {
namespace {

std::string in_small_letters(std::string_view word) {
  std::string text(word);
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = char(c + 32);
  return text;
}

/// Words that programs write into every file: docs/obj.md says of them what a note would say of each file.
constexpr std::string_view kInEveryFile[] = {"ka", "ni", "tf"};

class MtlReader {
 public:
  MtlReader(std::span<const uint8_t> file, const std::string& name, Faults& faults)
      : text_(file, name), faults_(faults) {
    document_.file = name;
  }

  MtlDocument read() {
    while (text_.next()) try {
        read_statement();
      } catch (const Error& error) {
        faults_.pass(Fault::statement, document_.file + std::to_string(text_.line()), error);
      }
    return std::move(document_);
  }

 private:
  void read_statement() {
    const std::string keyword = in_small_letters(text_.keyword());
    if (keyword == "newmtl")
      begin_material();
    else if (is_left_out_)
      return;
    else if (document_.materials.empty())
      text_.fail("'" + shown_word(text_.keyword()) + "' stands before the first newmtl", "newmtl and a name first");
    else if (!read_value(keyword, document_.materials.back()) && !read_map(keyword, document_.materials.back()) &&
             std::find(std::begin(kInEveryFile), std::end(kInEveryFile), keyword) == std::end(kInEveryFile))
      ++document_.passed_over[shown_word(text_.keyword())];
  }

  void begin_material() {
    MtlMaterial material;
    is_left_out_ = true;  // until it is there: where a newmtl is passed over, so is what follows it
    material.name = text_.rest();
    material.line = text_.line();
    if (!names_.insert(material.name).second) text_.fail("a material of this name exists", "another name");
    document_.materials.push_back(std::move(material));
    is_left_out_ = false;
  }

  float number_in(const char* what, float least, float most, const char* remedy) {
    const float value = text_.number(what);
    if (!(value >= least && value <= most)) text_.fail(std::string(what) + " is out of range", remedy);
    return value;
  }

  /// Three numbers, or one for all.
  glm::vec3 color() {
    constexpr const char* kRange = "1 or 3 numbers from 0 to 1e18";
    for (const char* other : {"spectral", "xyz"})
      if (const std::string name = other; !text_.at_end() && next_word_is(name))
        text_.fail("colours by '" + name + "' are not implemented", "R G B");
    glm::vec3 color(number_in("a colour", 0.0f, 1e18f, kRange));
    if (text_.at_end()) return color;
    color.y = number_in("a colour", 0.0f, 1e18f, kRange);
    color.z = number_in("a colour", 0.0f, 1e18f, kRange);
    text_.finish();
    return color;
  }

  bool next_word_is(std::string_view word) {
    Statements ahead = text_;
    return ahead.word() == word;
  }

  float share(const char* what) {
    const float value = number_in(what, 0.0f, 1.0f, "a number from 0 to 1");
    text_.finish();
    return value;
  }

  void read_opacity(MtlMaterial& m) {
    if (next_word_is("-halo")) {
      text_.word();
      ++document_.passed_over["-halo"];
    }
    m.d = share("d");
    has_d_ = m.line;
  }

  void read_illum(MtlMaterial& m) {
    m.illum = int(number_in("illum", 0.0f, 10.0f, "a whole number from 0 to 10"));
    text_.finish();
  }

  /// Statements of numbers. Whether the keyword is one of them.
  bool read_value(const std::string& keyword, MtlMaterial& m) {
    if (keyword == "kd") return m.kd = color(), true;
    if (keyword == "ks") return m.ks = color(), true;
    if (keyword == "ke") return m.ke = color(), true;
    if (keyword == "ns") return m.ns = number_in("Ns", 0.0f, 1e18f, "a number from 0 on"), text_.finish(), true;
    if (keyword == "d") return read_opacity(m), true;
    if (keyword == "illum") return read_illum(m), true;
    if (keyword == "pr") return m.pr = share("Pr"), true;
    if (keyword == "pm") return m.pm = share("Pm"), true;
    if (keyword != "tr") return false;
    const float transparency = share("Tr"), opacity = transparency < 1.0f ? 1.0f - transparency : 1.0f;  // MeshLab's 1
    if (has_d_ != m.line) m.d = opacity;  // where both are given, d is the one that all readers agree on
    return true;
  }

  /// Statements that name a picture. Whether the keyword is one of them.
  bool read_map(const std::string& keyword, MtlMaterial& m) {
    struct Row {
      std::string_view keyword;
      std::optional<MapSource> MtlMaterial::*map;
    };
    constexpr Row kRows[] = {
        {"map_kd", &MtlMaterial::map_kd}, {"map_ks", &MtlMaterial::map_ks}, {"map_ke", &MtlMaterial::map_ke},
        {"map_d", &MtlMaterial::map_d},   {"bump", &MtlMaterial::map_bump}, {"map_bump", &MtlMaterial::map_bump},
        {"norm", &MtlMaterial::norm},     {"map_pr", &MtlMaterial::map_pr}, {"map_pm", &MtlMaterial::map_pm}};
    for (const Row& row : kRows)
      if (row.keyword == keyword) {
        m.*row.map = read_source();
        return true;
      }
    return false;
  }

  MapSource read_source() {
    MapSource source;
    source.line = text_.line();
    while (!text_.at_end() && read_option(source)) {
    }
    source.file = text_.rest();
    if (source.file.empty()) text_.fail("the statement names no picture", "options, then the name of a file");
    return source;
  }

  /// An option of a picture, if the next word is one.
  bool read_option(MapSource& source) {
    const Statements before = text_;
    const std::string option = in_small_letters(text_.word());
    if (option == "-bm") return source.bump = number_in("-bm", -1000.0f, 1000.0f, "a number within 1000"), true;
    if (option == "-o") return read_two(source.offset, 0.0f), true;
    if (option == "-s") return read_two(source.scale, 1.0f), true;
    if (option == "-clamp") return source.clamp = text_.word() == "on", true;
    struct Other {
      std::string_view name;
      int words;
    };
    constexpr Other kOthers[] = {{"-blendu", 1}, {"-blendv", 1}, {"-boost", 1},   {"-cc", 1},        {"-mm", 2},
                                 {"-texres", 1}, {"-type", 1},   {"-imfchan", 1}, {"-colorspace", 1}};
    const auto other =
        std::find_if(std::begin(kOthers), std::end(kOthers), [&](const Other& o) { return o.name == option; });
    if (other != std::end(kOthers)) {
      for (int i = 0; i < other->words; ++i) text_.word();
    } else if (option == "-t") {
      for (int i = 0; i < 3 && text_.number_if_any(); ++i) {
      }
    } else {
      text_ = before;
      if (option.starts_with('-') && option.size() > 1)
        text_.fail("'" + shown_word(option) + "' is no option of a picture",
                   "-bm -o -s -clamp, or one of MTL's others");
      return false;
    }
    ++document_.passed_over[option];
    return true;
  }

  /// One to three numbers, of u, v and w.
  void read_two(glm::vec2& out, float absent) {
    const auto within = [&](float value) {
      if (!(std::fabs(value) <= kLargestUvTransform)) text_.fail("an option's number is out of range", "within 1e6");
      return value;
    };
    out = {within(text_.number("an option's number")), absent};
    if (const auto v = text_.number_if_any()) {
      out.y = within(*v);
      text_.number_if_any();
    }
  }

  Statements text_;
  Faults& faults_;
  MtlDocument document_;
  std::set<std::string> names_;
  bool is_left_out_ = false;       ///< the material that statements are of
  std::optional<uint32_t> has_d_;  ///< line of the newmtl of the last material with a statement d
};

}  // namespace

MtlDocument read_mtl(std::span<const uint8_t> file, const std::string& name, Faults& faults) {
  return MtlReader(file, name, faults).read();
}

}  // namespace trueshade::obj
