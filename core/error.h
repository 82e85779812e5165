#pragma once
#include <algorithm>
#include <stdexcept>
#include <string>
#include <string_view>

namespace trueshade {

/// Why a run ends early; the value is the exit code of the command.
enum class ErrorKind : int {
  usage = 2,      ///< the command line
  bad_input = 3,  ///< a file or value that is not what its format says
  limit = 4,      ///< well formed, but over a stated limit
  io = 5,         ///< reading or writing failed
  out_of_memory = 6,
  no_gl_driver = 7,  ///< no OpenGL on this machine, or not enough of it; or a CPU that this build has no kernels for
};

/// A fault in what the user gave us: a file, a scene, an option. Bugs in our own code assert instead.
/// what() reads `WHERE: REASON (REMEDY)`; WHERE may be `FILE: JSON pointer`, `FILE: line 12` or an option's name.
class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, std::string_view where, std::string_view reason, std::string_view remedy)
      : std::runtime_error(
            without_zeros(std::string(where) + ": " + std::string(reason) + " (" + std::string(remedy) + ")")),
        kind_(kind) {}
  ErrorKind kind() const { return kind_; }

 private:
  /// what() ends at the first zero, which a file may have put into a name.
  static std::string without_zeros(std::string text) {
    std::replace(text.begin(), text.end(), '\0', '?');
    return text;
  }

  ErrorKind kind_;
};

}  // namespace trueshade
