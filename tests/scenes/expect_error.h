#pragma once
#include <string>

#include "core/error.h"
#include "tests/catch.hpp"

/// Text of the Error that `body` throws; its kind is checked. Fails the test if it throws none.
template <typename Body>
std::string error_of(trueshade::ErrorKind kind, const Body& body) {
  try {
    body();
  } catch (const trueshade::Error& error) {
    CHECK(error.kind() == kind);
    CHECK(std::string(error.what()).find('\n') == std::string::npos);
    return error.what();
  }
  FAIL("nothing was thrown");
  return {};
}

/// Checks that a text starts as it should; the whole text is shown where it does not.
#define CHECK_STARTS_WITH(text, start) CHECK_THAT(text, Catch::StartsWith(start))
