#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>

#include "core/json_number.h"
#include "core/json_string.h"
#include "judge/diagnosis/plain_program.h"
#include "judge/diagnosis/program_search.h"
#include "judge/diagnosis/supposed_faults.h"
#include "judge/stages/aggregate.h"
#include "scenes/pipeline/transparency.h"

namespace trueshade::oracle {

namespace {

/// A fault's name with the form of its parameter.
std::string listed_name(std::string_view name, const ParameterForm& form) {
  return std::string(name) + (form.any() ? "=" + listed_parameter(form) : "");
}

/// A fault's text with letters in place of its numbers.
std::string listed_text(std::string_view text, const ParameterForm& form) {
  constexpr const char* kVectors[] = {"", "X", "(X, Y)", "(X, Y, Z)"};
  std::string listed(text);
  for (const auto& [mark, word] : {std::pair("%s", "N"), std::pair("%p", "P"), std::pair("%v", kVectors[form.vector])})
    if (const size_t at = listed.find(mark); at != std::string::npos) listed.replace(at, 2, word);
  return listed;
}

/// Whether there is something to explain. A picture that is as its own G-buffer makes it has no fault, though a few of
/// its pixels are not as predicted in doubles.
bool is_suspicious(const StageVerdict& stage) {
  constexpr double kLeastChance = 1e-6 / double(kAggregateTests);
  return !stage.passes() || !least_likely(aggregate_tests(stage)).passes(kLeastChance);
}

/// Joins findings about planes and about the picture, at most `most`: the first of each list, with what belongs to it
/// or is tied with it, then the others. A wrong plane may be why the picture is wrong, so planes come first.
std::vector<Finding> merged(std::vector<Finding> planes, std::vector<Finding> picture, size_t most) {
  const auto first = [](const std::vector<Finding>& list) {
    size_t count = std::min<size_t>(1, list.size());
    while (count < list.size() && (list[count].together || list[count].tied)) ++count;
    return count;
  };
  const size_t of_planes = first(planes), of_picture = first(picture);
  std::vector<Finding> findings;
  const auto add = [&](std::vector<Finding>& list, size_t from, size_t to) {
    for (size_t i = from; i < to && findings.size() < most; ++i) findings.push_back(std::move(list[i]));
  };
  add(planes, 0, of_planes), add(picture, 0, of_picture);
  add(planes, of_planes, planes.size()), add(picture, of_picture, picture.size());
  return findings;
}

/// Joins what explains a picture by a line of its light program (`lines`) and by other faults, at most `most`. What
/// leaves least comes first; among findings that leave as little, lines come first, and fitted ones last.
std::vector<Finding> best_of(std::vector<Finding> lines, std::vector<Finding> others, size_t most) {
  std::vector<Finding> all = std::move(lines);
  const size_t count = all.size();
  for (Finding& f : others) all.push_back(std::move(f));
  // Two faults at once stand one behind the other, and what is tied with the one before it too: they move together.
  std::vector<std::pair<double, std::vector<Finding>>> groups;
  for (size_t i = 0; i < all.size(); ++i) {
    const bool goes_on = i != 0 && i != count && (all[i].together || all[i].tied);
    if (!goes_on) groups.emplace_back();
    const double cost =
        1 - all[i].explained - all[i].located + all[i].contradicted + (all[i].fitted && i < count ? 0.03 : 0);
    groups.back().first = goes_on && !all[i].together ? groups.back().first : cost;
    groups.back().second.push_back(std::move(all[i]));
  }
  const auto half_percents = [](double cost) { return std::lround(200 * cost); };
  std::stable_sort(groups.begin(), groups.end(),
                   [&](const auto& a, const auto& b) { return half_percents(a.first) < half_percents(b.first); });
  std::vector<Finding> out;
  for (auto& [cost, group] : groups)
    for (Finding& f : group)
      if (out.size() < most) out.push_back(std::move(f));
  return out;
}

/// What diagnose() was given of the picture.
struct Shown {
  const Scene& scene;
  const Pipeline& pipeline;
  const Profile& profile;
  const Capture& capture;
  const StageVerdict& stage;
};

/// The picture, to be compared with what a light pass makes of its G-buffer. The pass reads the scene as asked, the
/// scene that the likeliest fault of the planes draws, or the planes before they were written wrongly: whichever leaves
/// the fewest pixels wrong.
std::unique_ptr<PictureCase> picture_of(const Shown& s, const PlaneFindings& planes) {
  auto picture = std::make_unique<PictureCase>(s.scene, s.pipeline, s.profile, s.capture, s.stage);
  const auto try_other = [&](std::unique_ptr<PictureCase> other) {
    if (changed_pixels(*other) < changed_pixels(*picture)) picture = std::move(other);
  };
  if (planes.drawn != nullptr)
    try_other(std::make_unique<PictureCase>(*planes.drawn, s.pipeline, s.profile, s.capture, s.stage));
  if (planes.expected == nullptr) return picture;
  auto healed = std::make_unique<PictureCase>(*picture);
  healed->heal(planes.expected, planes.wrong);
  try_other(std::move(healed));
  return picture;
}

/// Judges a change of the light program with a light that is missing besides, by the whole sample. Where both together
/// explain nine tenths of what is wrong, the two take the place of what single lines explain.
void add_missing_light(const Shown& s, const PlaneFindings& planes, ProgramFindings& lines) {
  constexpr double kBothExplain = 0.9;
  const std::unique_ptr<PictureCase> picture = picture_of(s, planes);
  const double changed = changed_pixels(*picture);
  for (const SlipBesideLight& pair : lines.beside) {
    const std::vector<std::string> name = {"light-missing=" + std::to_string(pair.light)};
    const SupposedFaults missing = supposed_faults(name, s.scene);
    PictureCase rest = *picture;
    rest.draw_by(std::make_shared<const PlainProgram>(s.scene, s.pipeline, pair.drawn_by));
    const double share =
        changed_pixels(rest) / std::max(changed, 1.0);  // of what is wrong, that the light must explain
    const std::vector<Finding> both = picture_findings(rest, missing.picture),
                               alone = picture_findings(*picture, missing.picture);
    if (both.empty()) continue;
    Finding second = both[0];
    second.explained = 1 - share * (1 - second.explained), second.left *= share;
    if (!(second.explained - second.contradicted > kBothExplain)) continue;
    second.changed = pair.slip.changed, second.together = second.proof.by_both = true;
    second.alone = alone.empty() ? 0 : alone[0].explained;
    Finding slip = pair.slip;
    if (slip.proof.plane.empty()) slip.proof = second.proof;  // no pixel shows it by itself
    lines.findings = {std::move(slip), std::move(second)};
    return;
  }
}

/// Whether one of the findings is that small floats are rounded by another rule than the pipeline's. It is no fault
/// where the profile allows both rules.
bool rounds_otherwise(std::span<const Finding> findings) {
  return std::any_of(findings.begin(), findings.end(),
                     [](const Finding& f) { return f.name == "store-nearest" || f.name == "store-truncated"; });
}

/// The pipeline with the other rule of rounding small floats.
Pipeline rounding_otherwise(Pipeline pipeline) {
  HalfRound& rule = pipeline.gbuffer.half_round;
  rule = rule == HalfRound::nearest ? HalfRound::toward_zero : HalfRound::nearest;
  return pipeline;
}

/// How well the first finding explains the picture; 0 where there is none.
double first_score(const std::vector<Finding>& findings) {
  return findings.empty() ? 0 : findings[0].explained - findings[0].contradicted;
}

/// Inserts the findings about glass: before the others if more pixels are wrong under glass than the first of the
/// others is about, else behind them.
void add_glass(std::vector<Finding> glass, std::vector<Finding>& findings) {
  const bool first = !glass.empty() && (findings.empty() || glass[0].changed > findings[0].changed);
  findings.insert(first ? findings.begin() : findings.end(), glass.begin(), glass.end());
}

/// Marks as partial, and puts last, each finding that leaves most of what is wrong unexplained, or pixels far off. Two
/// faults at once are measured together. Predictions of a picture and of what is drawn again are exact, so hardly a
/// pixel may be far off; those of planes are as exact as interpolation.
std::vector<Finding> partial_last(std::vector<Finding> findings) {
  constexpr double kExplanation = 0.5, kOfFitted = 0.75, kLeftWhereExact = 0.005, kLeftOfPlanes = 0.05;
  std::vector<Finding> partial, whole;
  for (size_t from = 0; from < findings.size();) {
    size_t end = from + 1;
    while (end < findings.size() && findings[end].together) ++end;
    const bool fitted = std::any_of(findings.begin() + ptrdiff_t(from), findings.begin() + ptrdiff_t(end),
                                    [](const Finding& f) { return f.fitted; });
    const Finding& last = findings[end - 1];
    const bool is_partial =
        last.explained + last.located < (fitted ? kOfFitted : kExplanation) ||
        last.left > (last.plane == "picture" || last.drawn_again ? kLeftWhereExact : kLeftOfPlanes) ||
        last.astray > kLeftWhereExact;
    for (; from < end; ++from) {
      findings[from].partial = is_partial;
      (is_partial ? partial : whole).push_back(std::move(findings[from]));
    }
  }
  whole.insert(whole.end(), std::make_move_iterator(partial.begin()), std::make_move_iterator(partial.end()));
  return whole;
}

/// Leaves out rivals of what explains all: findings about the same plane that explain less, with what is said together
/// with them.
std::vector<Finding> without_beaten(std::vector<Finding> findings) {
  constexpr double kAll = 0.995, kLess = 0.02;
  std::vector<Finding> out;
  for (size_t from = 0; from < findings.size();) {
    size_t end = from + 1;
    while (end < findings.size() && findings[end].together) ++end;
    const auto score = [](const Finding& f) { return f.explained + f.located - f.contradicted; };
    const Finding& last = findings[end - 1];
    const bool is_beaten = std::any_of(out.begin(), out.end(), [&](const Finding& f) {
      return !f.partial && f.plane == last.plane && score(f) > kAll && score(last) < score(f) - kLess;
    });
    for (; from < end; ++from)
      if (!is_beaten) out.push_back(std::move(findings[from]));
  }
  return out;
}

/// The members of a finding about a line of a light program; empty of others.
std::string line_json(const Finding& f) {
  if (f.line == 0) return {};
  return ",\"line\":" + std::to_string(f.line) + ",\"it_reads\":" + json_string(f.it_reads) +
         ",\"drawn_as\":" + json_string(f.drawn_as);
}

}  // namespace

std::vector<Finding> diagnose(const Scene& scene, const Pipeline& asked, const Profile& profile, const Capture& capture,
                              std::span<const StageVerdict> stages, std::span<const std::string> supposed,
                              size_t most) {
  Pipeline pipeline = asked;
  pipeline.gbuffer = surface_planes(asked);
  const SupposedFaults only = supposed_faults(supposed, scene);
  const auto stage_of = [&](std::initializer_list<std::string_view> names) -> const StageVerdict* {
    for (const StageVerdict& s : stages)
      if (std::find(names.begin(), names.end(), s.stage) != names.end()) return &s;
    return nullptr;
  };
  const StageVerdict *surfaces = stage_of({"gbuffer"}), *lit = stage_of({"lighting", "blending"});
  PlaneFindings planes;
  if (surfaces != nullptr && (supposed.empty() || !only.planes.empty()) &&
      (!supposed.empty() || surfaces->count(PixelClass::violation) > 0))
    planes = plane_findings(scene, pipeline, profile, capture, *surfaces, only.planes);
  std::vector<Finding> findings;
  const bool asks_lit = supposed.empty() || !only.picture.empty() || !only.glass.empty();
  ProgramFindings by_lines;
  std::vector<Finding>& lines = by_lines.findings;
  if (pipeline.light_program.used() && lit != nullptr && supposed.empty())
    by_lines = program_findings(scene, pipeline, profile, capture, *lit, most);
  const bool told = !lines.empty() && !lines[0].fitted && lines[0].explained > 0.995 && lines[0].contradicted < 0.005;
  const auto findings_under = [&](const Pipeline& stored_so) {
    const Shown shown{scene, stored_so, profile, capture, *lit};
    const std::unique_ptr<PictureCase> picture = picture_of(shown, planes);
    std::vector<Finding> found;
    if (supposed.empty() || !only.picture.empty()) found = picture_findings(*picture, only.picture);
    const bool glazed =
        draws_transparent(scene, stored_so) && stored_so.transparency.mode == TransparencyMode::after_lights;
    const StageVerdict* over = stage_of({"transparency"});
    if (glazed && (supposed.empty() || !only.glass.empty()))
      add_glass(
          glass_findings(scene, stored_so, profile, capture, over != nullptr ? *over : *lit, *picture, only.glass),
          found);
    return found;
  };
  if (!told && lit != nullptr && asks_lit && (!supposed.empty() || is_suspicious(*lit))) {
    findings = findings_under(pipeline);
    const bool allows_either = profile.half == HalfStore::either && !profile.exact_planes;
    if (allows_either && info(pipeline.target).small_float() && (!supposed.empty() || rounds_otherwise(findings))) {
      std::vector<Finding> others = findings_under(rounding_otherwise(pipeline));
      const bool is_all =
          supposed.empty() && rounds_otherwise(std::span(findings).first(std::min<size_t>(1, findings.size())));
      if (is_all || first_score(others) > first_score(findings)) findings = std::move(others);
    }
  }
  if (!by_lines.beside.empty()) add_missing_light({scene, pipeline, profile, capture, *lit}, planes, by_lines);
  if (!lines.empty()) findings = best_of(std::move(lines), std::move(findings), most);
  findings = merged(std::move(planes.findings), std::move(findings), most);
  return supposed.empty() ? without_beaten(partial_last(std::move(findings))) : findings;
}

std::vector<KnownFault> known_faults() {
  std::vector<KnownFault> faults;
  for (const auto table : {picture_value_faults(), light_faults()})
    for (const PictureFault& f : table)
      faults.push_back({listed_name(f.name, f.form()), "picture", listed_text(f.text, f.form())});
  for (const auto table :
       {plane_faults(), gloss_faults(), redraw_faults(), object_faults(), camera_faults(), material_faults()})
    for (const PlaneFault& f : table)
      faults.push_back(
          {listed_name(f.name, f.form()), std::string(kPlaneNames[size_t(f.plane)]), listed_text(f.text, f.form())});
  for (const GlassFault& f : glass_faults())
    faults.push_back({listed_name(f.name, f.form()), "picture", listed_text(f.text, f.form())});
  return faults;
}

std::string findings_json(std::span<const Finding> findings) {
  std::string json = "[";
  for (const Finding& f : findings) {
    if (json.size() > 1) json += ",";
    json +=
        "{\"name\":" + json_string(f.name) + ",\"plane\":" + json_string(f.plane) + ",\"text\":" + json_string(f.text) +
        ",\"changed\":" + std::to_string(f.changed) + ",\"explained\":" + json_in_nine_digits(f.explained) +
        ",\"contradicted\":" + json_in_nine_digits(f.contradicted) +
        ",\"together\":" + (f.together ? "true" : "false") + ",\"alone\":" + json_in_nine_digits(f.alone) +
        ",\"located\":" + json_in_nine_digits(f.located) + ",\"left\":" + json_in_nine_digits(f.left) +
        ",\"tied\":" + (f.tied ? "true" : "false") + ",\"proof\":{\"x\":" + std::to_string(f.proof.x) +
        ",\"y\":" + std::to_string(f.proof.y) + ",\"plane\":" + json_string(f.proof.plane) +
        ",\"given\":" + json_in_nine_digits(f.proof.given) + ",\"right\":" + json_in_nine_digits(f.proof.right) +
        ",\"predicted\":" + json_in_nine_digits(f.proof.predicted) +
        ",\"by_both\":" + (f.proof.by_both ? "true" : "false") +
        ",\"anything\":" + (f.proof.anything ? "true" : "false") + "},\"partial\":" + (f.partial ? "true" : "false") +
        line_json(f) + ",\"command\":" + json_string(f.command) + "}";
  }
  return json + "]";
}

}  // namespace trueshade::oracle
