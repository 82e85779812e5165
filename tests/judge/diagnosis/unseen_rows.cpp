// Judges every fault that the diagnosis was not made of, and writes the rows of docs/data/unseen_faults.md: those of
// the first list, and those of the second.
//
//   unseen_rows [PART-OF-A-NAME]
//
#include <cstdio>
#include <map>
#include <sstream>
#include <string>

#include "tests/judge/diagnosis/unseen_faults.h"

using namespace trueshade::testing;  // NOLINT

namespace {

struct Counts {
  int shown = 0, convicted = 0, accepted = 0, misnamed = 0;
};

void print_row(const UnseenFault& fault, const Subject& subject, const Trial& trial) {
  const std::string scene(subject.name), name(fault.name), accepted(fault.accepted);
  std::printf("| %s | %s | %d | %s | %s | %s | %s | %s |\n", name.c_str(), scene.c_str(), trial.changed,
              accepted.c_str(), trial.convicted ? "yes" : "no", trial.first.c_str(),
              trial.explained > 0 ? (std::to_string(int(trial.explained * 100)) + " %").c_str() : "",
              trial.accepted     ? "yes"
              : trial.misnamed() ? "**wrong**"
                                 : "no");
  std::fflush(stdout);
}

void add(Counts& counts, const Trial& trial) {
  if (trial.changed < 100) return;
  ++counts.shown;
  counts.convicted += trial.convicted, counts.accepted += trial.accepted, counts.misnamed += trial.misnamed();
}

void judge(const std::vector<UnseenFault>& faults, const std::map<std::string_view, Subject>& subjects,
           std::string_view part) {
  Counts named, unnamed;
  for (const UnseenFault& fault : faults) {
    if (fault.name.find(part) == std::string_view::npos) continue;
    std::istringstream scenes{std::string(fault.subjects)};
    for (std::string scene; scenes >> scene;) {
      const Subject& subject = subjects.at(scene);
      const Trial trial = tried(fault, subject);
      print_row(fault, subject, trial);
      add(fault.accepted.front() == '-' ? unnamed : named, trial);
    }
  }
  for (const auto& [text, c] : {std::pair{"a name is right", named}, std::pair{"no name is wholly right", unnamed}})
    std::printf("%s: %d change 100 pixels, %d convicted, %d accepted, %d wrong with more than half\n", text, c.shown,
                c.convicted, c.accepted, c.misnamed);
}

}  // namespace

int main(int count, char** words) {
  std::map<std::string_view, Subject> subjects;
  for (const char* name : {"city", "cornell", "lecture", "atrium", "box"}) subjects[name] = subject_named(name);
  const std::string_view part = count > 1 ? words[1] : "";
  judge(unseen_faults(), subjects, part);
  judge(unseen_faults_of_the_second_list(), subjects, part);
}
