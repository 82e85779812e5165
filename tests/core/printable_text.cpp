#include "core/printable_text.h"

#include "core/error.h"
#include "tests/catch.hpp"

namespace trueshade {
namespace {

TEST_CASE("text for a terminal has no control characters, no marks of direction, and is UTF-8") {
  CHECK(printable("plain, \xc3\xa4 \xe2\x82\xac \xf0\x9f\x98\x80", Lines::one) ==
        "plain, \xc3\xa4 \xe2\x82\xac \xf0\x9f\x98\x80");
  CHECK(printable("a\x1b[2J\x7f\r\n\tb", Lines::one) == "a?[2J????b");
  CHECK(printable("a\n\tb\r", Lines::several) == "a\n\tb?");
  CHECK(printable("\xc2\x9b"
                  "31m",
                  Lines::one) == "?31m");                                                      // C1: CSI
  CHECK(printable("\xe2\x80\xae\xe2\x81\xa6\xe2\x80\x8f\xd8\x9c", Lines::several) == "????");  // bidirectional
  CHECK(printable("\xe2\x80\xa8\xe2\x80\xa9", Lines::several) == "??");  // end a line or paragraph
  CHECK(printable("\xff\xc0\x80\xe2\x82", Lines::one) == "?????");       // no UTF-8
  CHECK(printable(std::string_view("a\0b", 3), Lines::one) == "a?b");
}

TEST_CASE("an error keeps what stands behind a zero in a name") {
  const Error error(ErrorKind::bad_input, std::string("f.ply\0: line 2", 14), "reason", "remedy");
  CHECK(std::string(error.what()) == "f.ply?: line 2: reason (remedy)");
}

}  // namespace
}  // namespace trueshade
