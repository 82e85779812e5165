// Some of the faults that the diagnosis was not made of; all are in docs/data/unseen_faults.md.
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

TEST_CASE("A name that leaves pixels far off is but a part, although it explains most of them") {
  // The first four lights of all are those of the lists of 98 % of the pixels.
  CHECK(tried("lists-of-four", "city").first == "no fault that is known");
  // A normal whose Z is rebuilt has unit length, and its Z may have the wrong sign.
  CHECK(tried("normal-z-rebuilt", "lecture").first == "no fault that is known");
}

TEST_CASE("Of two names that no pixel tells apart both are given, by the numbers that matter alone") {
  CHECK(tried("height-wrong", "city").first == "object-moved=0:0,0.3,0 or object-scaled=0:1,1.3,1");
}

TEST_CASE("An object that slides along a face is named by where its outline went") {
  CHECK(tried("object-left-behind", "cornell").first == "object-moved=4:0,0.2,0.2");
  CHECK(tried("height-wrong", "cornell").first.find("object-scaled=6:") == 0);
}

TEST_CASE("A name that says no number of the pixels that it holds explains none of them") {
  const Trial full = tried("lists-of-four", "lecture");
  CHECK(full.first == "tile-stale-16");
  CHECK(full.explained == 0);
}

}  // namespace trueshade::testing
