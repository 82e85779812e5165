// Vectors: FIPS 180-4 examples as published with the standard (NIST, "SHA256" example values), and the one-million-a
// vector.
#include "core/sha256.h"

#include <string>

#include "tests/catch.hpp"

namespace trueshade {
namespace {

/// Of a processor with instructions for it both ways are taken, and must agree.
std::string sha256(const std::string& text) {
  Sha256 hash, plain(Sha256::Blocks::plain);
  hash.update(text.data(), text.size());
  plain.update(text.data(), text.size());
  const std::string digits = hash.hex();
  CHECK(plain.hex() == digits);
  return digits;
}

TEST_CASE("SHA-256 gives the published digests") {
  CHECK(sha256("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(sha256("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
        "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  CHECK(
      sha256("abcdefghbcdefghicdefghijdefghijkefghijklfghijklmghijklmnhijklmnoijklmnopjklmnopqklmnopqrlmnopqrsmnopqrst"
             "nopqrstu") == "cf5b16a778af8380036ce59e7b0492370b249b11e8f07a51afac45037afee9d1");
  CHECK(sha256(std::string(1000000, 'a')) == "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_CASE("SHA-256 does not depend on how its input is cut into pieces") {
  std::string text;
  for (int i = 0; i < 300; ++i) text += char('!' + i % 90);
  for (size_t length : {55u, 56u, 63u, 64u, 65u, 119u, 120u, 128u, 300u}) {
    const std::string whole = sha256(text.substr(0, length));
    for (size_t cut = 0; cut <= length; ++cut) {
      Sha256 hash;
      hash.update(text.data(), cut);
      hash.update(text.data() + cut, length - cut);
      if (hash.hex() != whole) FAIL("length " << length << " cut at " << cut);
    }
  }
}

TEST_CASE("SHA-256 takes an empty piece that has no address") {
  Sha256 hash;
  hash.update("ab", 2);
  hash.update(nullptr, 0);
  hash.update("c", 1);
  CHECK(hash.hex() == sha256("abc"));
}

}  // namespace
}  // namespace trueshade
