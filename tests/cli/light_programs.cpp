// --light-shader as users meet it: what it draws, what it says, what it refuses.
#include <fstream>

#include "tests/catch.hpp"
#include "tests/cli/run_command.h"
#include "tests/scratch_folder.h"

using namespace trueshade;

namespace {

const ScratchFolder& folder() {
  static const ScratchFolder made;
  return made;
}

void write(const std::string& name, const std::string& text) { std::ofstream(folder().path(name)) << text; }

Outcome run(std::vector<std::string> arguments) { return run_command(arguments, folder().path("")); }

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("A light program draws, and the picture says which and with what parameters") {
  write("dim.glsl", R"(layout(std140) uniform Parameters { float gain; vec3 tint; };
vec3 light(Surface s, Light l, View v) { return gain * tint * s.albedo.rgb * l.color / 100.0; })");
  const std::vector<std::string> given{"render",
                                       "builtin:cornell",
                                       "--size",
                                       "32x24",
                                       "--light-shader",
                                       "dim.glsl",
                                       "--light-parameter",
                                       "gain=2",
                                       "--light-parameter",
                                       "tint=1,0.5,0.25",
                                       "--json",
                                       "-o",
                                       "dim.png"};
  const Outcome drawn = run(given);
  CHECK(drawn.exit_code == 0);
  CHECK(has(drawn.out, R"("light_program":{"file":"dim.glsl","sha256":")"));
  CHECK(has(drawn.out, R"({"name":"tint","value":[1,0.5,0.25]})"));
  CHECK(has(drawn.err, "end at their range"));  // it has no window
  CHECK(run({"render", "builtin:cornell", "--size", "32x24", "-o", "preset.png", "-q"}).exit_code == 0);
  const Outcome compared = run({"compare", "dim.png", "preset.png"});
  CHECK(compared.exit_code == 1);
  CHECK(has(compared.out + compared.err, "light program"));
}

TEST_CASE("What is wrong with a light program is said with its place or its option") {
  write("wrong.glsl", "vec3 light(Surface s, Light l, View v) {\n  return s.normals;\n}\n");
  const std::vector<std::string> frame{"render", "builtin:cornell", "--size", "32x24", "--hash"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), frame.begin(), frame.end());
    return run(more);
  };
  const Outcome wrong = with({"--light-shader", "wrong.glsl"});
  CHECK(wrong.exit_code == 3);
  CHECK(has(wrong.err, "wrong.glsl:2"));
  write("needs.glsl",
        "layout(std140) uniform Parameters { float gain; };\n"
        "vec3 light(Surface s, Light l, View v) { return vec3(gain); }\n");
  const Outcome needs = with({"--light-shader", "needs.glsl"});
  CHECK(needs.exit_code == 2);
  CHECK(has(needs.err, "parameters.gain"));
  CHECK(with({"--light-shader", "needs.glsl", "--light-parameter", "gain=much"}).exit_code == 2);
  CHECK(with({"--light-parameter", "gain=1"}).exit_code == 2);
  write("empty.glsl", "");
  CHECK(with({"--light-shader", "empty.glsl"}).exit_code == 3);
  CHECK(with({"--light-shader", "absent.glsl"}).exit_code == 5);
  const Outcome blends =
      with({"--light-shader", "needs.glsl", "--light-parameter", "gain=1", "--strategy", "deferred-volumes"});
  CHECK(blends.exit_code == 2);
  CHECK(has(blends.err, "deferred-loop"));
  write("zeros.spv", std::string("\x03\x02\x23\x07", 4) + std::string(64, '\0'));
  CHECK(with({"--light-shader", "zeros.spv"}).exit_code == 3);
}

TEST_CASE("A pipeline that names a light program is drawn by that text alone") {
  write("one.glsl", "vec3 light(Surface s, Light l, View v) { return vec3(0.25); }\n");
  write("other.glsl", "vec3 light(Surface s, Light l, View v) { return vec3(0.5); }\n");
  write("named.json", R"({"light_program":{"file":"one.glsl","sha256":"00"}})");
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"render", "builtin:cornell", "--size", "32x24", "--hash", "--pipeline", "named.json"});
    return run(more);
  };
  CHECK(with({}).exit_code == 2);
  const Outcome other = with({"--light-shader", "other.glsl"});
  CHECK(other.exit_code == 3);
  CHECK(has(other.err, "SHA-256"));
}
