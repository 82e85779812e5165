#include "view/script.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/error.h"
#include "core/fp_env.h"
#include "scenes/pipeline/presets.h"
#include "scenes/scene.h"
#include "shading/output/target.h"
#include "view/keys.h"
#include "view/session.h"

namespace trueshade::viewer {
namespace {

constexpr ScriptCommand kCommands[] = {
    {"wait", "SECONDS", "goes on as it is for so long"},
    {"still", "", "waits until the newest picture is shown and its hash is known"},
    {"key", "KEY SECONDS", "holds a key down"},
    {"press", "KEY", "presses a key"},
    {"look", "DEGREES DEGREES", "looks right and up"},
    {"orbit", "DEGREES DEGREES", "goes round what is looked at, to the right and up"},
    {"wheel", "STEPS", "turns the wheel: flies faster"},
    {"camera", "X Y Z X Y Z", "stands at a point and looks at another"},
    {"home", "", "takes the scene's own camera"},
    {"preset", "PRESET", "draws by another preset"},
    {"strategy", "STRATEGY", "draws by another strategy"},
    {"view", "VIEW", "shows another view"},
    {"target", "TARGET", "stores the picture in another format"},
    {"exposure", "STOPS", "gives every light twice its brightness for each stop"},
    {"time", "SECONDS", "shows another time"},
    {"play", "", "lets the time pass"},
    {"pause", "", "stops it"},
    {"model", "MODEL", "draws by a light model: one that ships, the file of --light-shader, or none"},
    {"light-parameter", "NAME=VALUE", "gives a parameter of the light model another value"},
    {"light", "INDEX SWITCH", "turns a light on or off"},
    {"light-color", "INDEX R G B", "gives a light another colour"},
    {"light-intensity", "INDEX NUMBER", "multiplies a light's colour"},
    {"light-position", "INDEX X Y Z", "puts a light elsewhere"},
    {"reset-lights", "", "takes all changes of lights back"},
    {"click", "X Y", "clicks at a point of the window, with the left button"},
    {"drag", "X Y X Y SECONDS", "drags from a point to another, with the left button"},
    {"panel", "PANEL", "opens a panel, or none"},
    {"size", "PIXELS PIXELS", "makes the window this wide and high"},
    {"save", "FILE", "saves the picture (.png, .exr) or the scene (.json)"},
    {"screenshot", "FILE", "saves what the window shows, panels too, as .png"},
    {"hash", "", "prints the picture's hash, as render --hash does"},
    {"explanation", "", "prints what is known of the clicked pixel, as explain does"},
    {"measure", "", "counts and times pictures from here on"},
    {"report", "FILE", "writes what was measured as JSON"},
    {"quit", "", "closes the window"},
};

class Line {
 public:
  Line(std::string_view text, const std::string& where, int number) : rest_(text), where_(where), number_(number) {}

  [[noreturn]] void fail(const std::string& reason, const std::string& remedy) const {
    throw Error(ErrorKind::bad_input, where_ + ": line " + std::to_string(number_), reason, remedy);
  }
  std::string word() {
    skip_blanks();
    const size_t end = std::min(rest_.find_first_of(" \t"), rest_.size());
    const std::string word(rest_.substr(0, end));
    rest_.remove_prefix(end);
    return word;
  }
  /// The name of a key, which may be two words: `left shift`.
  std::string key() {
    const std::string first = word();
    const std::string_view behind = rest_;
    const std::string both = first + ' ' + word();
    if (!key_named(first) && key_named(both)) return both;
    rest_ = behind;
    return first;
  }
  std::string rest() {
    skip_blanks();
    const size_t end = rest_.find_last_not_of(" \t");
    return std::string(std::exchange(rest_, {}).substr(0, end + 1));  // npos + 1 is 0
  }

 private:
  void skip_blanks() { rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t"), rest_.size())); }

  std::string_view rest_;
  const std::string& where_;
  int number_;
};

bool is_number(std::string_view kind) {
  for (const std::string_view number :
       {"SECONDS", "X", "Y", "Z", "R", "G", "B", "STOPS", "STEPS", "DEGREES", "PIXELS", "INDEX", "NUMBER"})
    if (kind == number) return true;
  return false;
}

struct Range {
  double least, most;
};

Range range_of(std::string_view kind, std::string_view command) {
  if (kind == "SECONDS") return command == "time" ? Range{-kLatestTime, kLatestTime} : Range{0.0, 3600.0};
  if (kind == "STOPS") return {-kMostStops, kMostStops};
  if (kind == "STEPS") return {-100.0, 100.0};
  if (kind == "DEGREES") return {-36000.0, 36000.0};
  if (kind == "PIXELS") return {16.0, 16384.0};
  if (kind == "INDEX") return {0.0, 4294967295.0};
  if (kind == "R" || kind == "G" || kind == "B" || kind == "NUMBER") return {0.0, 1e18};
  return {-1e18, 1e18};
}

double number_of(const std::string& word, std::string_view kind, std::string_view command, const Line& line) {
  const std::string name(kind);
  char* end = nullptr;
  const double value = std::strtod(word.c_str(), &end);
  if (word.empty() || *end != '\0' || !std::isfinite(value)) line.fail("'" + word + "' is no number", name);
  const Range range = range_of(kind, command);
  const bool whole = kind == "INDEX" || kind == "PIXELS";
  if (value < range.least || value > range.most || (whole && value != std::floor(value)))
    line.fail(word + " is out of range", std::string(whole ? "a whole number from " : "a number from ") +
                                             std::to_string((long long)range.least) + " to " +
                                             (range.most > 1e17 ? "1e18" : std::to_string((long long)range.most)));
  return value;
}

template <typename Names>
void check_name(const std::string& word, const Names& names, const char* what, const Line& line) {
  std::string all;
  for (const std::string_view name : names) {
    if (name == word) return;
    all += (all.empty() ? "" : " ") + std::string(name);
  }
  line.fail(std::string("there is no ") + what + " '" + word + "'", "one of: " + all);
}

void check_word(const std::string& word, std::string_view kind, std::string_view command, const Line& line) {
  constexpr std::string_view kSwitch[] = {"on", "off"};
  std::vector<std::string_view> names;
  if (kind == "KEY") {
    if (!key_named(word)) line.fail("the key '" + word + "' does nothing", "F1 in the window names the keys");
    return;
  }
  if (kind == "PRESET") {
    for (const Preset& preset : presets()) names.push_back(preset.name);
    return check_name(word, names, "preset", line);
  }
  if (kind == "TARGET") {
    for (const Format format : kTargetFormats) names.push_back(info(format).name);
    return check_name(word, names, "target", line);
  }
  if (kind == "STRATEGY") return check_name(word, kStrategyNames, "strategy", line);
  if (kind == "VIEW") return check_name(word, kViewNames, "view", line);
  if (kind == "PANEL") return check_name(word, kPanelNames, "panel", line);
  if (kind == "SWITCH") return check_name(word, kSwitch, "switch", line);
  const auto ends = [&word](std::string_view ending) { return std::string_view(word).ends_with(ending); };
  if (command == "save" && !ends(".png") && !ends(".exr") && !ends(".json"))
    line.fail("no format has the ending of '" + word + "'", "end the name in .png, .exr or .json");
  if (command == "screenshot" && !ends(".png")) line.fail("'" + word + "' does not end in .png", "end the name so");
}

ScriptStep step_of(Line line, int number) {
  const std::string name = line.word();
  const auto command = std::find_if(std::begin(kCommands), std::end(kCommands),
                                    [&](const ScriptCommand& known) { return known.name == name; });
  if (command == std::end(kCommands)) {
    std::string all;
    for (const ScriptCommand& known : kCommands) all += (all.empty() ? "" : " ") + std::string(known.name);
    line.fail("no line begins with '" + name + "'", "one of: " + all);
  }
  ScriptStep step{command->name, {}, {}, number};
  std::string_view form = command->form;
  while (!form.empty()) {
    const std::string_view kind = form.substr(0, form.find(' '));
    form.remove_prefix(std::min(kind.size() + 1, form.size()));
    const std::string word = kind == "FILE" ? line.rest() : kind == "KEY" ? line.key() : line.word();
    if (word.empty()) line.fail("it ends too soon", name + " " + std::string(command->form));
    if (is_number(kind)) {
      step.numbers.push_back(number_of(word, kind, command->name, line));
    } else {
      check_word(word, kind, command->name, line);
      step.words.push_back(word);
    }
  }
  if (const std::string more = line.rest(); !more.empty())
    line.fail("'" + more + "' is too much", name + (command->form.empty() ? "" : " ") + std::string(command->form));
  return step;
}

}  // namespace

std::span<const ScriptCommand> script_commands() { return kCommands; }

std::vector<ScriptStep> script_from_text(std::string_view text, const std::string& where) {
  const FpScope fp;
  std::vector<ScriptStep> steps;
  int number = 0;
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size());
    std::string_view content = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    ++number;
    if (content.ends_with('\r')) content.remove_suffix(1);
    const size_t first = content.find_first_not_of(" \t");
    if (first == std::string_view::npos || content[first] == '#') continue;
    steps.push_back(step_of(Line(content, where, number), number));
  }
  return steps;
}

}  // namespace trueshade::viewer
