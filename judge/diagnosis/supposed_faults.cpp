#include "judge/diagnosis/supposed_faults.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/error.h"
#include "core/likeliest_name.h"
#include "judge/diagnosis/finding.h"

namespace trueshade::oracle {

namespace {

/// What a parameter may be.
struct ParameterRange {
  double low = 0, high = 0;
  bool whole = false;
};

/// What a fault whose name ends with `ending` takes as its parameter. A fault that has values to try, and no such row,
/// takes no others.
struct NamedRange {
  std::string_view ending;
  ParameterRange range;
};
constexpr double kMostShift = 16384, kMostNumbers = 65535;
constexpr NamedRange kRanges[] = {
    {"-shift-x", {-kMostShift, kMostShift, true}},
    {"-shift-y", {-kMostShift, kMostShift, true}},
    {"picture-bits", {1, 7, true}},
    {"picture-offset", {-255, 255}},
    {"-alpha", {0, 1}},
    {"depth-bits", {1, 32, true}},
    {"normal-bits", {1, 32, true}},
    {"normal-octahedral-halved", {0, 1}},
    {"object-offset", {-kMostNumbers, kMostNumbers, true}},
    {"material-offset", {-kMostNumbers, kMostNumbers, true}},
    {"texture-lod-bias", {-16, 16}},
    {"polygon-offset", {-1000, 1000}},
    {"lighting-normal-rounded", {1, kMostNumbers, true}},
};
constexpr ParameterRange kAnyFactor{0.001, 1000}, kAnyDepth{-1e9, 1e9};

/// An Error(usage) about one of the names.
Error refused(const std::string& name, const std::string& reason, const std::string& remedy) {
  return {ErrorKind::usage, "--suppose", "'" + name + "' " + reason, remedy};
}
/// The Error of a name that no fault has, with a name that is like it.
Error no_fault(const std::string& name) {
  if (name.starts_with("light-shader-"))
    return refused(name, "cannot be supposed: slips of a light program are looked for without it", "leave it out");
  std::vector<std::string> known;
  for (const KnownFault& fault : known_faults()) known.push_back(fault.name);
  return refused(
      name, "is no fault that is known",
      did_you_mean(name.substr(0, name.find('=')), known) + "`trueshade list` names them; a parameter follows `=`");
}

template <class Fault>
const Fault* fault_named(std::string_view name, std::initializer_list<std::span<const Fault>> tables) {
  for (const auto table : tables)
    for (const Fault& f : table)
      if (f.name == name) return &f;
  return nullptr;
}

/// The indices of so many things.
ParameterRange numbers_of(size_t count) { return {0, double(count) - 1, true}; }

/// What the search looks for, where that says it; otherwise a range that is empty.
ParameterRange range_sought(const PictureFault& fault, const Scene& scene) {
  switch (fault.search) {
    case Search::smooth:
      return kAnyFactor;
    case Search::missing_light:
    case Search::doubled_light:
      return numbers_of(scene.lights.size());
    case Search::count:
    case Search::count_at_pixel:
      return numbers_of(scene.lights.size() + 1);
    case Search::none:
    case Search::one_of:
    case Search::one_light:  // several_numbers() reads it
    case Search::vector:
      break;
  }
  return {1, 0};
}
ParameterRange range_sought(const PlaneFault& fault, const Scene& scene) {
  if (fault.search == PlaneFault::Search::smooth) return kAnyFactor;
  if (fault.search == PlaneFault::Search::object) return numbers_of(scene.instances.size());
  return fault.search == PlaneFault::Search::depth_offset ? kAnyDepth : ParameterRange{1, 0};
}

template <class Fault>
const ParameterRange* range_listed(const Fault& fault) {
  for (const NamedRange& row : kRanges)
    if (fault.says == nullptr && fault.name.ends_with(row.ending)) return &row.range;
  return nullptr;
}

std::string text_of(const ParameterRange& range) {
  if (range.high < range.low) return "nothing here: the scene has none";
  return std::string(range.whole ? "a whole number from " : "a number from ") + parameter_text(range.low) + " to " +
         parameter_text(range.high);
}

/// The parameter that a text states: a number, or a word that the fault has for one. Error(usage) where the text is
/// missing (null), or states no parameter that the fault takes.
template <class Fault>
double parameter_of(const Fault& fault, const Scene& scene, const std::string* text, const std::string& name) {
  char* end = nullptr;
  const double number = text != nullptr ? std::strtod(text->c_str(), &end) : 0;
  const bool is_number = text != nullptr && !text->empty() && end == text->c_str() + text->size();
  const auto refuse = [&](const std::string& taken) {
    return refused(name, text == nullptr ? "needs its parameter after `=`" : "has a parameter that it does not take",
                   std::string(fault.name) + " takes " + taken);
  };
  const ParameterRange* listed = range_listed(fault);
  if (fault.search == decltype(fault.search)::one_of && listed == nullptr) {
    std::string words;
    for (const double start : fault.starts) {
      const std::string word = parameter_word(fault, start);
      if ((text != nullptr && word == *text) || (is_number && number == start)) return start;
      words += (words.empty() ? "" : ", ") + word;
    }
    throw refuse(words);
  }
  const ParameterRange range = listed != nullptr ? *listed : range_sought(fault, scene);
  const bool in_range = number >= range.low && number <= range.high;  // not a number: no
  if (is_number && in_range && (!range.whole || number == std::floor(number))) return number;
  throw refuse(text_of(range));
}

/// Whether a number is an index of so many things; false of NaN.
bool names_one(double index, size_t count) { return index >= 0 && index == std::floor(index) && index < double(count); }
bool can_be(const PictureFault& fault, const Scene& scene, const FaultParameter& p) {
  if (fault.search == Search::vector) return true;
  return names_one(p.number, scene.lights.size()) && fault.of_light(scene.lights[size_t(p.number)]);
}
/// Whether there is such an object with such a part, and the fault changes it.
bool can_be(const PlaneFault& fault, const Scene& scene, const FaultParameter& p) {
  const ParameterForm form = fault.form();
  const size_t count = fault.of == PlaneFault::Of::material ? scene.materials.size() : scene.instances.size();
  if (form.number && !names_one(p.number, count)) return false;
  if (form.part && !(p.part >= 0 && p.part == std::floor(p.part))) return false;
  return true;
}

bool can_be(const GlassFault&, const Scene& scene, const FaultParameter& p) {
  return names_one(p.number, scene.instances.size());
}

/// The parameter that a text such as `3:0.5,0,-1` states: a light or an object that the fault can be of, and the
/// fault's own numbers. Error(usage) where the text is missing (null), or states no such parameter.
template <class Fault>
FaultParameter several_numbers(const Fault& fault, const Scene& scene, const std::string* text,
                               const std::string& name) {
  const ParameterForm form = fault.form();
  const std::optional<FaultParameter> parameter = text == nullptr ? std::nullopt : parameter_of_name(form, *text);
  if (parameter && can_be(fault, scene, *parameter)) return *parameter;
  throw refused(name, text == nullptr ? "needs its parameter after `=`" : "has a parameter that it does not take",
                std::string(fault.name) + " takes " + listed_parameter(form) +
                    (form.number ? ", the first a number of what it can be of" : ""));
}

/// Whether a fault has other numbers than the one that parameter_of() reads.
bool has_several(const PictureFault& fault) {
  return fault.search == Search::one_light || fault.search == Search::vector;
}
bool has_several(const PlaneFault& fault) { return fault.search == PlaneFault::Search::suspected; }

/// Adds a fault with the parameter that `text` states; false, and nothing added, where `fault` is null. Error(usage)
/// for a parameter that the fault does not take.
template <class Named, class Fault>
bool add_supposed(std::vector<Named>& to, const Fault* fault, const Scene& scene, const std::string* text,
                  const std::string& name) {
  if (fault == nullptr) return false;
  const bool none = !fault->form().any();
  if (none && text != nullptr) throw refused(name, "has a parameter", std::string(fault->name) + " takes none");
  if constexpr (!std::is_same_v<Fault, GlassFault>)
    if (!none && !has_several(*fault)) {
      to.push_back({fault, parameter_of(*fault, scene, text, name)});
      return true;
    }
  to.push_back({fault, none ? FaultParameter() : several_numbers(*fault, scene, text, name)});
  return true;
}

}  // namespace

SupposedFaults supposed_faults(std::span<const std::string> names, const Scene& scene) {
  SupposedFaults out;
  for (const std::string& name : names) {
    const size_t equals = name.find('=');
    const bool given = equals != std::string::npos;
    const std::string_view bare = std::string_view(name).substr(0, equals);
    const std::string after = given ? name.substr(equals + 1) : "";
    const std::string* text = given ? &after : nullptr;
    const auto* picture = fault_named<PictureFault>(bare, {picture_value_faults(), light_faults()});
    const auto* plane = fault_named<PlaneFault>(
        bare, {plane_faults(), gloss_faults(), redraw_faults(), object_faults(), camera_faults(), material_faults()});
    const auto* glass = fault_named<GlassFault>(bare, {glass_faults()});
    if (!add_supposed(out.picture, picture, scene, text, name) && !add_supposed(out.planes, plane, scene, text, name) &&
        !add_supposed(out.glass, glass, scene, text, name))
      throw no_fault(name);
  }
  return out;
}

}  // namespace trueshade::oracle
