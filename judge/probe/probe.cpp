#include "judge/probe/probe.h"

#include <algorithm>
#include <functional>

#include "judge/stages/judge.h"
#include "scenes/json/json_value.h"

namespace trueshade::oracle {

namespace {

/// Which frames a field is told by, and by which of their stages.
enum class TellsBy : uint8_t {
  surfaces,  ///< the G-buffer of every frame
  maps,      ///< the G-buffer of frames with maps
  light,     ///< the target of frames that sum their lights in a loop
  blending,  ///< the target after each light
  all
};

struct ProbeValue {
  std::string text;
  std::function<void(Profile&)> set;
};

/// A field, or fields that go together, and the values that it may have.
///   exclusive: no value allows all that another value allows. Where two values explain every frame, the field stays
///     unknown. Otherwise the tightest value comes first, and each value allows all that the value before it allows.
///   least_is_real: a driver may have the first value. Otherwise no driver has it, and where it explains every frame,
///     the frames do not tell the field.
struct ProbeKnob {
  std::string field;
  TellsBy by;
  bool exclusive;
  std::vector<ProbeValue> values;
  bool least_is_real = false;
};

bool has_maps(const ProbeFrame& frame) { return !frame.plan->scene.textures.empty(); }

bool is_told_by(const ProbeFrame& frame, TellsBy by) {
  const bool blends = blends_lights(frame.plan->pipeline.strategy);
  switch (by) {
    case TellsBy::surfaces:
      return !blends && !has_maps(frame);
    case TellsBy::maps:
      return has_maps(frame);
    case TellsBy::light:
      return !blends && !has_maps(frame);
    case TellsBy::blending:
      return blends;
    case TellsBy::all:
      return true;
  }
  return false;
}

bool looks_at_lights(TellsBy by) { return by != TellsBy::surfaces && by != TellsBy::maps; }

bool is_explained(const ProbeFrame& frame, const Profile& profile, TellsBy by) {
  const Scene& scene = frame.plan->scene;
  const Pipeline& pipeline = frame.plan->pipeline;
  const auto none = [](const StageVerdict& v) { return v.count(PixelClass::violation) == 0; };
  if (by != TellsBy::blending && !none(gbuffer_violations(scene, pipeline, profile, frame.capture, {}, nullptr)))
    return false;
  if (!looks_at_lights(by)) return true;
  if (frame.steps) return none(judge_blending(scene, pipeline, profile, frame.capture, frame.steps));
  return none(lighting_violations(scene, pipeline, profile, frame.capture, {}, nullptr));
}

/// A knob for a field that is a number. `values` has the tightest value first.
ProbeKnob numbers(const char* field, TellsBy by, double Profile::*member, std::initializer_list<double> values,
                  bool least_is_real = false) {
  ProbeKnob knob{field, by, false, {}, least_is_real};
  for (const double v : values)
    knob.values.push_back({json::number_text(v), [member, v](Profile& p) { p.*member = v; }});
  return knob;
}
template <class Part>
ProbeKnob numbers(const char* field, TellsBy by, Part Profile::*part, double Part::*member,
                  std::initializer_list<double> values, bool least_is_real = false) {
  ProbeKnob knob{field, by, false, {}, least_is_real};
  for (const double v : values)
    knob.values.push_back({json::number_text(v), [part, member, v](Profile& p) { (p.*part).*member = v; }});
  return knob;
}

/// A knob for a field whose values exclude each other: what a profile's file calls a value, and a function that sets
/// it.
template <class Setter>
ProbeKnob choice(const char* field, TellsBy by, std::initializer_list<std::pair<const char*, Setter>> values) {
  ProbeKnob knob{field, by, true, {}};
  for (const auto& [text, set] : values) knob.values.push_back({text, set});
  return knob;
}

using Set = void (*)(Profile&);

ProbeKnob grid() {
  ProbeKnob knob{"subpixel_bits, snap", TellsBy::surfaces, false, {}};
  // A grid that is too fine or too coarse is refuted; toward zero is a guess that GPUs are not known to make.
  for (const int bits : {16, 12, 10, 8, 6, 5, 4})
    knob.values.push_back({std::to_string(bits) + ", nearest",
                           [bits](Profile& p) { p.subpixel_bits = bits, p.snap = SnapRule::nearest; }});
  for (const int bits : {8, 4})
    knob.values.push_back({std::to_string(bits) + ", nearest_0_6",
                           [bits](Profile& p) { p.subpixel_bits = bits, p.snap = SnapRule::nearest_0_6; }});
  return knob;
}

constexpr double kUlp = 0x1p-23;

/// All knobs in the order in which they are measured: each with the values found for those before it.
std::vector<ProbeKnob> probe_knobs() {
  using enum TellsBy;
  constexpr auto kArithmetic = &Profile::arithmetic;
  constexpr auto kSampling = &Profile::sampling;
  return {
      {"planes",
       surfaces,
       false,
       {{"differences", [](Profile& p) { p.planes = PlaneForm::differences; }},
        {"homogeneous", [](Profile& p) { p.planes = PlaneForm::homogeneous; }}},
       true},
      grid(),
      choice<Set>("fill", surfaces,
                  {{"left_low", [](Profile& p) { p.fill = FillRule::left_low; }},
                   {"left_high", [](Profile& p) { p.fill = FillRule::left_high; }},
                   {"left_first", [](Profile& p) { p.fill = FillRule::left_first; }},
                   {"left_last", [](Profile& p) { p.fill = FillRule::left_last; }}}),
      choice<Set>("plane_origin", surfaces,
                  {{"snapped", [](Profile& p) { p.plane_origin = PlaneOrigin::snapped; }},
                   {"unsnapped", [](Profile& p) { p.plane_origin = PlaneOrigin::unsnapped; }}}),
      choice<Set>("least_depth_unit, most_depth_unit", surfaces,
                  {{"1, 1", [](Profile& p) { p.least_depth_unit = p.most_depth_unit = 1; }},
                   {"1.0099, 1.0101", [](Profile& p) { p.least_depth_unit = 1.0099, p.most_depth_unit = 1.0101; }},
                   {"2, 2", [](Profile& p) { p.least_depth_unit = p.most_depth_unit = 2; }}}),
      numbers("arithmetic.roundoff", all, kArithmetic, &Arithmetic::roundoff, {0, 0.5 * kUlp, kUlp}),
      choice<Set>("half", all,
                  {{"toward_zero", [](Profile& p) { p.half = HalfStore::toward_zero; }},
                   {"nearest", [](Profile& p) { p.half = HalfStore::nearest; }},
                   {"through_halves", [](Profile& p) { p.half = HalfStore::through_halves; }}}),
      choice<Set>("blend", blending,
                  {{"float_once", [](Profile& p) { p.blend = BlendRule::float_once; }},
                   {"mesa_codes", [](Profile& p) { p.blend = BlendRule::mesa_codes; }}}),
      numbers("unorm_reach", light, &Profile::unorm_reach, {0.45, 0.5, 0.55, 0.6, 0.75, 1}),
      numbers("srgb_reach", light, &Profile::srgb_reach, {0.45, 0.5, 0.52, 0.55, 0.6, 0.67, 0.75, 0.85, 1}),
      numbers("fetch_error", light, &Profile::fetch_error, {0, 0.5 * kUlp, kUlp, 1.25 * kUlp, 2.5 * kUlp}),
      numbers("arithmetic.divide", light, kArithmetic, &Arithmetic::divide, {0, 0.5 * kUlp, kUlp, 2.5 * kUlp}),
      numbers("arithmetic.inverse_sqrt", light, kArithmetic, &Arithmetic::inverse_sqrt,
              {0, 0.5 * kUlp, kUlp, 1.5 * kUlp, 2 * kUlp}),
      numbers("arithmetic.square_root", light, kArithmetic, &Arithmetic::square_root,
              {0, 0.5 * kUlp, kUlp, 2.5 * kUlp, 4.5 * kUlp}),
      numbers("sampling.weight_error", maps, kSampling, &Sampling::weight_error,
              {0, 0x1p-12, 0x1p-10, 0x1p-9, 0x1p-8, 0x1p-7}, true),
      numbers("sampling.wide_weight_error", maps, kSampling, &Sampling::wide_weight_error,
              {0, 0x1p-20, 0x1p-12, 0x1p-10, 0x1p-9, 0x1p-8, 0x1p-7}, true),
      numbers("sampling.lerp_codes", maps, kSampling, &Sampling::lerp_codes, {0, 0.5, 1}, true),
      choice<Set>("sampling.mesa_decode", maps,
                  {{"true", [](Profile& p) { p.sampling.mesa_decode = true, p.sampling.srgb_codes = 0.1; }},
                   {"false", [](Profile& p) { p.sampling.mesa_decode = false, p.sampling.srgb_codes = 0.1; }}}),
      numbers("sampling.srgb_codes", maps, kSampling, &Sampling::srgb_codes,
              {0x1p-10, 0x1p-8, 0x1p-6, 0.05, 0.1, 0.35, 0.5}, true),
      numbers("sampling.lod_error", maps, kSampling, &Sampling::lod_error,
              {0, 0x1p-10, 0x1p-8, 0x1p-7, 0x1p-6, 0.045, 0.05}),
      numbers("sampling.relative", maps, kSampling, &Sampling::relative, {0, kUlp, 2 * kUlp, 4 * kUlp, 8 * kUlp}),
  };
}

/// Measures one knob after the other, with the rest of the profile as it is known so far.
class Probe {
 public:
  Probe(std::vector<const ProbeFrame*> frames, Profile known) : frames_(std::move(frames)), known_(std::move(known)) {}

  void tell(const ProbeKnob& knob) {
    ProbedField out{knob.field, "unknown", ProbedField::State::open, 0, {}};
    std::vector<const ProbeValue*> hold;
    for (const ProbeValue& value : knob.values) {
      ++out.tried;
      const std::string against = frame_against(knob, value);
      if (against.empty()) hold.push_back(&value);
      if (!against.empty()) out.against = against;
      if (against.empty() && !knob.exclusive) break;
    }
    const bool told =
        hold.size() == 1 && (knob.exclusive || knob.least_is_real || hold.front() != &knob.values.front());
    if (told) {
      hold.front()->set(known_);
      out.value = hold.front()->text, out.state = ProbedField::State::told;
    } else if (hold.empty()) {
      out.state = ProbedField::State::refuted;
    }
    fields_.push_back(std::move(out));
  }

  ProbeResult result(const std::string& name) && {
    known_.name = name;
    return {std::move(known_), std::move(fields_), {}};
  }

 private:
  /// The name of a frame that the profile with this value does not explain; empty where it explains all. Begins with
  /// the frame that spoke against a value last.
  std::string frame_against(const ProbeKnob& knob, const ProbeValue& value) {
    Profile guess = known_;
    value.set(guess);
    for (size_t i = 0; i < frames_.size(); ++i) {
      const ProbeFrame& frame = *frames_[(last_against_ + i) % frames_.size()];
      if (!is_told_by(frame, knob.by) || is_explained(frame, guess, knob.by)) continue;
      last_against_ = (last_against_ + i) % frames_.size();
      return frame.plan->name;
    }
    return {};
  }

  const std::vector<const ProbeFrame*> frames_;
  Profile known_;
  std::vector<ProbedField> fields_;
  size_t last_against_ = 0;
};

}  // namespace

ProbeResult probe_profile(const std::vector<ProbeFrame>& frames, const std::string& name) {
  std::vector<const ProbeFrame*> legal;
  std::vector<std::string> set_aside;
  Profile widest;
  widest.planes = PlaneForm::homogeneous;
  for (const ProbeFrame& frame : frames) {
    if (is_explained(frame, widest, TellsBy::all))
      legal.push_back(&frame);
    else
      set_aside.push_back(frame.plan->name);
  }
  Probe probe(std::move(legal), Profile{});
  for (const ProbeKnob& knob : probe_knobs()) probe.tell(knob);
  ProbeResult result = std::move(probe).result(name);
  result.set_aside = std::move(set_aside);
  return result;
}

ProbeCheck check_profile(const ProbeFrame& frame, const Profile& profile) {
  const Scene& scene = frame.plan->scene;
  const Pipeline& pipeline = frame.plan->pipeline;
  ProbeCheck out{frame.plan->name};
  const auto add = [&out](const StageVerdict& v) {
    out.pixels += v.classes.size();
    out.exact += v.count(PixelClass::exact), out.violations += v.count(PixelClass::violation);
  };
  add(judge_gbuffer(scene, pipeline, profile, frame.capture));
  if (frame.steps)
    add(judge_blending(scene, pipeline, profile, frame.capture, frame.steps));
  else
    add(judge_lighting(scene, pipeline, profile, frame.capture));
  return out;
}

}  // namespace trueshade::oracle
