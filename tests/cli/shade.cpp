// `trueshade shade`: the light pass upon planes.
#include "tests/cli/drawn_capture.h"
#include "tests/cli/refused.h"

namespace trueshade {

TEST_CASE("shade makes of a frame's planes the picture that render made", "[slow]") {
  const ScratchFolder folder;
  for (const std::string scene : {"builtin:cornell", "builtin:city,lights=60"})
    for (const std::string preset : {"many-lights", "touchdesigner", "gl-fixed", "punctual", "lecture", "light-volumes",
                                     "light-volumes-literal", "redsdk"})
      for (const char* strategy : {"deferred-loop", "forward-loop", "deferred-volumes"}) {
        if (scene != "builtin:cornell" && preset != "many-lights" && preset != "punctual") continue;
        INFO(scene << ' ' << preset << ' ' << strategy);
        const Outcome drawn =
            run_command({"render", scene, "--preset", preset, "--strategy", strategy, "--size", "100x75", "-q", "-o",
                         "g.exr", "--aov", "depth,position,normal,albedo,specular,emission,id.object", "--hash"},
                        folder.path(""));
        REQUIRE(drawn.exit_code == 0);
        const Outcome lit = run_command(
            {"shade", "g.exr", "--lights", scene, "--preset", preset, "--strategy", strategy, "-q", "--hash"},
            folder.path(""));
        INFO(lit.err);
        CHECK(lit.out == drawn.out);
      }
}

TEST_CASE("shade rebuilds positions from depth as render does, and blends into the target as it does") {
  const DrawnCapture c;
  write_bytes(c.path("p.json"), R"({"gbuffer": {"position_from_depth": true, "normal": {"format": "rgb10_a2"},
                                    "albedo": {"format": "rgba16f"}}})");
  for (const std::string strategy : {"deferred-loop", "deferred-volumes"})
    for (const std::string profile : {"ideal", "mesa-llvmpipe-22.3"}) {
      INFO(strategy << ' ' << profile);
      const Words how = {"--pipeline", "p.json", "--strategy", strategy, "--profile", profile, "-q", "--hash"};
      Words drawn = {"render", kScene, "--size", "120x90", "-o", "g.exr", "--aov", "depth,normal,albedo,id.object"};
      Words lit = {"shade", "g.exr", "--lights", kScene};
      drawn.insert(drawn.end(), how.begin(), how.end()), lit.insert(lit.end(), how.begin(), how.end());
      const Outcome frame = run_command(drawn, c.path("")), again = run_command(lit, c.path(""));
      INFO(frame.err << again.err);
      CHECK(frame.exit_code == 0);
      CHECK(frame.out == again.out);
    }
}

TEST_CASE("shade refuses what a G-buffer cannot tell") {
  const DrawnCapture c;
  const auto refused = [&](const Words& words, int code, const std::string& about) {
    Words all = {"shade"};
    all.insert(all.end(), words.begin(), words.end());
    check_refused(run_command(all, c.path("")), code, about);
  };
  refused({"c.exr", "--lights", kScene, "--hash", "--strategy", "forward-multipass"}, 2, "no G-buffer has");
  refused({"c.exr", "--lights", kScene, "--hash", "--map", "position,normal,depth"}, 3, "plane albedo: is missing");
  refused({"c.exr", "--lights", kScene, "--hash", "--preset", "punctual"}, 3, "plane specular: is missing");
  refused({"c.exr", "--lights", kScene}, 2, "add -o FILE or --hash");
  refused({"--lights", kScene, "--hash"}, 2, "there is no G-buffer");
  refused({"c.png", "--lights", kScene, "--hash"}, 3, "there is no G-buffer in it");
  refused({"c.exr", "--lights", kScene, "-o", "x.html"}, 2, "end the name in .png or .exr");
}

}  // namespace trueshade
