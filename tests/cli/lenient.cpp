// --lenient and --trust-paths, as users meet them: which commands have them, and what pictures, texts and judges say of
// a file whose faults were passed over.
#include <nlohmann/json.hpp>

#include "core/image_files/image_io.h"
#include "tests/catch.hpp"
#include "tests/cli/refused.h"
#include "tests/cli/run_command.h"
#include "tests/scratch_folder.h"
#include "tests/text_parts.h"

namespace trueshade {
namespace {

using nlohmann::json;

constexpr const char* kLost =
    "1 material library cannot be read, so its materials are grey: lost.obj: line 1: lost.mtl: ";
constexpr const char* kHint = "; add --lenient to look at it all the same)";

/// A model whose library is not there, the same with it, and a model whose library lies elsewhere.
class FaultyModels {
 public:
  FaultyModels() {
    const std::string faces = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n";
    folder_.write("lost.obj", "mtllib lost.mtl\n" + faces);
    folder_.write("whole.obj", "mtllib whole.mtl\n" + faces);
    folder_.write("whole.mtl", "newmtl m\nKd 0.2 0.7 0.7\n");
    folder_.write("here/far.obj", "mtllib ../whole.mtl\n" + faces);
  }
  Outcome run(const Arguments& words) const { return run_command(words, folder_.path("")); }
  Outcome done(const Arguments& words, int exit_code = 0) const {
    const Outcome outcome = run(words);
    INFO(outcome.err);
    CHECK(outcome.exit_code == exit_code);
    return outcome;
  }
  Outcome render(const std::string& scene, Arguments more) const {
    more.insert(more.begin(), {"render", scene, "--size", "40x30"});
    return done(more);
  }
  /// What a picture's file says of faults.
  std::string said(const std::string& file) const {
    for (const auto& [key, value] : read_image_info(folder_.path(file)).metadata)
      if (key == "trueshade:lenient") return value;
    return {};
  }

 private:
  ScratchFolder folder_;
};

TEST_CASE("Of --lenient: it shows a file with faults, and every output says so") {
  const FaultyModels folder;
  for (const Arguments& words : {Arguments{"render", "lost.obj", "--hash"}, Arguments{"info", "lost.obj"},
                                 Arguments{"explain", "lost.obj", "--pixel", "1,1"}})
    check_refused(folder.run(words), 5, kHint);
  const Outcome drawn =
      folder.render("lost.obj", {"--lenient", "-o", "a.png", "-o", "a.exr", "-o", "a.html", "--json"});
  CHECK(has(drawn.err, std::string("trueshade: note: As --lenient asks, which makes this no reference: ") + kLost));
  CHECK(json::parse(drawn.out).at("lenient").get<std::string>().starts_with(kLost));
  CHECK(folder.said("a.png").starts_with(kLost));
  CHECK(folder.said("a.exr").starts_with(kLost));
  CHECK(has(folder.done({"info", "lost.obj", "--lenient"}).out, kLost));
  CHECK(json::parse(folder.done({"info", "lost.obj", "--lenient", "--resolved"}).out)
            .at("lenient")
            .get<std::string>()
            .starts_with(kLost));
  CHECK(has(folder.done({"explain", "lost.obj", "--lenient", "--pixel", "20,15", "--size", "40x30"}).err, kLost));
}

TEST_CASE("Of --lenient: a file without faults is the picture without it") {
  const FaultyModels folder;
  CHECK(folder.render("whole.obj", {"--hash"}).out == folder.render("whole.obj", {"--hash", "--lenient"}).out);
  folder.render("whole.obj", {"--lenient", "-o", "a.png"});
  folder.render("whole.obj", {"-o", "b.png"});
  CHECK(folder.said("a.png").empty());
  CHECK(has(folder.done({"compare", "a.png", "b.png"}).out, "same"));
}

TEST_CASE("a picture that was drawn leniently is no reference, of compare and of validate") {
  const FaultyModels folder;
  folder.render("lost.obj", {"--lenient", "-o", "lost.exr", "--aov", "depth,position,normal,albedo"});
  folder.render("whole.obj", {"-o", "whole.exr", "--aov", "depth,position,normal,albedo"});
  const std::string is_none = "lost.exr is no reference: it was drawn with --lenient of a file with faults";
  CHECK(has(folder.done({"compare", "lost.exr", "whole.exr"}, 1).out, is_none));
  CHECK(has(folder.done({"compare", "whole.exr", "lost.exr"}, 1).out, is_none));
  CHECK(has(folder.done({"compare", "lost.exr", "whole.exr"}, 1).out,
            "its file has faults, and was drawn with --lenient"));
  check_refused(folder.run({"compare", "new.exr", "lost.exr", "--accept"}), 3, "so it is no reference");
  check_refused(folder.run({"validate", "whole.obj", "--gbuffer", "lost.exr"}), 3,
                "lost.exr: it was drawn with --lenient of a file with faults");
  check_refused(folder.run({"explain", "lost.obj", "--pixel", "1,1", "--lenient", "--against", "lost.exr"}), 2,
                "--lenient: no picture is held to a scene whose faults are passed over");
}

TEST_CASE("no command that judges, measures or exports passes faults over, or names the option") {
  const FaultyModels folder;
  for (const Arguments& words :
       {Arguments{"validate", "lost.obj", "--lenient"}, Arguments{"export", "lost.obj", "-o", "a.glb"},
        Arguments{"glsl", "lost.obj", "-o", "a"}, Arguments{"bench", "lost.obj"},
        Arguments{"shade", "a.exr", "--lights", "lost.obj", "-o", "a.png"}}) {
    const Outcome outcome = folder.run(words);
    INFO(outcome.err);
    CHECK(outcome.exit_code != 0);
    CHECK(!has(outcome.err, "--lenient to look"));
  }
  for (const char* command : {"export", "glsl", "bench", "shade"})
    CHECK(!has(folder.done({command, "--help"}).out, "--lenient"));
}

TEST_CASE("Of --trust-paths: it reads what a scene names elsewhere, in every command that reads one") {
  const FaultyModels folder;
  check_refused(folder.run({"render", "here/far.obj", "--hash"}), 3,
                "the path leaves the scene's folder (a path relative to the scene's folder and inside it, or "
                "--trust-paths where you trust the file");
  CHECK(folder.render("here/far.obj", {"--hash", "--trust-paths"}).out == folder.render("whole.obj", {"--hash"}).out);
  folder.done({"export", "here/far.obj", "-o", "a.glb", "--trust-paths"});
  folder.done({"info", "here/far.obj", "--trust-paths"});
  for (const char* command : {"render", "shade", "explain", "view", "info", "glsl", "export", "validate", "bench"})
    CHECK(has(folder.done({command, "--help"}).out, "--trust-paths"));
  CHECK(!has(folder.done({"compare", "--help"}).out, "--trust-paths"));
}

TEST_CASE("a cache file of a scene that was read with trust or leniently serves no other") {
  const FaultyModels folder;
  for (const Arguments& more : {Arguments{"--trust-paths"}, Arguments{"--lenient"}}) {
    const std::string scene = more.front() == "--lenient" ? "lost.obj" : "here/far.obj";
    Arguments words{"--hash", "--cache", "kept"};
    check_refused(folder.run({"render", scene, "--hash", "--cache", "kept"}), scene == "lost.obj" ? 5 : 3, "");
    words.push_back(more.front());
    const Outcome first = folder.render(scene, words), second = folder.render(scene, words);
    CHECK(first.out == second.out);
    CHECK(has(second.err, kLost) == (scene == "lost.obj"));
    check_refused(folder.run({"render", scene, "--hash", "--cache", "kept"}), scene == "lost.obj" ? 5 : 3, "");
  }
}

}  // namespace
}  // namespace trueshade
