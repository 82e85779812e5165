#include "judge/bounds/profile_file.h"

#include <algorithm>
#include <span>
#include <vector>

#include "scenes/json/json_value.h"

namespace trueshade::oracle {

namespace {

using Words = std::span<const std::string_view>;

constexpr std::string_view kSnapRules[] = {"nearest", "nearest_0_6", "toward_zero", "unstated"};
constexpr std::string_view kPlaneOrigins[] = {"snapped", "unsnapped", "either"};
constexpr std::string_view kPlaneForms[] = {"differences", "homogeneous"};
constexpr std::string_view kFillRules[] = {"left_low", "left_high", "unstated", "left_first", "left_last"};
constexpr std::string_view kHalfStores[] = {"toward_zero", "nearest", "either", "through_halves"};
constexpr std::string_view kBlendRules[] = {"any_precision", "float_once", "mesa_codes"};

/// Calls a visitor's member for each field of a profile, in the order of the file. What is read, written and allowed as
/// a key all follows from this table.
///   number(key, field, least, most), flag(key, field), choice(key, field, words), group(key), end()
template <class AnyProfile, class Visitor>
void visit_fields(AnyProfile& p, Visitor& v) {
  constexpr double kTwo = 2, kUlps = 0x1p-10;
  v.number("subpixel_bits", p.subpixel_bits, 4, 16);
  v.choice("snap", p.snap, kSnapRules);
  v.choice("fill", p.fill, kFillRules);
  v.choice("plane_origin", p.plane_origin, kPlaneOrigins);
  v.choice("planes", p.planes, kPlaneForms);
  v.flag("exact_vertices", p.exact_vertices);
  v.flag("exact_planes", p.exact_planes);
  v.flag("clips_to_view", p.clips_to_view);
  v.number("unorm_reach", p.unorm_reach, 0.5, 1);
  v.number("srgb_reach", p.srgb_reach, 0.5, kTwo);
  v.choice("half", p.half, kHalfStores);
  v.number("least_depth_unit", p.least_depth_unit, 1, kTwo);
  v.number("most_depth_unit", p.most_depth_unit, 1, kTwo);
  v.flag("max_norm_slope", p.max_norm_slope);
  v.choice("blend", p.blend, kBlendRules);
  v.number("fetch_error", p.fetch_error, 0, kUlps);
  v.group("sampling");
  v.number("weight_error", p.sampling.weight_error, 0, 1);
  v.number("wide_weight_error", p.sampling.wide_weight_error, 0, 1);
  v.number("nearest_error", p.sampling.nearest_error, 0, 1);
  v.number("lerp_codes", p.sampling.lerp_codes, 0, kTwo);
  v.number("srgb_codes", p.sampling.srgb_codes, 0, kTwo);
  v.flag("decodes_late", p.sampling.decodes_late);
  v.flag("mesa_decode", p.sampling.mesa_decode);
  v.flag("any_scale", p.sampling.any_scale);
  v.number("lod_error", p.sampling.lod_error, 0, 1);
  v.number("relative", p.sampling.relative, 0, kUlps);
  v.end();
  v.group("arithmetic");
  v.number("roundoff", p.arithmetic.roundoff, 0, kUlps);
  v.number("divide", p.arithmetic.divide, 0, kUlps);
  v.number("inverse_sqrt", p.arithmetic.inverse_sqrt, 0, kUlps);
  v.number("square_root", p.arithmetic.square_root, 0, kUlps);
  v.flag("exact_pow", p.arithmetic.exact_pow);
  v.flag("wgsl", p.arithmetic.wgsl);
  v.end();
}

class FieldWriter {
 public:
  explicit FieldWriter(const std::string& name) {
    text_ = "{\n  \"name\": ";
    json::append_string(text_, name);
  }
  template <class Number>
  void number(const char* key, const Number& field, double, double) {
    put(key, json::number_text(double(field)));
  }
  void flag(const char* key, const bool& field) { put(key, field ? "true" : "false"); }
  template <class Enum>
  void choice(const char* key, const Enum& field, Words words) {
    put(key, '"' + std::string(words[size_t(field)]) + '"');
  }
  void group(const char* key) {
    put(key, "{");
    indent_ += "  ", first_ = true;
  }
  void end() {
    indent_.resize(indent_.size() - 2);
    text_ += '\n' + indent_ + '}';
  }
  std::string finished() { return text_ + "\n}\n"; }

 private:
  void put(const char* key, const std::string& value) {
    text_ += (first_ ? "\n" : ",\n") + indent_ + '"' + key + "\": " + value;
    first_ = false;
  }
  std::string text_, indent_ = "  ";
  bool first_ = false;
};

/// Remembers which keys each object may have, and reads those that are there.
class FieldReader {
 public:
  explicit FieldReader(const json::Node& root) {
    objects_.reserve(kMostDepth);  // a node points to the one that it is a member of
    objects_.push_back({root, {"name"}});
  }

  template <class Number>
  void number(const char* key, Number& field, double least, double most) {
    if (const auto node = at(key))
      field = Number(std::is_integral_v<Number> ? double(node->integer(int64_t(least), int64_t(most)))
                                                : node->number(least, most));
  }
  void flag(const char* key, bool& field) {
    if (const auto node = at(key)) field = node->boolean();
  }
  template <class Enum>
  void choice(const char* key, Enum& field, Words words) {
    if (const auto node = at(key)) field = Enum(node->choice(words));
  }
  void group(const char* key) { objects_.push_back({at(key), {}}); }
  void end() {
    check_keys();
    objects_.pop_back();
  }
  void finish() { check_keys(); }

 private:
  static constexpr size_t kMostDepth = 2;
  struct Object {
    std::optional<json::Node> node;
    std::vector<std::string_view> keys;
  };
  std::optional<json::Node> at(const char* key) {
    Object& object = objects_.back();
    object.keys.push_back(key);
    return object.node ? object.node->find(key) : std::nullopt;
  }
  void check_keys() const {
    if (objects_.back().node) objects_.back().node->check_keys({{}, objects_.back().keys});
  }
  std::vector<Object> objects_;
};

}  // namespace

std::string profile_json(const Profile& profile) {
  FieldWriter writer(profile.name);
  visit_fields(profile, writer);
  return writer.finished();
}

Profile profile_from_json(std::string_view text, std::string_view where) {
  const json::Value value = json::parse(text, where);
  const json::Node root(value, where);
  Profile profile;
  FieldReader reader(root);
  visit_fields(profile, reader);
  reader.finish();
  profile.name = root.member("name").string();
  if (profile.name.empty() || profile.name.size() > 100)
    root.member("name").fail("a name of no length, or too long", "1 to 100 bytes");
  if (profile.least_depth_unit > profile.most_depth_unit)
    root.fail("least_depth_unit is above most_depth_unit", "two that are in order");
  return profile;
}

}  // namespace trueshade::oracle
