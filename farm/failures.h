#pragma once
#include <cstdint>
#include <exception>
#include <string>

namespace trueshade {

/// An exception as one rank tells another of it.
struct FailureText {
  int32_t kind;  ///< the ErrorKind of an Error; of memory its out_of_memory; else 0
  std::string text;
};
FailureText failure_text(const std::exception_ptr& failure);

/// An Error of that kind with `who: ` before its text, or std::runtime_error where the kind is none.
std::exception_ptr failure_from(const std::string& who, int32_t kind, const std::string& text);

}  // namespace trueshade
