#include "farm/failures.h"

#include <new>
#include <stdexcept>
#include <system_error>

#include "core/error.h"

namespace trueshade {

FailureText failure_text(const std::exception_ptr& failure) {
  try {
    std::rethrow_exception(failure);
  } catch (const Error& error) {
    return {int32_t(error.kind()), error.what()};
  } catch (const std::bad_alloc&) {
    return {int32_t(ErrorKind::out_of_memory), "memory: there is not enough (give this machine fewer ranks)"};
  } catch (const std::system_error& error) {
    if (error.code() != std::errc::resource_unavailable_try_again) return {0, error.what()};
    return {int32_t(ErrorKind::out_of_memory),
            "threads: the system starts no more (raise the limit on processes there)"};
  } catch (const std::exception& error) {
    return {0, error.what()};
  } catch (...) {
    return {0, "unknown exception"};
  }
}

std::exception_ptr failure_from(const std::string& who, int32_t kind, const std::string& text) {
  if (kind < int32_t(ErrorKind::usage) || kind > int32_t(ErrorKind::no_gl_driver))
    return std::make_exception_ptr(std::runtime_error(who + ": " + text));
  // `REASON (REMEDY)`: the remedy begins at the bracket that the last one closes.
  size_t begin = text.size();
  for (int depth = 0; begin > 0;) {
    const char c = text[--begin];
    depth += c == ')' ? 1 : c == '(' ? -1 : 0;
    if (depth <= 0) break;
  }
  if (begin < 2 || text.back() != ')')
    return std::make_exception_ptr(Error(ErrorKind(kind), who, text, "see that machine"));
  return std::make_exception_ptr(
      Error(ErrorKind(kind), who, text.substr(0, begin - 1), text.substr(begin + 1, text.size() - begin - 2)));
}

}  // namespace trueshade
