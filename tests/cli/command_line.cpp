// How arguments and options are read, what help and --version say, and what goes through standard input and output.
#include <sys/wait.h>

#include <cstdlib>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>

#include "cli/limit_options.h"
#include "cli/option_values.h"
#include "tests/cli/refused.h"
#include "tests/file_contents.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

using nlohmann::json;

constexpr const char* kCommands[] = {"render",  "info",  "list",    "glsl", "export", "validate", "shade",
                                     "explain", "bench", "compare", "view", "batch",  "man",      "completion"};

std::string answer(const std::vector<std::string>& arguments, const std::string& folder = ".",
                   const std::string& setup = "true") {
  const Outcome outcome = run_command(arguments, folder, setup);
  INFO(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  return outcome.out;
}

TEST_CASE("Help of every command has -q, stands in groups and in lines of 100 columns") {
  const std::string all = answer({"--help"});
  for (const std::string command : kCommands) {
    INFO(command);
    CHECK(all.find("\n  " + command + ' ') != std::string::npos);
    const std::string help = answer({command, "--help"});
    CHECK(help == answer({"help", command}));
    CHECK(help == answer({command, "-h", "--no-such-option"}));
    CHECK(help == answer({command, "-qh"}));
    CHECK(help.find("-q,--quiet") != std::string::npos);
    CHECK(help.find("Usage: trueshade " + command + " [OPTIONS]") != std::string::npos);
    for (size_t begin = 0, end; begin < help.size(); begin = end + 1) {
      end = help.find('\n', begin);
      REQUIRE(end != std::string::npos);
      const std::string line = help.substr(begin, end - begin);
      INFO(line);
      CHECK(line.size() <= 100);
      CHECK(!line.ends_with(' '));
    }
  }
  const std::string help = answer({"render", "--help"});
  size_t at = 0;
  for (const char* group : {"\nArguments:\n", "\nOutput:\n", "\nCamera and time:\n", "\nPipeline:\n", "\nExecution:\n",
                            "\nReading:\n", "\nHelp:\n"}) {
    INFO(group);
    const size_t found = help.find(group, at);
    REQUIRE(found != std::string::npos);
    at = found;
  }
}

TEST_CASE("Limits stand in a help of their own, which --help names, and in man pages") {
  const ScratchFolder folder;
  const std::string limits = answer({"--help-limits"});
  CHECK(limits.starts_with("Limits:\n"));
  answer({"man", "man1"}, folder.path(""));
  for (const std::string command : {"render", "info", "validate", "bench", "compare", "export"}) {
    const std::string help = answer({command, "--help"}),
                      page = contents(folder.path("man1/trueshade-" + command + ".1"));
    INFO(command);
    CHECK(help.find("\n  --help-limits ") != std::string::npos);
    CHECK(answer({command, "--help-limits"}) == limits);
    for (const LimitOption& limit : limit_options()) {
      const std::string row = "\n  " + std::string(limit.name) + ' ';
      INFO(limit.name);
      CHECK(limits.find(row) != std::string::npos);
      CHECK(help.find(row) == std::string::npos);
      CHECK(page.find(std::regex_replace(limit.name, std::regex("-"), "\\-")) != std::string::npos);
    }
  }
  check_refused(run_command({"list", "--help-limits"}), 2, "--help-limits: there is no such option");
}

TEST_CASE("One man page is written where -o says") {
  const ScratchFolder folder;
  const std::string at = folder.path("");
  answer({"man", "man1", "-q"}, at);
  CHECK(answer({"man", "-o", "all"}, at).starts_with("all/trueshade.1\nall/trueshade-render.1\n"));
  CHECK(answer({"man", "-o", "one/mine.1"}, at).starts_with("wrote one/mine.1 (manual page, "));
  CHECK(answer({"man", "--command", "shade", "-q", "-o", "shade.1"}, at).empty());
  const std::string page = contents(folder.path("man1/trueshade.1"));
  CHECK(contents(folder.path("all/trueshade.1")) == page);
  CHECK(contents(folder.path("one/mine.1")) == page);
  CHECK(answer({"man", "-o", "-"}, at) == page);
  CHECK(contents(folder.path("shade.1")) == contents(folder.path("man1/trueshade-shade.1")));
  const auto refused = [&at](const std::vector<std::string>& words, const std::string& about) {
    check_refused(run_command(words, at), 2, about);
  };
  refused({"man"}, "FOLDER: it is required (name one, or add -o FILE)");
  refused({"man", "man1", "-o", "a.1"}, "-o: pages go to one place");
  refused({"man", "-o", "a.1", "--command", "shad"}, "--command: there is no command 'shad' (did you mean shade? ");
  refused({"man", "man1", "--command", "shade"}, "--command: a folder takes the pages of all commands");
}

TEST_CASE("list lists one thing alone, and answers a wrong name with a near one") {
  const json all = json::parse(answer({"list", "--json"}));
  const std::string text = answer({"list"});
  CHECK(all.size() == std::size(kListNames));
  std::string lists;
  for (const std::string_view name : kListNames) {
    INFO(name);
    const json one = json::parse(answer({"list", std::string(name), "--json"}));
    REQUIRE(one.size() == 1);
    CHECK(all.at(one.begin().key()) == one.begin().value());
    CHECK(one == json::parse(answer({"list", one.begin().key(), "--json"})));
    lists += answer({"list", std::string(name)});
  }
  CHECK(lists == text);
  CHECK(answer({"list", "presets"}).find("\n  many-lights ") != std::string::npos);
  const auto refused = [](const std::vector<std::string>& words, const std::string& about) {
    check_refused(run_command(words), 2, about);
  };
  refused({"list", "preset"}, "NAME: there is no list, preset or light model 'preset' (did you mean presets? one of: ");
  refused({"list", "many-light"}, "did you mean many-lights? ");
  refused({"list", "glft"}, "did you mean gltf? ");
  refused({"list", "presets", "--text"}, "--text: lists are no GLSL");
  refused({"list", "presets", "scenes"}, "'scenes' is one argument too many");
}

TEST_CASE("Options are read as other programs read them") {
  const ScratchFolder folder;
  const std::string hash = answer({"render", "builtin:cornell", "--size", "16x12", "--hash"});
  CHECK(hash == answer({"render", "--hash", "--size=16x12", "builtin:cornell"}));
  CHECK(hash == answer({"render", "--hash", "--size", "16x12", "--", "builtin:cornell"}));
  CHECK(hash == answer({"render", "--hash", "--hash", "--size", "16x12", "builtin:cornell"}));
  const std::string at = folder.path("");
  CHECK(answer({"render", "builtin:cornell", "--size", "16x12", "-o", "a.png", "-q"}, at).empty());
  CHECK(answer({"render", "builtin:cornell", "--size", "16x12", "-qob.png"}, at).empty());
  CHECK(answer({"render", "builtin:cornell", "--size", "16x12", "-q", "--output=c.png"}, at).empty());
  CHECK(contents(folder.path("a.png")) == contents(folder.path("b.png")));
  CHECK(contents(folder.path("a.png")) == contents(folder.path("c.png")));
  const auto refused = [](const std::vector<std::string>& arguments, const std::string& about) {
    check_refused(run_command(arguments), 2, about);
  };
  refused({"render", "builtin:cornell", "--hash", "--size"}, "--size: its value is missing (add it: --size WxH)");
  refused({"render", "builtin:cornell", "--background", "-o", "x.png"}, "--background: its value is missing");
  refused({"render", "builtin:cornell", "--hash=yes"}, "--hash: it takes no value");
  refused({"render", "builtin:cornell", "-q=yes"}, "-q: it takes no value");
  refused({"render", "builtin:cornell", "--size", "1x1", "--size", "2x2"}, "--size: it is given twice");
  refused({"render", "--hash"}, "SCENE: it is required");
  refused({"export", "builtin:cornell"}, "--output: it is required");
  refused({"render", "--", "--hash", "--hash"}, "'--hash' is one argument too many");
  refused({"--version", "--hash"}, "--hash: --version does not take it");
}

TEST_CASE("A misspelt name is answered with the one that was meant") {
  const ScratchFolder folder;
  folder.write("s.json", R"({"version": 1, "ligths": []})");
  folder.write("p.json", R"({"stratgey": "forward-loop"})");
  folder.write("v.json", R"({"strategy": "forward-lop"})");
  const std::vector<std::vector<std::string>> rows = {
      {"did you mean render? one of:", "rendr"},
      {"did you mean --preset? ", "render", "builtin:cornell", "--preste", "x"},
      {"did you mean --size? ", "render", "builtin:cornell", "-size", "4x4"},
      {"did you mean --hash? ", "render", "builtin:cornell", "-hash"},
      {"did you mean many-lights? ", "render", "builtin:cornell", "--hash", "--preset", "many-light"},
      {"did you mean albedo? ", "render", "builtin:cornell", "--hash", "--view", "alebdo"},
      {"did you mean rgba16f? ", "render", "builtin:cornell", "--hash", "--target", "rgba16ff"},
      {"did you mean forward-loop? ", "render", "builtin:cornell", "--hash", "--strategy", "forwardloop"},
      {"did you mean normal? ", "render", "builtin:cornell", "-o", "x.exr", "--aov", "depth,normla"},
      {"did you mean llvmpipe? ", "validate", "builtin:cornell", "--driver", "lvmpipe"},
      {"did you mean city? ", "render", "builtin:ctiy", "--hash"},
      {"did you mean lights? ", "render", "builtin:city,ligths=3", "--hash"},
      {"did you mean lights? ", "render", "s.json", "--hash"},
      {"did you mean strategy? ", "render", "builtin:cornell", "--hash", "--pipeline", "p.json"},
      {"did you mean forward-loop? ", "render", "builtin:cornell", "--hash", "--pipeline", "v.json"},
      {"did you mean zsh? ", "completion", "zhs"}};
  for (const std::vector<std::string>& row : rows) {
    const Outcome outcome = run_command({row.begin() + 1, row.end()}, folder.path(""));
    check_refused(outcome, outcome.exit_code == 3 ? 3 : 2, row.front());
  }
}

TEST_CASE("The version comes with targets and libraries, and as JSON for programs") {
  const std::string text = answer({"--version"});
  CHECK(std::regex_search(text, std::regex("^trueshade [0-9]+\\.[0-9]+\\.[0-9]+\n")));
  const json version = json::parse(answer({"--version", "--json"}));
  CHECK(version == json::parse(answer({"--json", "--version"})));
  CHECK(text.starts_with("trueshade " + version.at("version").get<std::string>() + '\n'));
  const json list = json::parse(answer({"list", "--json"}));
  CHECK(version.at("simd").at("runs_here") == list.at("simd"));
  CHECK(version.at("simd").at("chosen") == list.at("simd").at(0));
  for (const json& target : list.at("simd"))
    CHECK(version.at("simd").at("built").dump().find(target.dump()) != std::string::npos);
  for (const char* library : {"OpenImageIO", "oneTBB", "Embree", "GLM", "Highway", "libdeflate", "zlib"}) {
    INFO(library);
    CHECK(std::regex_match(version.at("libraries").at(library).get<std::string>(), std::regex("[0-9]+(\\.[0-9]+)*.*")));
    CHECK(text.find(library) != std::string::npos);
  }
  CHECK(version.at("driver_libraries").at("EGL").is_boolean());
}

TEST_CASE("With -q every command leaves its answer alone") {
  const ScratchFolder folder;
  const std::string at = folder.path("");
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"render", "builtin:circle", "--size", "16x16", "-o", "a.png", "-o", "a.exr"},
           {"export", "builtin:circle", "-o", "a.glb"},
           {"glsl", "--preset", "lecture", "-o", "shaders"},
           {"info", "builtin:cornell", "--resolved", "-o", "numbers"},
           {"man", "man1"}}) {
    INFO(arguments[0]);
    const Outcome loud = run_command(arguments, at);
    CHECK(!(loud.out + loud.err).empty());
    std::vector<std::string> with_quiet = arguments;
    with_quiet.emplace_back("-q");
    const Outcome quiet = run_command(with_quiet, at);
    CHECK(quiet.exit_code == 0);
    CHECK((quiet.out + quiet.err).empty());
  }
  answer({"render", "builtin:circle", "--size", "16x16", "-o", "b.png", "--preset", "gl-fixed", "-q"}, at);
  const Outcome compared = run_command({"compare", "a.png", "b.png", "-q", "--no-judge"}, at);
  CHECK(compared.exit_code == 1);
  CHECK(std::regex_match(compared.out, std::regex("verdict     the pictures differ: [^\n]*\n")));
  CHECK(compared.err.empty());
}

TEST_CASE("Pictures and scenes go through standard output and input") {
  const ScratchFolder folder;
  const std::string at = folder.path("");
  const std::vector<std::string> scene = {"render", "builtin:cornell", "--size", "24x16"};
  const auto with = [&scene](std::vector<std::string> more) {
    more.insert(more.begin(), scene.begin(), scene.end());
    return more;
  };
  answer(with({"-q", "-o", "a.png", "-o", "a.exr", "--aov", "depth"}), at);
  CHECK(answer(with({"-o", "-"}), at) == contents(folder.path("a.png")));
  CHECK(answer(with({"-o", "-.exr", "--aov", "depth", "-q"}), at) == contents(folder.path("a.exr")));
  const std::string page = answer(with({"-o", "-.html"}), at);
  CHECK(page.starts_with("<!doctype html>"));
  CHECK(page.ends_with("</html>\n"));
  const std::string frames = answer({"render", "builtin:circle", "--size", "8x8", "--frames", "0-2", "-o", "-"}, at);
  size_t pictures = 0;
  for (size_t place = 0; (place = frames.find("IHDR", place)) != std::string::npos; ++place) ++pictures;
  CHECK(pictures == 3);

  answer({"export", "builtin:cornell", "-o", "a.glb", "-q"}, at);
  folder.write(
      "s.json",
      R"({"version": 1, "objects": [{"mesh": "cube"}], "lights": [{"type": "point", "position": [0, 2, 2]}]})");
  folder.write("g.gltf",
               R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], )"
               R"("meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "accessors": [{"bufferView": 0, )"
               R"("componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}], )"
               R"("bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36, "uri": )"
               R"("data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
  folder.write("m.ply",
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
               "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  for (const char* file : {"a.glb", "s.json", "g.gltf", "m.ply"}) {
    INFO(file);
    CHECK(answer({"render", "-", "--size", "16x16", "--hash"}, at, std::string("exec <") + file) ==
          answer({"render", file, "--size", "16x16", "--hash"}, at));
  }
  CHECK(
      answer({"compare", "a.png", "-", "-q"}, at, "exec <a.png").starts_with("verdict     the pictures are the same"));
  CHECK(
      answer({"compare", "-", "a.exr", "-q"}, at, "exec <a.exr").starts_with("verdict     the pictures are the same"));
}

TEST_CASE("What standard input and output cannot do is refused") {
  const ScratchFolder folder;
  folder.write("obj", "v 0 0 0\n");
  folder.write("torn", "glTF");
  folder.write("s.json", R"({"version": 1, "objects": [{"mesh": "cube"}]})");
  const std::string at = folder.path("");
  const auto refused = [&at](const std::vector<std::string>& arguments, const std::string& setup, int code,
                             const std::string& about) {
    check_refused(run_command(arguments, at, setup), code, about);
  };
  const std::vector<std::string> hash = {"render", "-", "--hash"};
  refused(hash, "exec <obj", 3, "standard input: its first bytes are neither of JSON nor of glTF, GLB or PLY");
  refused(hash, "exec </dev/null", 3, "standard input: its first bytes");
  refused(hash, "exec <torn", 3, "standard input");
  refused(hash, "exec <&-", 5, "standard input: cannot read");
  refused({"render", "-", "--hash", "--max-file", "10"}, "exec <s.json", 4, "or a higher --max-file");
  refused({"render", "-", "--hash", "--max-json", "10"}, "exec <s.json", 4, "or a higher --max-json");
  refused({"render", "builtin:cornell", "--hash", "--pipeline", "-"}, "exec <s.json", 2, "--pipeline");
  refused({"explain", "-", "--size", "8x8", "--pixel", "1,1", "--against", "-"}, "exec <s.json", 2,
          "it is read already");
  refused({"compare", "-", "-"}, "exec <obj", 2, "standard input is the reference already");
  refused({"compare", "x.png", "-", "--accept"}, "exec <obj", 2, "--accept");
  for (const char* answering : {"--hash", "--stats", "--json"})
    refused({"render", "builtin:cornell", "-o", "-", answering}, "true", 2, "standard output takes the file");
  refused({"render", "builtin:cornell", "-o", "-", "-o", "-.exr"}, "true", 2, "standard output takes one file");
  refused({"render", "builtin:cornell", "--size", "8x8", "-o", "-", "-q"}, "exec >/dev/full", 5, "standard output");
}

TEST_CASE("Only a terminal is written to in colours, and none where nobody wants them") {
  const ScratchFolder folder;
  const auto said = [&folder](const std::string& variables) {
    // script (bsdutils) gives the command a terminal, and writes what appears there to a file.
    const std::string line = "cd '" + folder.path("") + "' && env " + variables +
                             " script -qec '" TRUESHADE_COMMAND " rendr' shown >/dev/null 2>&1 </dev/null";
    CHECK(WEXITSTATUS(std::system(line.c_str())) == 2);
    return contents(folder.path("shown"));
  };
  if (std::system("command -v script >/dev/null") != 0) {
    WARN("SKIPPED: script of bsdutils is absent");
    return;
  }
  CHECK(said("-u NO_COLOR TERM=xterm").find("\x1b[31merror: \x1b[0m") != std::string::npos);
  CHECK(said("NO_COLOR= TERM=xterm").find("\x1b[31m") != std::string::npos);
  for (const char* plain : {"NO_COLOR=1 TERM=xterm", "-u NO_COLOR TERM=dumb"}) {
    const std::string text = said(plain);
    INFO(text);
    CHECK(text.find("trueshade: error: ") != std::string::npos);
    CHECK(text.find('\x1b') == std::string::npos);
  }
  CHECK(run_command({"rendr"}, ".", "export TERM=xterm").err.find('\x1b') == std::string::npos);
}

}  // namespace
}  // namespace trueshade
