// What a user can do wrong: one line that says what, the exit code of docs/exit_codes.md, and no file left behind.
#include <unistd.h>
#include <zlib.h>

#include <filesystem>
#include <fstream>

#include "tests/catch.hpp"
#include "tests/cli/refused.h"
#include "tests/cli/run_command.h"
#include "tests/file_contents.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

void check_render_refused(const Arguments& options, int exit_code, const std::string& about) {
  const ScratchFolder folder;
  Arguments arguments = {"render", "builtin:cornell", "-o", "x.png"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  check_refused(run_command(arguments, folder.path("")), exit_code, about);
  CHECK(folder.entries().empty());
}

TEST_CASE("options out of range are refused by name") {
  check_render_refused({"--size", "0x5"}, 2, "--size");
  check_render_refused({"--size", "64"}, 2, "--size");
  check_render_refused({"--size", "64x64x64"}, 2, "--size");
  check_render_refused({"--size", "-8x8"}, 2, "--size");
  check_render_refused({"--size", ""}, 2, "--size");
  check_render_refused({"--size", "99999999999999999999x1"}, 2, "--size");
  check_render_refused({"--size", "1048577x1"}, 4, "1048576");
  check_render_refused({"--size", "1x1048577"}, 4, "1048576");
  check_render_refused({"--threads", "-1"}, 2, "--threads");
  check_render_refused({"--threads", "many"}, 2, "--threads");
  check_render_refused({"--threads", "1025"}, 2, "--threads");
  check_render_refused({"--tile", "7"}, 2, "--tile");
  check_render_refused({"--tile", "24"}, 2, "tile");
  check_render_refused({"--simd", "mmx"}, 2, "--simd");
  check_render_refused({"--target", "rgb565"}, 2, "--target");
  check_render_refused({"--profile", "mesa"}, 2, "--profile");
  check_render_refused({"--preset", "fewer-lights"}, 2, "--preset");
  check_render_refused({"--aov", "depht", "-o", "x.exr"}, 2, "depht");
  check_render_refused({"--aov", "depth,depth", "-o", "x.exr"}, 2, "twice");
  check_render_refused({"--aov", "depth"}, 2, "EXR");
  check_render_refused({"--aov", "light.07", "-o", "x.exr"}, 2, "light.07");
  check_render_refused({"--aov", "light.999", "-o", "x.exr"}, 2, "light.999");
  check_render_refused({"--view", "wireframe"}, 2, "wireframe");
  check_render_refused({"--no-such-option"}, 2, "--no-such-option");
  check_render_refused({"-o", "x.tiff"}, 2, ".tiff");
  check_render_refused({"-o", "x"}, 2, "'x'");
  check_render_refused({"-o", "x.png"}, 2, "'x.png' is named twice");
}

TEST_CASE("a command that would do nothing is a mistake") {
  check_refused(run_command({}), 2, "trueshade --help");
  check_refused(run_command({"render"}), 2, "SCENE");
  check_refused(run_command({"render", "builtin:cornell"}), 2, "--hash");
  check_refused(run_command({"paint", "builtin:cornell"}), 2, "paint");
}

TEST_CASE("scenes that are not there or not right are refused with their place") {
  const ScratchFolder folder;
  check_refused(run_command({"render", "builtin:atlantis", "--hash"}), 3, "atlantis");
  check_refused(run_command({"render", "builtin:city,lights=x", "--hash"}), 3, "lights");
  check_refused(run_command({"render", "absent.json", "--hash"}, folder.path("")), 5, "absent.json");
  check_refused(run_command({"render", "two\nlines\x1b[2J.json", "--hash"}, folder.path("")), 5, "two?lines?[2J.json");
  check_refused(run_command({"render", "builtin:two\nlines", "--hash"}), 3, "builtin:two?lines");
  std::ofstream(folder.path("key.json")) << R"({"version": 1, "objects": [], "lamps": []})";
  check_refused(run_command({"render", "key.json", "-o", "x.png"}, folder.path("")), 3, "key.json: /lamps");
  std::ofstream(folder.path("torn.json")) << R"({"version": 1, )";
  check_refused(run_command({"render", "torn.json", "-o", "x.png"}, folder.path("")), 3, "torn.json");
  std::ofstream(folder.path("scene.txt")) << "x";
  check_refused(run_command({"render", "scene.txt", "-o", "x.png"}, folder.path("")), 3, "scene.txt");
  CHECK(folder.entries() == std::vector<std::string>{"key.json", "scene.txt", "torn.json"});
}

TEST_CASE("a bad pipeline file is refused with its place") {
  const ScratchFolder folder;
  std::ofstream(folder.path("p.json")) << R"({"version": 1, "geometry": {"depth_func": "lesser"}})";
  check_refused(run_command({"render", "builtin:cornell", "--pipeline", "p.json", "-o", "x.png"}, folder.path("")), 3,
                "p.json: /geometry/depth_func");
  check_refused(run_command({"render", "builtin:cornell", "--pipeline", "q.json", "-o", "x.png"}, folder.path("")), 5,
                "q.json");
  CHECK(folder.entries() == std::vector<std::string>{"p.json"});
}

TEST_CASE("a pipeline that contradicts itself is refused with its file, one that options contradict, as a mistake") {
  const ScratchFolder folder;
  const std::string both = R"({"strategy": "forward-loop", "transparency": {"mode": "into-albedo"}})";
  std::ofstream(folder.path("p.json")) << both;
  std::ofstream(folder.path("s.json")) << R"({"version": 1, "pipeline": )" << both << "}";
  std::ofstream(folder.path("half.json")) << R"({"transparency": {"mode": "into-albedo"}})";
  const auto refused = [&](Arguments arguments, int exit_code, const std::string& about) {
    arguments.insert(arguments.begin(), "render");
    arguments.push_back("--hash");
    check_refused(run_command(arguments, folder.path("")), exit_code, about);
  };
  refused({"builtin:cornell", "--pipeline", "p.json"}, 3,
          "p.json: transparency into-albedo with strategy forward-loop");
  refused({"s.json"}, 3, "s.json: /pipeline: transparency into-albedo with strategy forward-loop");
  refused({"builtin:cornell", "--pipeline", "half.json", "--strategy", "forward-loop"}, 2, "transparency.mode");
}

TEST_CASE("an output that cannot be written is exit 5, and nothing is left") {
  const ScratchFolder folder;
  const Arguments small = {"render", "builtin:cornell", "--size", "64x64", "-o"};
  const auto with = [&small](const std::string& path) {
    Arguments arguments = small;
    arguments.push_back(path);
    return arguments;
  };
  std::ofstream(folder.path("file")) << "no folder";
  check_refused(run_command(with("file/x.png"), folder.path("")), 5, "file/x.png");
  check_refused(run_command(with(std::string(252, 'n') + ".png"), folder.path("")), 5, "choose a shorter name");
  std::filesystem::create_directory(folder.path("folder.png"));
  check_refused(run_command(with("folder.png"), folder.path("")), 5, "folder.png");
  if (geteuid() != 0) {  // root may write anywhere
    std::filesystem::create_directory(folder.path("shut"));
    std::filesystem::permissions(folder.path("shut"), std::filesystem::perms::owner_read);
    check_refused(run_command(with("shut/x.png"), folder.path("")), 5, "shut/x.png");
    std::filesystem::remove(folder.path("shut"));
  }
  CHECK(folder.entries() == std::vector<std::string>{"file", "folder.png"});
}

TEST_CASE("the folder of an output is made, and none where nothing is written") {
  const ScratchFolder folder;
  const std::string path = folder.path("");
  CHECK(run_command({"render", "builtin:cornell", "--size", "32x32", "-q", "-o", "a/b/x.png"}, path).exit_code == 0);
  CHECK(std::filesystem::exists(folder.path("a/b/x.png")));
  CHECK(run_command({"compare", "a/b/x.png", "a/b/x.png.png", "-o", "c/x.html"}, path).exit_code == 5);
  check_refused(run_command({"render", "absent.json", "-o", "d/x.png"}, path), 5, "absent.json");
  CHECK(folder.entries() == std::vector<std::string>{"a"});
}

TEST_CASE("a limit on file sizes ends a write in an error, not by a signal, and the old file stays") {
  const ScratchFolder folder;
  for (const char* name : {"x.png", "x.exr", "x.html"}) {
    std::ofstream(folder.path(name)) << "old";
    const Outcome outcome =
        run_command({"render", "builtin:cornell", "--size", "300x300", "-o", name}, folder.path(""), "ulimit -f 4");
    check_refused(outcome, 5, name);
    std::ifstream file(folder.path(name));
    std::string text;
    CHECK((std::getline(file, text) && text == "old"));
  }
  CHECK(folder.entries() == std::vector<std::string>{"x.exr", "x.html", "x.png"});
}

TEST_CASE("a full disk is exit 5 with nothing torn") {
  if (geteuid() != 0 || std::system("unshare -m true 2>/dev/null") != 0) {
    WARN("SKIPPED: mounting a small disk needs root; the limit on file sizes above stands in for it");
    return;
  }
  const ScratchFolder folder;
  for (const std::string name : {"x.png", "x.exr", "x.html"}) {
    // The folder is listed after the run, inside the mount: a temporary would show up in it.
    const std::string line = "unshare -m sh -c 'mount -t tmpfs -o size=16k none " + folder.path("") + " && cd " +
                             folder.path("") +
                             " && \"" TRUESHADE_COMMAND "\" render builtin:cornell --size 500x500 -o " + name +
                             " 2>/dev/null; code=$?; [ -z \"$(ls -A)\" ] && exit $code; exit 99'";
    const int status = std::system(line.c_str());
    INFO(name);
    CHECK(WEXITSTATUS(status) == 5);
  }
}

TEST_CASE("standard output that takes nothing is exit 5") {
  if (!std::filesystem::exists("/dev/full")) return;
  const std::string line = "'" TRUESHADE_COMMAND "' list >/dev/full 2>/dev/null";
  const int status = std::system(line.c_str());
  CHECK(WEXITSTATUS(status) == 5);
}

TEST_CASE("a reader that has ended ends the command without a word") {
  const ScratchFolder folder;
  for (const char* arguments : {"list", "render --help", "render builtin:red --size 8x8 --hash"}) {
    INFO(arguments);
    const std::string line = "cd '" + folder.path("") + "' && { sleep 0.1; '" TRUESHADE_COMMAND "' " + arguments +
                             " 2>err; echo $? >code; } | true";
    CHECK(std::system(line.c_str()) == 0);
    std::ifstream code(folder.path("code"));
    CHECK(contents(folder.path("err")).empty());
    int exit_code = -1;
    code >> exit_code;
    CHECK(exit_code == 141);
  }
}

TEST_CASE("what a file holds does nothing to a terminal, in errors and in what info prints") {
  const ScratchFolder folder;
  folder.write("m.ply", std::string("ply\nformat ascii 1.0\nver\0tex\x1b[2J\xc2\x9b\xe2\x80\xae\xff many\n", 44));
  check_refused(run_command({"info", "m.ply"}, folder.path("")), 3, "m.ply: line 3: 'ver?tex?[2J?");
  folder.write("k.json", "{\"version\": 1, \"\xe2\x80\xae\xc2\x9b[2J\": 1}");
  const Outcome key = run_command({"info", "k.json"}, folder.path(""));
  check_refused(key, 3, "k.json: /");
  REQUIRE(run_command({"render", "builtin:cornell", "--size", "8x8", "-o", "x.png"}, folder.path("")).exit_code == 0);
  std::string png = contents(folder.path("x.png"));
  const std::string text = std::string("tEXta") + '\0' + "b\nc\x1b[2J\xc2\x9b";
  const auto sum = crc32(0, reinterpret_cast<const Bytef*>(text.data()), uInt(text.size()));
  std::string checksum;
  for (int shift = 24; shift >= 0; shift -= 8) checksum += char(sum >> shift);
  png.insert(33, std::string("\0\0\0\x0b", 4) + text + checksum);  // behind the IHDR
  folder.write("y.png", png);
  const Outcome info = run_command({"info", "y.png"}, folder.path(""));
  CHECK(info.exit_code == 0);
  CHECK(info.out.find("b?c?[2J?\n") != std::string::npos);
  for (const std::string& said : {key.err, info.out, info.err}) {
    CAPTURE(said);
    CHECK(said.find_first_of("\x1b\x9b\xff") == std::string::npos);
    CHECK(said.find("\xe2\x80\xae") == std::string::npos);
  }
}

TEST_CASE("info refuses what is neither image nor scene") {
  const ScratchFolder folder;
  std::ofstream(folder.path("x.png")) << "GIF89a";
  check_refused(run_command({"info", "x.png"}, folder.path("")), 3, "x.png");
  check_refused(run_command({"info", "absent.exr"}, folder.path("")), 5, "absent.exr");
}

}  // namespace
}  // namespace trueshade
