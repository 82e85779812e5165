#include "scenes/files/obj/read_obj.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <span>

#include "scenes/files/obj/geometry_budget.h"
#include "scenes/files/obj/statements.h"

namespace trueshade::obj {
namespace {

/// Statements that shape no polygon and that files may hold: state of free-form curves, and of how others render.
constexpr std::string_view kPassedOver[] = {"g",      "mg",     "bevel",      "c_interp",  "d_interp", "lod",
                                            "usemap", "maplib", "shadow_obj", "parm",      "trim",     "hole",
                                            "scrv",   "sp",     "end",        "vp",        "cstype",   "deg",
                                            "bmat",   "step",   "con",        "trace_obj", "ctech",    "stech"};
constexpr std::string_view kFreeForm[] = {"curv", "curv2", "surf", "bsp", "bzp", "cdc", "cdp", "res"};

bool among(std::span<const std::string_view> names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Whether a name ends in .mtl, in small letters or capitals.
bool names_library(std::string_view name) {
  if (name.size() < 4) return false;
  const std::string_view ending = name.substr(name.size() - 4);
  return ending[0] == '.' && (ending[1] | 32) == 'm' && (ending[2] | 32) == 't' && (ending[3] | 32) == 'l';
}

class ObjReader {
 public:
  ObjReader(std::span<const uint8_t> file, const std::string& name, const SceneLimits& limits, Faults& faults)
      : text_(file, name), budget_(limits, name), faults_(faults) {
    document_.file = name;
  }

  ObjDocument read() {
    while (text_.next()) read_or_pass_statement();
    check_indices();
    if (!document_.colors.empty()) document_.colors.resize(document_.position_count() * 4, 1.0f);
    return std::move(document_);
  }

 private:
  /// Of a statement that is passed over no corner stays, and the numbers of a vertex that are not there are 0, so that
  /// those behind it keep their indices.
  void read_or_pass_statement() {
    const size_t positions = document_.positions.size(), uvs = document_.uvs.size(), normals = document_.normals.size(),
                 corners = document_.corners.size();
    const std::string_view keyword = text_.keyword();
    try {
      read_statement();
    } catch (const Error& error) {
      faults_.pass(Fault::statement, document_.file + ": line " + std::to_string(text_.line()), error);
      document_.corners.resize(corners);
      if (keyword == "v") document_.positions.resize(positions + 3, 0.0f);
      if (keyword == "vt") document_.uvs.resize(uvs + 2, 0.0f);
      if (keyword == "vn") document_.normals.resize(normals + 3, 0.0f);
    }
  }

  void read_statement() {
    const std::string_view keyword = text_.keyword();
    if (keyword == "v") return read_position();
    if (keyword == "vt") return read_uv();
    if (keyword == "vn") return read_normal();
    if (keyword == "f" || keyword == "fo") return read_polygon();
    if (keyword == "usemtl") {
      state_.material = named(document_.material_names, materials_, text_.rest());
    } else if (keyword == "o") {
      state_.object = named(document_.object_names, objects_, text_.rest());
    } else if (keyword == "s") {
      read_smoothing();
    } else if (keyword == "mtllib") {
      read_libraries();
    } else if (keyword == "p") {
      ++document_.points;
    } else if (keyword == "l") {
      ++document_.lines;
    } else if (among(kFreeForm, keyword)) {
      ++document_.free_form;
    } else if (!among(kPassedOver, keyword)) {
      text_.fail("'" + shown_word(keyword) + "' is no statement of an OBJ file", "v vt vn f o g s usemtl mtllib p l");
    }
  }

  void take(uint64_t bytes) {
    if (!budget_.take(bytes)) text_.fail("the geometry is over the limit", budget_.remedy(), ErrorKind::limit);
  }

  int32_t named(std::vector<std::string>& names, std::map<std::string, int32_t>& known, std::string name) {
    const auto [found, is_new] = known.emplace(name, int32_t(names.size()));
    if (is_new) {
      take(2 * name.size() + 128);
      names.push_back(std::move(name));
    }
    return found->second;
  }

  /// x y z, x y z w, x y z R G B or x y z R G B A. The weight w is of rational curves and says nothing of polygons.
  void read_position() {
    take(3 * sizeof(float));
    const char* const kNames[] = {"x", "y", "z"};
    for (const char* name : kNames) document_.positions.push_back(text_.number(name));
    if (text_.at_end()) return;
    float more[4] = {0.0f, 0.0f, 0.0f, 1.0f};
    int count = 0;
    for (; count < 4 && !text_.at_end(); ++count) more[count] = text_.number("a colour");
    text_.finish();
    if (count == 2) text_.fail("a vertex has 5 numbers", "x y z, or x y z R G B");
    if (count >= 3) add_color(more);
  }

  void add_color(const float (&color)[4]) {
    for (int k = 0; k < 4; ++k)
      if (!(color[k] >= 0.0f && (k < 3 || color[k] <= 1.0f)))
        text_.fail("the vertex's colour is out of range", "R, G and B from 0 to 1e18, alpha from 0 to 1");
    const size_t at = 4 * (document_.position_count() - 1);
    take((at + 4 - document_.colors.size()) * sizeof(float));
    document_.colors.resize(at, 1.0f);
    document_.colors.insert(document_.colors.end(), color, color + 4);
  }

  void read_uv() {
    take(2 * sizeof(float));
    document_.uvs.push_back(text_.number("u"));
    document_.uvs.push_back(text_.at_end() ? 0.0f : text_.number("v"));
    if (!text_.at_end()) text_.number("w");
    text_.finish();
  }

  void read_normal() {
    take(3 * sizeof(float));
    const char* const kNames[] = {"x", "y", "z"};
    for (const char* name : kNames) document_.normals.push_back(text_.number(name));
    text_.finish();
  }

  void read_smoothing() {
    const std::string_view group = text_.word();
    text_.finish();
    if (group == "off") {
      state_.smoothing = 0;
      return;
    }
    int32_t number = 0;
    const auto [end, code] = std::from_chars(group.data(), group.data() + group.size(), number);
    if (code != std::errc() || end != group.data() + group.size() || number < 0)
      text_.fail("the smoothing group is '" + shown_word(group) + "'", "off, or a whole number from 0 on");
    state_.smoothing = number;
  }

  /// Names of libraries may hold blanks: a name goes on up to the word that ends in .mtl.
  void read_libraries() {
    if (text_.at_end()) text_.fail("mtllib names no file", "the name of an MTL file");
    std::string name;
    while (!text_.at_end()) {
      name += (name.empty() ? "" : " ") + std::string(text_.word());
      if (!names_library(name) && !text_.at_end()) continue;
      if (libraries_.emplace(name, 0).second) {
        take(2 * name.size() + 128);
        document_.libraries.push_back({name, text_.line()});
      }
      name.clear();
    }
  }

  /// One of a corner's indices, read from `at` on; `count` elements stand above. 0 where there is none.
  int32_t index(const char*& at, const char* last, size_t count, const char* what) {
    if (at == last || *at == '/') return 0;
    int64_t value = 0;
    const auto [end, code] = std::from_chars(at + (*at == '+'), last, value);
    if (code != std::errc() || (end != last && *end != '/'))
      text_.fail(std::string("the index of a ") + what + " is '" + shown_word({at, size_t(last - at)}) + "'",
                 "a whole number, or v/vt/vn");
    at = end;
    const int64_t from_start = value < 0 ? int64_t(count) + value + 1 : value;
    if (value == 0 || from_start < 1 || from_start > INT32_MAX)
      text_.fail(std::string("the index of a ") + what + " is " + std::to_string(value),
                 value == 0 ? "indices from 1 on, or negative ones"
                            : "at most the " + std::to_string(count) + " that stand above");
    return int32_t(from_start);
  }

  Corner read_corner(std::string_view word) {
    const char *at = word.data(), *last = at + word.size();
    int32_t parts[3] = {};
    const size_t counts[] = {document_.position_count(), document_.uvs.size() / 2, document_.normals.size() / 3};
    const char* const kNames[] = {"vertex", "texture coordinate", "normal"};
    for (int k = 0; k < 3; ++k) {
      parts[k] = index(at, last, counts[k], kNames[k]);
      if (at == last || k == 2) break;
      ++at;  // a slash
    }
    if (at != last || parts[0] == 0)
      text_.fail("the corner is '" + shown_word(word) + "'", "v, v/vt, v//vn or v/vt/vn");
    return {parts[0] - 1, parts[1] - 1, parts[2] - 1};
  }

  void read_polygon() {
    const uint32_t line = text_.line();
    const size_t first = document_.corners.size();
    for (std::string_view word = text_.word(); !word.empty(); word = text_.word()) {
      take(sizeof(Corner));
      document_.corners.push_back(read_corner(word));
      const Corner &a = document_.corners[first], &b = document_.corners.back();
      if ((a.uv < 0) != (b.uv < 0) || (a.normal < 0) != (b.normal < 0))
        text_.fail("the corners of a face are of different forms", "v, v/vt, v//vn or v/vt/vn for all of them");
    }
    const size_t count = document_.corners.size() - first;
    if (count < 3) text_.fail("a face has " + std::to_string(count) + " corners", "3 or more");
    if (document_.corners.size() > UINT32_MAX / 4)
      text_.fail("the faces have too many corners", "below 2^30", ErrorKind::limit);
    take(2 * sizeof(uint32_t));
    begin_run();
    document_.polygon_ends.push_back(uint32_t(document_.corners.size()));
    document_.polygon_lines.push_back(line);
  }

  void begin_run() {
    const auto& runs = document_.runs;
    if (!runs.empty() && runs.back().material == state_.material && runs.back().object == state_.object &&
        runs.back().smoothing == state_.smoothing)
      return;
    take(sizeof(Run));
    document_.runs.push_back(state_);
    document_.runs.back().first_polygon = uint32_t(document_.polygon_count());
  }

  /// Indices from 1 on may name what stands below them, so that they are checked last. Corners of a face that is passed
  /// over become one point: it covers no pixel.
  void check_indices() {
    const int64_t counts[] = {int64_t(document_.position_count()), int64_t(document_.uvs.size() / 2),
                              int64_t(document_.normals.size() / 3)};
    const char* const kNames[] = {"vertex", "texture coordinate", "normal"};
    constexpr int kKinds[] = {0, 1, 2};
    size_t first = 0;
    for (size_t polygon = 0; polygon < document_.polygon_count(); ++polygon) {
      const std::span<Corner> corners =
          std::span(document_.corners).subspan(first, document_.polygon_ends[polygon] - first);
      first = document_.polygon_ends[polygon];
      for (const Corner& c : corners) {
        const int32_t indices[] = {c.position, c.uv, c.normal};
        const auto beyond =
            std::find_if(std::begin(kKinds), std::end(kKinds), [&](int k) { return indices[k] >= counts[k]; });
        if (beyond == std::end(kKinds)) continue;
        const uint32_t line = document_.polygon_lines[polygon];
        faults_.pass(Fault::statement, document_.file + ": line " + std::to_string(line),
                     std::string("the index of a ") + kNames[*beyond] + " is " + std::to_string(indices[*beyond] + 1),
                     "at most the " + std::to_string(counts[*beyond]) + " that the file has");
        if (counts[0] == 0) text_.fail_at(line, "there is no vertex", "v statements");
        std::fill(corners.begin(), corners.end(), Corner{0, -1, -1});
        break;
      }
    }
  }

  Statements text_;
  GeometryBudget budget_;
  Faults& faults_;
  ObjDocument document_;
  Run state_;
  std::map<std::string, int32_t> materials_, objects_, libraries_;
};

}  // namespace

ObjDocument read_obj(std::span<const uint8_t> file, const std::string& name, const SceneLimits& limits,
                     Faults& faults) {
  return ObjReader(file, name, limits, faults).read();
}

}  // namespace trueshade::obj
