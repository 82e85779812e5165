#pragma once
#include <cstdint>
#include <exception>
#include <string>

namespace trueshade {

/// An exception as one rank sends it to another.
struct FailureText {
  int32_t kind;  ///< the ErrorKind of an Error; out_of_memory where memory or threads ran out; else 0
  std::string text;
};

/// The kind and the text of an exception; `failure` is not null. The text is "unknown exception" where it is no
/// std::exception.
FailureText failure_text(const std::exception_ptr& failure);

/// The exception that rank 0 throws where rank `who` has sent a FailureText: an Error of this kind, or
/// std::runtime_error where `kind` is no ErrorKind. A remark in brackets at the end of `text` becomes the Error's
/// remedy; without one the remedy is "see that machine".
std::exception_ptr failure_from(const std::string& who, int32_t kind, const std::string& text);

}  // namespace trueshade
