// What the command draws by machine code of a light program, interpreted, and where the system refuses the code's
// memory.

#include "tests/catch.hpp"
#include "tests/cli/run_command.h"
#include "tests/file_contents.h"
#include "tests/filtered_process.h"
#include "tests/scratch_folder.h"

namespace trueshade {

TEST_CASE("A light program draws the same picture as machine code, interpreted, and where memory is not executable") {
  const ScratchFolder folder;
  const std::vector<std::string> render = {"render", "builtin:cornell", "--size", "64x48", "--light-shader",
                                           "ue4",    "--hash"};
  const Outcome drawn = run_command(render);
  REQUIRE(drawn.exit_code == 0);
  std::vector<std::string> interpreted = render;
  interpreted.push_back("--no-machine-code");
  CHECK(run_command(interpreted).out == drawn.out);
  // mprotect() alone asks so: the loader maps libraries by mmap().
  const std::string file = folder.path("refused.txt");
  const int ended = testing::in_filtered_process(
      SECCOMP_RET_ERRNO | EACCES, PROT_EXEC,
      [&] {
        if (std::freopen(file.c_str(), "w", stdout) == nullptr) return 98;
        execl(TRUESHADE_COMMAND, TRUESHADE_COMMAND, "render", "builtin:cornell", "--size", "64x48", "--light-shader",
              "ue4", "--hash", nullptr);
        return 97;
      },
      false);
  CHECK(ended == 0);
  CHECK(contents(file) == drawn.out);
}

}  // namespace trueshade
