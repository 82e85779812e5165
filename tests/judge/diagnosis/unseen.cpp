// Three of the faults that the diagnosis was not made of; all are in docs/data/unseen_faults.md.
#include <algorithm>

#include "tests/catch.hpp"
#include "tests/judge/diagnosis/unseen_faults.h"

namespace trueshade::testing {
namespace {

Trial tried(std::string_view fault, std::string_view subject) {
  const std::vector<UnseenFault> all = unseen_faults();
  const auto is_it = [&](const UnseenFault& f) { return f.name == fault; };
  return tried(*std::find_if(all.begin(), all.end(), is_it), subject_named(subject));
}

}  // namespace

TEST_CASE("A fault that nobody planted is named where it has a name, and no name is put on one that has none") {
  const Trial dimmed = tried("one-lamp-at-half", "city");
  CHECK(dimmed.convicted);
  CHECK(dimmed.first == "light-colored=32:0.5,0.5,0.5");
  CHECK(dimmed.explained > 0.95);
  const Trial misread = tried("stride-12-for-16", "city");
  CHECK(misread.convicted);
  CHECK(misread.first == "no fault that is known");
}

TEST_CASE("Half a picture in shadow is no stale tile") {
  const Trial shadowed = tried("one-lamp-shadowed", "cornell");
  CHECK(shadowed.convicted);
  CHECK(shadowed.accepted);
}

}  // namespace trueshade::testing
