#pragma once
#include <cstdint>
#include <exception>
#include <string>

namespace trueshade {

/// An exception in the form in which one rank sends it to another.
struct FailureText {
  int32_t kind;  ///< the ErrorKind of an Error; out_of_memory where memory or threads ran out; else 0
  std::string text;
};

/// The kind and the text of an exception, which is not null. What is no std::exception is "unknown exception".
FailureText failure_text(const std::exception_ptr& failure);

/// The exception that rank 0 throws for a FailureText of `who`: an Error of this kind, or std::runtime_error where
/// `kind` is no ErrorKind. Brackets at the end of `text` become the Error's remedy; without them the remedy is
/// "see that machine".
std::exception_ptr failure_from(const std::string& who, int32_t kind, const std::string& text);

}  // namespace trueshade
