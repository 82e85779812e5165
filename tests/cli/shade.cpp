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
  c.folder.write("p.json", R"({"gbuffer": {"position_from_depth": true, "normal": {"format": "rgb10_a2"},
                                    "albedo": {"format": "rgba16f"}}})");
  for (const std::string strategy : {"deferred-loop", "deferred-volumes"})
    for (const std::string profile : {"ideal", "mesa-llvmpipe-22.3"}) {
      INFO(strategy << ' ' << profile);
      const Arguments how = {"--pipeline", "p.json", "--strategy", strategy, "--profile", profile, "-q", "--hash"};
      Arguments drawn = {"render", kScene, "--size", "120x90", "-o", "g.exr", "--aov", "depth,normal,albedo,id.object"};
      Arguments lit = {"shade", "g.exr", "--lights", kScene};
      drawn.insert(drawn.end(), how.begin(), how.end()), lit.insert(lit.end(), how.begin(), how.end());
      const Outcome frame = run_command(drawn, c.path("")), again = run_command(lit, c.path(""));
      INFO(frame.err << again.err);
      CHECK(frame.exit_code == 0);
      CHECK(frame.out == again.out);
    }
}

TEST_CASE("compare judges by the G-buffer that a reference was shaded of, and not where that is not to be had") {
  const ScratchFolder folder;
  const auto run = [&](const Arguments& words) { return run_command(words, folder.path("")); };
  const auto says = [](const Outcome& outcome, const std::string& text) {
    INFO(outcome.out << outcome.err);
    CHECK(outcome.out.find(text) != std::string::npos);
  };
  // Another pixel grid than the scene's own: drawn anew, the planes would be other ones.
  const Arguments planes = {"-q", "-o", "g.exr", "--aov", "depth,position,normal,albedo,id.object"};
  folder.write("shifted.json", R"({"geometry": {"viewport": {"x": 3, "y": -2, "width": 64, "height": 64}}})");
  Arguments drawn = {"render", "builtin:cornell", "--size", "64x64", "--pipeline", "shifted.json"};
  drawn.insert(drawn.end(), planes.begin(), planes.end());
  REQUIRE(run(drawn).exit_code == 0);
  const auto shade = [&](const std::string& file, const Arguments& more) {
    Arguments words = {"shade", "g.exr", "--lights", "builtin:cornell", "-q", "--target", "rgba32f", "-o", file};
    words.insert(words.end(), more.begin(), more.end());
    REQUIRE(run(words).exit_code == 0);
  };
  folder.write("order.json", R"({"light_model": {"order": "separate"}})");
  shade("should.exr", {});
  shade("order.exr", {"--pipeline", "order.json"});  // the same light, rounded otherwise
  shade("wrong.exr", {"--preset", "light-volumes", "--strategy", "deferred-loop"});
  const Outcome legal = run({"compare", "should.exr", "order.exr"});
  says(legal, "judged by the G-buffer that the reference was shaded of, g.exr");
  says(legal, "lighting: 4096 pixels");
  says(legal, "VIOLATION          0");
  CHECK(legal.out.find("gbuffer: ") == std::string::npos);
  says(run({"compare", "should.exr", "wrong.exr"}), "pixels are in no legal set");
  REQUIRE(
      run({"render", "builtin:cornell", "--size", "64x64", "-q", "-o", "g.exr", "--aov", planes.back()}).exit_code ==
      0);
  says(run({"compare", "should.exr", "wrong.exr"}), "it is another G-buffer today");
  std::filesystem::remove(folder.path("g.exr"));
  const Outcome gone = run({"compare", "should.exr", "wrong.exr"});
  says(gone, "the reference was shaded of this, and it is neither here nor beside it");
  CHECK(gone.out.find("no legal set") == std::string::npos);
}

TEST_CASE("A light program reads planes of a capture by their names in --map, and refuses those that are not named") {
  const ScratchFolder folder;
  const auto run = [&](const Arguments& words) { return run_command(words, folder.path("")); };
  const std::string scene = "builtin:lecture";
  folder.write("p.json", R"({"target": "rgba32f", "light_volumes": {"point": "range", "spot": "range"}})");
  REQUIRE(run({"render", scene, "--size", "64x48", "-q", "-o", "g.exr", "--aov",
               "depth,position,normal,albedo,uv,id.object,id.material"})
              .exit_code == 0);
  const auto lit = [&](const std::string& value, const std::string& more) {
    folder.write("field.glsl",
                 "vec3 light(Surface s, Light l, View v) { return vec3(0); }\n"
                 "vec3 start(Surface s, View v) { return " +
                     value + "; }\n");
    return run({"shade", "g.exr", "--lights", scene, "--light-shader", "field.glsl", "--pipeline", "p.json", "--map",
                "depth,position,normal,albedo,id.object" + more, "-o", "lit.exr", "--hash", "-q"});
  };
  const auto verdict = [&](const std::string& more) {
    return run({"validate", scene, "--size", "64x48", "--light-shader", "field.glsl", "--pipeline", "p.json", "--quick",
                "--gbuffer", "g.exr", "--image", "lit.exr", "--subpixel-bits", "8", "--map",
                "depth,position,normal,albedo,id.object" + more});
  };
  const auto same = [&](const std::string& value, const std::string& more, const std::string& expected) {
    const Outcome wanted = lit(expected, ""), found = lit(value, more), judged = verdict(more);
    INFO(value << found.err << judged.out << judged.err);
    CHECK(found.exit_code == 0);
    CHECK(found.out == wanted.out);
    CHECK(judged.exit_code == 0);
  };
  same("s.user[2].xyz + s.user[3].www", ",user2=g.N.XYZ,user3=g.P.XYZ", "s.normal + vec3(1.0)");
  same("vec3(s.uv1, s.tangent.w) + s.tangent.xyz", ",uv1=g.albedo.RG,tangent=g.N.XYZ",
       "vec3(s.albedo.rg, 1.0) + s.normal");
  same("vec3(s.occlusion)", ",occlusion=g.albedo.B", "s.albedo.bbb");
  same("s.user[0].xyz", ",user0=g.P.XYZ", "s.position");
  CHECK(verdict(",user0=g.N.XYZ").exit_code == 1);  // another plane than the picture was lit by
  const Outcome own = lit("vec3(s.uv, float(s.material))", ",uv,id.material");
  CHECK(own.exit_code == 0);
  CHECK(own.out == run({"render", scene, "--size", "64x48", "--light-shader", "field.glsl", "--pipeline", "p.json",
                        "--hash", "-q"})
                       .out);
  for (const auto& [field, plane] : {std::pair("s.user[1].xyz", "user1"),
                                     {"vec3(s.uv1, 0.0)", "uv1"},
                                     {"s.tangent.xyz", "tangent"},
                                     {"vec3(s.uv, 0.0)", "plane uv"},
                                     {"vec3(float(s.material))", "plane id.material"},
                                     {"vec3(s.roughness)", "plane specular"}}) {
    const Outcome shaded = lit(field, ",user0=g.P.XYZ"), judged = verdict(",user0=g.P.XYZ");
    INFO(field << shaded.err << judged.err);
    CHECK(shaded.exit_code == 3);
    CHECK(shaded.err.find(plane) != std::string::npos);
    CHECK(judged.exit_code == 3);
    CHECK(judged.err.find(plane) != std::string::npos);
  }
}

TEST_CASE("Planes of metallic and roughness light a light program, and are held to the scene's materials") {
  const ScratchFolder folder;
  const auto run = [&](const Arguments& words) { return run_command(words, folder.path("")); };
  folder.write("s.json", R"({"version": 1, "camera": {"eye": [0, 2, 4], "target": [0, 0, 0]},
    "materials": [{"name": "m", "color": [0.8, 0.5, 0.3], "metallic": 0.25, "roughness": 0.7}],
    "objects": [{"mesh": "sphere", "material": "m"}],
    "lights": [{"type": "directional", "direction": [-1, -1, -1], "color": [1, 1, 1]}]})");
  folder.write("metals.glsl",
               "vec3 light(Surface s, Light l, View v) { return vec3(0); }\n"
               "vec3 start(Surface s, View v) { return vec3(s.metallic, s.roughness, 1.0 - s.roughness); }\n");
  const Arguments program = {"--light-shader", "metals.glsl", "--target", "rgba32f", "-q"};
  const auto with_program = [&](Arguments words) {
    words.insert(words.end(), program.begin(), program.end());
    return run(words);
  };
  REQUIRE(with_program(
              {"render", "s.json", "--size", "64x48", "-o", "g.exr", "--aov", "depth,position,normal,albedo,id.object"})
              .exit_code == 0);
  const std::string planes = "depth,position,normal,albedo,id.object,color=g.RGBA,";
  const auto verdict = [&](const std::string& metals) {
    return with_program({"validate", "s.json", "--size", "64x48", "--quick", "--gbuffer", "g.exr", "--subpixel-bits",
                         "8", "--map", planes + metals});
  };
  const Outcome right = verdict("metallic=g.R,roughness=g.G"), gloss = verdict("metallic=g.R,roughness=g.B"),
                swapped = verdict("metallic=g.G,roughness=g.R"), one = verdict("metallic=g.R");
  INFO(right.out << right.err << gloss.out << one.err);
  CHECK(right.exit_code == 0);
  CHECK(gloss.exit_code == 1);
  CHECK(gloss.out.find("in no legal set (gbuffer") != std::string::npos);
  CHECK(swapped.exit_code == 1);
  check_refused(one, 3, "plane roughness: is missing");
}

TEST_CASE("shade refuses what a G-buffer cannot tell") {
  const DrawnCapture c;
  const auto refused = [&](const Arguments& words, int code, const std::string& about) {
    Arguments all = {"shade"};
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
