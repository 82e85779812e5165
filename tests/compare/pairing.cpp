#include "compare/pairing.h"

#include "tests/catch.hpp"
#include "tests/compare/made_pictures.h"

namespace trueshade::compare {
namespace {

PictureFile with_channels(std::vector<std::string> names, int width = 1, int height = 1) {
  std::vector<Channel> channels;
  for (const std::string& name : names)
    channels.push_back(float_channel(name, std::vector<float>(size_t(width * height), 0.5f)));
  return made_picture(width, height, channels);
}

/// Of parts with one channel R each.
PictureFile with_parts(std::vector<std::string> names) {
  PictureFile picture = made_picture(1, 1, {});
  picture.parts.clear();
  for (const std::string& name : names) {
    const Channel channel = of_part(name, float_channel("R", {1.0f}));
    picture.parts.push_back({"made", 1, 1, {channel}});
  }
  return picture;
}

TEST_CASE("channels are paired by name, in the reference's order, whatever the test's is") {
  const PictureFile reference = with_channels({"R", "G", "Z"}), test = with_channels({"Z", "G", "R"});
  const Pairing pairing = paired(reference, test);
  CHECK(pairing.mismatches.empty());
  REQUIRE(pairing.parts.size() == 1);
  REQUIRE(pairing.parts[0].channels.size() == 3);
  CHECK(pairing.parts[0].channels[0].name == "R");
  CHECK(pairing.parts[0].channels[2].reference == &reference.parts[0].channels[2]);
  CHECK(pairing.parts[0].channels[2].test == &test.parts[0].channels[0]);
}

TEST_CASE("a channel that one picture lacks is a mismatch, and a missing alpha is named as that") {
  CHECK(paired(with_channels({"R", "G", "B", "A"}), with_channels({"R", "G", "B"})).mismatches ==
        std::vector<std::string>{"the test has no alpha (channel A) (--channels RGB compares the others)"});
  CHECK(paired(with_channels({"R", "G", "B"}), with_channels({"R", "G", "B", "A"})).mismatches ==
        std::vector<std::string>{"the reference has no alpha (channel A) (--channels RGB compares the others)"});
  CHECK(paired(with_channels({"R", "N.X", "N.Y"}), with_channels({"R", "Z"})).mismatches ==
        std::vector<std::string>{"the test has no channels N.X, N.Y", "the reference has no channel Z"});
}

TEST_CASE("two pictures of one channel each are paired whatever the channels are called") {
  CHECK(paired(with_channels({"Z"}), with_channels({"R"})).mismatches.empty());
  CHECK_FALSE(paired(with_channels({"Z", "A"}), with_channels({"R", "A"})).mismatches.empty());
}

TEST_CASE("sizes that differ are a mismatch even where the pixels are as many, and nothing is paired") {
  const Pairing pairing = paired(with_channels({"R"}, 2, 3), with_channels({"R"}, 3, 2));
  CHECK(pairing.mismatches == std::vector<std::string>{"the size is 2x3 in the reference and 3x2 in the test"});
  CHECK(pairing.parts.empty());
}

TEST_CASE("data windows at two places of their frames are a mismatch") {
  PictureFile reference = with_channels({"R"}), test = with_channels({"R"});
  for (PictureFile* picture : {&reference, &test}) picture->parts[0].frame_width = picture->parts[0].frame_height = 8;
  CHECK(paired(reference, test).mismatches.empty());
  test.parts[0].left = 1;
  CHECK(paired(reference, test).mismatches ==
        std::vector<std::string>{"the window is 0,0 of 8x8 in the reference and 1,0 of 8x8 in the test"});
}

TEST_CASE("parts are paired by name, in any order, and one that is lacking is a mismatch") {
  CHECK(paired(with_parts({"left", "right"}), with_parts({"right", "left"})).mismatches.empty());
  CHECK(paired(with_parts({"left", "right"}), with_parts({"left"})).mismatches ==
        std::vector<std::string>{"the test has no part 'right'"});
  CHECK(paired(with_parts({"left"}), with_parts({"left", "right"})).mismatches ==
        std::vector<std::string>{"the reference has no part 'right'"});
  CHECK(paired(with_parts({"beauty"}), with_parts({""})).mismatches.empty());  // one part each
}

}  // namespace
}  // namespace trueshade::compare
