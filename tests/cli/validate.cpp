// `trueshade validate` as people run it: on this machine's driver, on captures, on captures that are wrong.
#include <OpenImageIO/imageio.h>

#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/image_files/image_io.h"
#include "tests/catch.hpp"
#include "tests/cli/refused.h"
#include "tests/cli/run_command.h"
#include "tests/file_contents.h"
#include "tests/scratch_folder.h"
#include "tests/text_parts.h"

namespace trueshade {
namespace {

constexpr int kNoDriver = 7;

/// Our own frame of builtin:cornell as c.exr (target and planes) and c.png.
void write_capture(const ScratchFolder& folder) {
  const Outcome outcome = run_command({"render", "builtin:cornell", "--size", "200x150", "-o", "c.exr", "-o", "c.png",
                                       "--aov", "depth,position,normal,albedo,uv,id.object,id.material,light.count"},
                                      folder.path(""));
  REQUIRE(outcome.exit_code == 0);
}

Outcome judged(const ScratchFolder& folder, const Arguments& options) {
  Arguments arguments = {"validate", "builtin:cornell", "--quick"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  return run_command(arguments, folder.path(""));
}

/// c.exr again as `name`, with `change` made to a plane.
template <typename Change>
void write_changed(const ScratchFolder& folder, const std::string& name, const std::string& plane, Change change) {
  std::vector<NamedImage> planes = read_planes(folder.path("c.exr"));
  for (NamedImage& p : planes)
    if (p.name == plane) change(p.image);
  const NamedImage color = planes.front();
  planes.erase(planes.begin());
  write_image(folder.path(name), color.image, planes, {});
}

void set_float(Image& image, int x, int y, int channel, float value) {
  std::memcpy(image.texel(x, y) + 4 * channel, &value, sizeof value);
}

/// The channels of c.exr as floats, each in the type that `type_of` names, with `change` made to a value of a channel:
/// what other programs write.
template <typename TypeOf, typename Change>
void write_channels(const ScratchFolder& folder, const std::string& name, TypeOf type_of, Change change) {
  const auto in = OIIO::ImageInput::open(folder.path("c.exr"));
  REQUIRE(in);
  OIIO::ImageSpec spec(in->spec().width, in->spec().height, in->spec().nchannels, OIIO::TypeDesc::FLOAT);
  spec.channelnames = in->spec().channelnames;
  const auto channels = size_t(spec.nchannels), pixels = size_t(spec.width) * size_t(spec.height);
  std::vector<uint8_t> native(in->spec().image_bytes(true));
  REQUIRE(in->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UNKNOWN, native.data()));  // 4 bytes a channel
  std::vector<float> values(channels * pixels);
  for (size_t i = 0; i < values.size(); ++i) {
    const std::string& channel = spec.channelnames[i % channels];
    uint32_t bits;
    std::memcpy(&bits, &native[4 * i], 4);
    const bool whole = in->spec().channelformat(int(i % channels)) == OIIO::TypeDesc::UINT32;
    values[i] = change(channel, whole ? float(bits) : std::bit_cast<float>(bits));
  }
  for (const std::string& channel : spec.channelnames) spec.channelformats.push_back(type_of(channel));
  const auto out = OIIO::ImageOutput::create("openexr");
  REQUIRE(out->open(folder.path(name), spec));
  REQUIRE(out->write_image(OIIO::TypeDesc::FLOAT, values.data()));
  REQUIRE(out->close());
}

/// c.png without its alpha.
void write_rgb(const ScratchFolder& folder, const std::string& name, uint8_t code_of_0_0) {
  const NamedImage color = read_planes(folder.path("c.png")).front();
  std::vector<uint8_t> codes;
  for (size_t i = 0; i < color.image.texels.size(); ++i)
    if (i % 4 != 3) codes.push_back(i == 0 ? code_of_0_0 : color.image.texels[i]);
  const auto out = OIIO::ImageOutput::create("png");
  REQUIRE(
      out->open(folder.path(name), OIIO::ImageSpec(color.image.width, color.image.height, 3, OIIO::TypeDesc::UINT8)));
  REQUIRE(out->write_image(OIIO::TypeDesc::UINT8, codes.data()));
  REQUIRE(out->close());
}

}  // namespace

TEST_CASE("A picture of R, G and B alone is judged but for its alpha, and text and JSON say so") {
  const ScratchFolder folder;
  write_capture(folder);
  write_rgb(folder, "rgb.png", read_planes(folder.path("c.png")).front().image.texels[0]);
  const Outcome right = judged(folder, {"--gbuffer", "c.exr", "--image", "rgb.png"});
  INFO(right.out << right.err);
  CHECK(right.exit_code == 0);
  CHECK(has(right.out, "note        the picture has no alpha channel, so alpha is not judged"));
  CHECK(has(right.out, "lighting: 30000 pixels"));
  write_rgb(folder, "wrong.png", 255);
  const Outcome wrong = judged(folder, {"--gbuffer", "c.exr", "--image", "wrong.png", "--json"});
  CHECK(wrong.exit_code == 1);
  CHECK(has(wrong.out, "the picture has no alpha channel"));
  CHECK(has(wrong.out, R"("plane":"color.R")"));
}

TEST_CASE("Depths in halves and identifiers read as floats are refused in one line, not judged in thousands") {
  const ScratchFolder folder;
  write_capture(folder);
  const auto as_float = [](const std::string&) { return OIIO::TypeDesc(OIIO::TypeDesc::FLOAT); };
  const auto same = [](const std::string&, float value) { return value; };
  write_channels(folder, "floats.exr", as_float, same);  // whole numbers in floats are identifiers as good as others
  CHECK(judged(folder, {"--gbuffer", "floats.exr"}).exit_code == 0);
  for (const std::string half : {"depth.Z", "uv.X"}) {
    const std::string plane = half.substr(0, half.find('.'));
    write_channels(
        folder, "half.exr",
        [&](const std::string& channel) {
          return OIIO::TypeDesc(channel.starts_with(plane) ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT);
        },
        same);
    check_refused(judged(folder, {"--gbuffer", "half.exr"}), 3, "half.exr: " + plane + " is stored as half, and the");
  }
  write_channels(folder, "bits.exr", as_float, [](const std::string& channel, float value) {
    return channel == "id.object" ? std::bit_cast<float>(uint32_t(value)) : value;
  });
  check_refused(judged(folder, {"--gbuffer", "bits.exr"}), 3, "the bits of a uint were read as those of a float");
  write_channels(folder, "part.exr", as_float, [](const std::string& channel, float value) {
    return channel == "id.object" ? value / 255.0f : value;
  });
  check_refused(judged(folder, {"--gbuffer", "part.exr"}), 3, "and an identifier is a whole number (store the channel");
}

TEST_CASE("A wrong channel goes by the name that its plane gives it") {
  const ScratchFolder folder;
  write_capture(folder);
  const auto check_named = [&](const std::string& plane, int channel, const std::string& name) {
    write_changed(folder, "x.exr", plane, [&](Image& image) { set_float(image, 90, 100, channel, 7e4f); });
    const Outcome outcome = judged(folder, {"--gbuffer", "x.exr", "--json"});
    INFO(outcome.out << outcome.err);
    CHECK(outcome.exit_code == 1);
    CHECK(has(outcome.out, "\"plane\":\"" + name + "\""));
  };
  check_named("position", 2, "position.Z");
  check_named("normal", 1, "normal.Y");
  check_named("uv", 1, "uv.V");
  check_named("depth", 0, "depth.Z");
}

TEST_CASE("Of the profiles that were tried the one with the fewest pixels against it, over all stages, comes first") {
  const ScratchFolder folder;
  write_capture(folder);
  // Wrong in both stages: what fails its geometry is not spared the count of its lights.
  write_changed(folder, "a.exr", "normal", [](Image& i) { set_float(i, 90, 60, 0, 0.25f); });
  std::filesystem::rename(folder.path("a.exr"), folder.path("c.exr"));
  write_changed(folder, "b.exr", "color", [](Image& i) {
    for (int x = 100; x < 140; ++x) set_float(i, x, 70, 1, 1.0f);
  });
  const Outcome outcome =
      run_command({"validate", "builtin:cornell", "--gbuffer", "b.exr", "-o", "v.html", "--json"}, folder.path(""));
  INFO(outcome.err);
  REQUIRE(outcome.exit_code == 1);
  const auto inferred = nlohmann::json::parse(outcome.out)["verdict"]["inferred"];
  int named = 0;
  uint64_t before = 0;
  std::string nearest;
  for (const auto& guess : inferred["tried"]) {
    if (guess["knob"] != "profile") continue;
    if (named++ == 0) nearest = guess["value"];
    CHECK(guess["gbuffer"].get<uint64_t>() >= 1);
    CHECK(guess["lighting"].get<uint64_t>() >= 40);
    CHECK(guess["violations"] == guess["gbuffer"].get<uint64_t>() + guess["lighting"].get<uint64_t>());
    CHECK(guess["violations"].get<uint64_t>() >= before);
    before = guess["violations"];
  }
  CHECK(named == 4);
  CHECK(inferred["known_as"] == "");
  CHECK(inferred["nearest"] == nearest);
  CHECK(has(run_command({"validate", "builtin:cornell", "--gbuffer", "b.exr"}, folder.path("")).out,
            "no named profile explains it, " + nearest + " comes nearest with "));
}

TEST_CASE("what OpenGL draws here is explained, pixel by pixel") {
  for (const char* driver : {"llvmpipe", "softpipe"})
    for (const char* scene : {"builtin:city", "builtin:sphere", "builtin:cornell"})
      for (const char* preset : {"many-lights", "touchdesigner"}) {
        if (driver == std::string("softpipe") && scene == std::string("builtin:city"))
          continue;  // 12 s of 757 lights a pixel
        INFO(scene << ' ' << preset << ' ' << driver);
        const Outcome outcome =
            run_command({"validate", scene, "--preset", preset, "--driver", driver, "--size", "200x150", "--quick"});
        if (outcome.exit_code == kNoDriver) {
          check_refused(outcome, kNoDriver, "OpenGL");
          WARN("SKIPPED: " << outcome.err);
          break;
        }
        INFO(outcome.out << outcome.err);
        CHECK(outcome.exit_code == 0);
        CHECK(has(outcome.out, driver));
        CHECK(has(outcome.out, "every pixel is explained"));
        CHECK(has(outcome.out, "drawn again 0 pixels change"));
        CHECK_FALSE(has(outcome.out, "not what chance makes"));
      }
}

TEST_CASE("a capture of lights blended one by one is judged by its last image, materials from their planes") {
  const ScratchFolder folder;
  const auto drawn = [&](const std::string& planes) {
    const Outcome outcome = run_command({"render", "builtin:cornell", "--preset", "gl-fixed", "--strategy",
                                         "deferred-volumes", "--size", "80x60", "-o", "c.exr", "--aov", planes},
                                        folder.path(""));
    REQUIRE(outcome.exit_code == 0);
    return judged(folder, {"--gbuffer", "c.exr", "--preset", "gl-fixed", "--strategy", "deferred-volumes",
                           "--subpixel-bits", "8"});
  };
  const Outcome whole = drawn("depth,position,normal,albedo,specular,emission,id.object,id.material");
  INFO(whole.out << whole.err);
  CHECK(whole.exit_code == 0);
  CHECK(has(whole.out, "lighting: 4800 pixels"));
  check_refused(drawn("depth,position,normal,albedo,emission,id.object"), 3, "specular");
  const Outcome dark = drawn("depth,position,normal,albedo,specular,id.object");
  INFO(dark.out << dark.err);
  CHECK(dark.exit_code == 0);  // no material fills the plane of emission
}

TEST_CASE("a capture needs the plane of emission where a material fills it") {
  const ScratchFolder folder;
  const auto validated = [&](const char* material, const std::string& planes) {
    folder.write("s.json", std::string(R"({"version": 1, "textures": [{"name": "t", "pattern": {"type": "checker"}}],
      "materials": [{"name": "m", "color": [1, 1, 1], )") +
                               material + R"(}],
      "objects": [{"mesh": "cube", "material": "m"}], "lights": [{"type": "ambient", "color": [0.5, 0.5, 0.5]}]})");
    const Outcome drawn =
        run_command({"render", "s.json", "--preset", "gl-fixed", "--size", "40x30", "-o", "c.exr", "--aov", planes},
                    folder.path(""));
    REQUIRE(drawn.exit_code == 0);
    return run_command({"validate", "s.json", "--quick", "--gbuffer", "c.exr", "--preset", "gl-fixed", "--size",
                        "40x30", "--subpixel-bits", "8"},
                       folder.path(""));
  };
  const std::string without = "depth,position,normal,albedo,specular,id.object";
  for (const char* material :
       {R"("emission": [0.1, 0, 0])", R"("unlit": true)", R"("occlusion_map": {"texture": "t"})"}) {
    INFO(material);
    check_refused(validated(material, without), 3, "emission");
    CHECK(validated(material, without + ",emission").exit_code == 0);
  }
  CHECK(validated(R"("occlusion_strength": 0.5)", without).exit_code == 0);
}

TEST_CASE("what the driver drew is saved as a picture, and as a capture that is judged alike") {
  const ScratchFolder folder;
  const Outcome drawn =
      judged(folder, {"--driver", "llvmpipe", "--size", "120x90", "--save", "c.exr", "--save", "c.png"});
  if (drawn.exit_code == kNoDriver) {
    WARN("SKIPPED: " << drawn.err);
    return;
  }
  INFO(drawn.out << drawn.err);
  CHECK(drawn.exit_code == 0);
  CHECK(folder.entries() == Arguments{"c.exr", "c.png"});
  const Outcome again = judged(folder, {"--gbuffer", "c.exr", "--image", "c.png", "--subpixel-bits", "8"});
  INFO(again.out << again.err);
  CHECK(again.exit_code == 0);
  CHECK(has(again.out, "lighting: 10800 pixels"));
  check_refused(judged(folder, {"--save", "c.jpg"}), 2, "--save");
  check_refused(judged(folder, {"--gbuffer", "c.exr", "--save", "d.png"}), 2, "--save");
}

TEST_CASE("what is saved of any preset, and of normals of ten bits, is a capture") {
  const ScratchFolder folder;
  std::ofstream(folder.path("n.json")) << R"({"gbuffer":{"normal":{"format":"rgb10_a2"}}})";
  for (const Arguments& pipeline : {Arguments{"--preset", "punctual"},
                                    {"--preset", "gl-fixed"},
                                    {"--preset", "redsdk"},
                                    {"--pipeline", "n.json"}}) {
    Arguments draw{"--driver", "llvmpipe", "--size", "64x48", "--save", "c.exr"};
    Arguments judge{"--gbuffer", "c.exr", "--subpixel-bits", "8"};
    draw.insert(draw.end(), pipeline.begin(), pipeline.end());
    judge.insert(judge.end(), pipeline.begin(), pipeline.end());
    const Outcome drawn = judged(folder, draw);
    if (drawn.exit_code == kNoDriver) {
      WARN("SKIPPED: " << drawn.err);
      return;
    }
    const Outcome again = judged(folder, judge);
    INFO(pipeline[1] << drawn.out << drawn.err << again.out << again.err);
    CHECK(drawn.exit_code == 0);
    CHECK(again.exit_code == 0);
    CHECK(has(again.out, "lighting: 3072 pixels"));
  }
}

TEST_CASE("a driver's report and JSON name the driver and the tightest profile") {
  const ScratchFolder folder;
  const Outcome outcome = run_command(
      {"validate", "builtin:cornell", "--driver", "llvmpipe", "--size", "200x150", "--json", "-o", "v.html"},
      folder.path(""));
  if (outcome.exit_code == kNoDriver) {
    WARN("SKIPPED: " << outcome.err);
    CHECK(folder.entries().empty());
    return;
  }
  CHECK(outcome.exit_code == 0);
  CHECK(has(outcome.out, "\"driver\":\"Mesa"));
  CHECK(has(outcome.out, "\"known_as\":\"mesa-llvmpipe"));
  CHECK(has(outcome.out, "\"violations\":"));
  CHECK(folder.entries() == Arguments{"v.html"});
}

TEST_CASE("stores that lean as a known driver's do are named, in text and JSON, and no rejection") {
  const ScratchFolder folder;
  for (const char* target : {"srgb8_a8", "rgb10_a2"}) {  // whose codes llvmpipe does not round to the nearest
    folder.write("p.json", std::string(R"({"target":")") + target + "\"}");
    const Arguments draw = {"--driver", "llvmpipe", "--size", "80x60", "--pipeline", "p.json"};
    const Outcome told = judged(folder, draw);
    if (told.exit_code == kNoDriver) {
      WARN("SKIPPED: " << told.err);
      return;
    }
    INFO(told.out << told.err);
    CHECK(told.exit_code == 0);
    const bool is_known =
        has(told.out, "codes as llvmpipe's, halves toward zero, as known implementations do") ||
        has(told.out, "codes as llvmpipe's on Intel, halves toward zero, as known implementations do");
    CHECK(is_known);
    CHECK(has(told.out, "verdict     every pixel is explained\n"));
    Arguments json = draw;
    json.emplace_back("--json");
    const Outcome listed = judged(folder, json);
    CHECK(listed.exit_code == 0);
    CHECK(has(listed.out, R"("pass":true,"convicted":false,"suspicious":true)"));
    CHECK(has(listed.out, R"("VIOLATION":0)"));
  }
}

TEST_CASE(
    "a picture that no known rounding makes is a failure, a remark with --lenient, and its evidence is one line") {
  // Sixty lights, each of which adds 0.4 codes to each pixel, or 0.6: rounded, each of them adds 0 or 1, and either is
  // legal. So the sum may be anything from 0 to 60 codes, and the second picture is no other neighbour of the first.
  const auto scene = [](double codes) {
    std::string lights;
    for (int i = 0; i < 60; ++i)
      lights += std::string(i > 0 ? "," : "") + R"({"type":"point","position":[)" + std::to_string(0.02 * i - 0.6) +
                R"(,0.1,6],"range":60,"color":[1,1,1],"intensity":)" + std::to_string(codes / 255 * 1.12) + "}";
    return R"({"version":1,"camera":{"eye":[0,0,3],"target":[0,0,0]},"objects":[{"geometry":"quad.ply","color":[1,1,1]}],)"
           R"("lights":[)" +
           lights + "]}";
  };
  const ScratchFolder folder;
  folder.write("quad.ply",
               "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
               "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
               "-1 -1 0\n1 -1 0\n1 1 0\n-1 1 0\n3 0 1 2\n3 0 2 3\n");
  folder.write("stated.json", scene(0.4)), folder.write("other.json", scene(0.6));
  folder.write("p.json", R"({"strategy":"deferred-volumes","light_model":{"specular":"none"}})");
  const Outcome drawn = run_command({"render", "other.json", "--pipeline", "p.json", "--size", "64x48", "-o", "c.exr",
                                     "--aov", "depth,position,normal,albedo,id.object"},
                                    folder.path(""));
  INFO(drawn.err);
  REQUIRE(drawn.exit_code == 0);
  const auto judge = [&](const Arguments& more) {
    Arguments all = {"validate", "stated.json", "--pipeline", "p.json", "--gbuffer", "c.exr", "--quick"};
    all.insert(all.end(), more.begin(), more.end());
    return run_command(all, folder.path(""));
  };
  const Outcome failed = judge({}), lenient = judge({"--lenient"}), json = judge({"--json"});
  INFO(failed.out << failed.err);
  CHECK(failed.exit_code == 1);
  CHECK(has(failed.out, "VIOLATION          0"));
  CHECK(has(failed.out, "evidence    lighting, "));
  CHECK(has(failed.out, "each pixel is legal, yet no rounding that is known makes such an image\n"));
  CHECK(lenient.exit_code == 0);
  CHECK(has(lenient.out, "(a remark, as --lenient asks)"));
  CHECK(json.exit_code == 1);
  CHECK(
      has(json.out, R"("pass":false,"convicted":true,"suspicious":true,"significance":1e-06,"evidence":"lighting, )"));
  CHECK(judge({"--profile", "ideal"}).exit_code == 1);  // by its pixels
  for (const char* chance : {"0", "-1e-6", "0.02", "nan", "1e-6x", ""})
    CHECK(judge({"--significance", chance}).exit_code == 2);
}

TEST_CASE("a capture without what its picture's lights are judged from is refused by its file's name") {
  const ScratchFolder folder;
  const std::string where = "trueshade: error: few.exr: ";
  const auto with = [&](const char* planes, const Arguments& more) {
    REQUIRE(
        run_command({"render", "builtin:cornell", "--size", "32x24", "-o", "few.exr", "--aov", planes}, folder.path(""))
            .exit_code == 0);
    Arguments options = {"--gbuffer", "few.exr", "--subpixel-bits", "8"};
    options.insert(options.end(), more.begin(), more.end());
    return judged(folder, options);
  };
  const auto refused = [&](const Outcome& outcome, const std::string& message) {
    INFO(outcome.err);
    CHECK(outcome.exit_code == 3);
    CHECK(outcome.err.substr(0, message.size()) == message);
    CHECK(outcome.out.empty());
  };
  refused(with("depth,position,albedo", {}), where + "plane normal: is missing (");
  refused(with("depth,normal,albedo", {}), where + "plane position: is missing (");
  refused(with("position,normal,albedo", {}), where + "does not say where a surface is (");
  refused(with("depth,position,normal,albedo", {"--size", "64x48"}), where);
}

TEST_CASE("a post chain is not judged, and text, JSON and page say so") {
  const ScratchFolder folder;
  folder.write("p.json", R"({"target": "rgba16f", "post": {"tone_map": "reinhard", "encode": "srgb"}})");
  REQUIRE(run_command({"render", "builtin:cornell", "--pipeline", "p.json", "--size", "64x48", "-o", "c.exr", "--aov",
                       "depth,position,normal,albedo,id.object"},
                      folder.path(""))
              .exit_code == 0);
  folder.write("q.json", R"({"target": "rgba16f"})");
  REQUIRE(run_command({"render", "builtin:cornell", "--pipeline", "q.json", "--size", "64x48", "-o", "t.exr", "--aov",
                       "depth,position,normal,albedo,id.object"},
                      folder.path(""))
              .exit_code == 0);
  const Outcome target = judged(folder, {"--gbuffer", "t.exr", "--pipeline", "p.json", "-o", "v.html"});
  INFO(target.out << target.err);
  CHECK(target.exit_code == 0);
  CHECK(has(target.out, "note        the post chain is not judged"));
  CHECK(has(target.out, "verdict     every pixel is explained; the post chain is not judged"));
  CHECK(has(contents(folder.path("v.html")), "the post chain is not judged"));
  const Outcome listed = judged(folder, {"--gbuffer", "t.exr", "--pipeline", "p.json", "--json"});
  CHECK(has(listed.out, R"("post_chain": "not judged")"));
  CHECK(has(judged(folder, {"--gbuffer", "t.exr", "--pipeline", "q.json", "--json"}).out, R"("post_chain": "none")"));
  // The finished picture is another than the target.
  CHECK(judged(folder, {"--gbuffer", "t.exr", "--image", "c.exr", "--pipeline", "p.json"}).exit_code != 0);
}

TEST_CASE("without a driver validate is exit 7, says what to install, and leaves nothing behind") {
  const ScratchFolder folder;
  check_refused(run_command({"validate", "builtin:cornell", "--size", "50x50", "-o", "v.html"}, folder.path(""),
                            "export __EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent.json"),
                kNoDriver, "OpenGL");
  CHECK(folder.entries().empty());
}

TEST_CASE("our own frame is a capture like any other, and explained") {
  const ScratchFolder folder;
  write_capture(folder);
  for (const Arguments& files : {Arguments{"--gbuffer", "c.exr"}, Arguments{"--gbuffer", "c.exr", "--image", "c.png"},
                                 Arguments{"--gbuffer", "c.exr", "--image", "c.exr", "--size", "200x150"},
                                 Arguments{"--gbuffer", "c.exr", "--profile", "ideal"}}) {
    const Outcome outcome = judged(folder, files);
    INFO(outcome.out << outcome.err);
    CHECK(outcome.exit_code == 0);
    CHECK(has(outcome.out, "lighting: 30000 pixels"));
  }
}

TEST_CASE("a capture is judged at its time: the lights have moved") {
  const ScratchFolder folder;
  const Outcome drawn = run_command({"render", "builtin:cornell", "--size", "120x90", "--time", "3.5", "-o", "c.exr",
                                     "--aov", "depth,position,normal,albedo,uv,id.object,id.material"},
                                    folder.path(""));
  REQUIRE(drawn.exit_code == 0);
  const Outcome same = judged(folder, {"--gbuffer", "c.exr", "--time", "3.5"});
  INFO(same.out << same.err);
  CHECK(same.exit_code == 0);
  CHECK(judged(folder, {"--gbuffer", "c.exr", "--time", "3"}).exit_code == 1);
  CHECK(judged(folder, {"--gbuffer", "c.exr"}).exit_code == 1);
  check_refused(judged(folder, {"--gbuffer", "c.exr", "--time", "soon"}), 2, "--time");
}

TEST_CASE("one wrong value in a capture is found at its pixel") {
  const ScratchFolder folder;
  write_capture(folder);
  const auto check_found = [&folder](const Arguments& files, const std::string& place) {
    const Outcome outcome = judged(folder, files);
    INFO(outcome.out << outcome.err);
    CHECK(outcome.exit_code == 1);
    CHECK(has(outcome.out, place));
    CHECK(has(outcome.out, "in no legal set"));
  };
  write_changed(folder, "color.exr", "color", [](Image& i) { set_float(i, 100, 70, 1, 1.0f); });
  check_found({"--gbuffer", "color.exr"}, "100,70     VIOLATION  color.G gave 255");
  write_changed(folder, "normal.exr", "normal", [](Image& i) { set_float(i, 90, 60, 0, 0.25f); });
  check_found({"--gbuffer", "normal.exr"}, "90,60      VIOLATION");
  write_changed(folder, "depth.exr", "depth", [](Image& i) { set_float(i, 80, 50, 0, 0.5f); });
  check_found({"--gbuffer", "depth.exr", "-o", "v.html"}, "80,50      VIOLATION  depth");
  std::vector<NamedImage> picture = read_planes(folder.path("c.png"));
  for (int k = 0; k < 3; ++k) picture[0].image.texel(120, 80)[k] = 0;
  write_image(folder.path("hole.png"), picture[0].image, {}, {});
  check_found({"--gbuffer", "c.exr", "--image", "hole.png"}, "120,80     VIOLATION  color");
  check_found({"--gbuffer", "c.exr", "--preset", "touchdesigner"}, "VIOLATION");
}

TEST_CASE("captures that cannot be judged are refused, and nothing is left behind") {
  const ScratchFolder folder;
  write_capture(folder);
  const std::vector<NamedImage> planes = read_planes(folder.path("c.exr"));
  write_image(folder.path("bare.exr"), planes[0].image, {{planes[1]}}, {});  // the target and depth alone
  write_image(folder.path("small.png"), Image(20, 15, Format::rgba8), {}, {});
  write_changed(folder, "grey.exr", "albedo", [](Image& i) { set_float(i, 3, 4, 0, 0.5f); });  // between two codes
  std::ofstream(folder.path("torn.exr"), std::ios::binary)
      << std::ifstream(folder.path("c.exr"), std::ios::binary).rdbuf();
  std::filesystem::resize_file(folder.path("torn.exr"), 20000);
  const auto before = folder.entries();
  const auto check = [&folder](Arguments options, int exit_code, const std::string& about) {
    options.insert(options.end(), {"-o", "v.html"});
    check_refused(judged(folder, options), exit_code, about);
  };
  check({"--gbuffer", "bare.exr"}, 3, "plane normal");
  check({"--gbuffer", "torn.exr"}, 3, "torn.exr");
  check({"--gbuffer", "c.png"}, 3, "c.png");
  check({"--gbuffer", "grey.exr"}, 3, "albedo at 3,4");
  check({"--gbuffer", "c.exr", "--image", "small.png"}, 3, "20x15");
  check({"--gbuffer", "c.exr", "--size", "100x100"}, 3, "200x150");
  check({"--gbuffer", "absent.exr"}, 5, "absent.exr");
  check({"--image", "c.png"}, 2, "--gbuffer");
  check({"--gbuffer", "c.exr", "--profile", "voodoo"}, 2, "voodoo");
  check({"--driver", "glide"}, 2, "glide");
  check({"--driver", "llvmpipe", "--gbuffer", "c.exr"}, 2, "--driver");
  check({"--subpixel-bits", "3"}, 2, "--subpixel-bits");
  check_refused(judged(folder, {"--gbuffer", "c.exr", "-o", "v.txt"}), 2, "v.txt");
  check_refused(run_command({"validate"}), 2, "SCENE");
  CHECK(has(run_command({"validate", "--help"}).out, "trueshade validate [OPTIONS] SCENE"));
  CHECK(folder.entries() == before);
}

}  // namespace trueshade
