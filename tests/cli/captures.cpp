// Captures as engines have them: one scene by each kind of file is judged the same, wrong maps are convicted or
// refused, and bad files are refused in one line.
#include <filesystem>

#include "tests/cli/drawn_capture.h"
#include "tests/cli/refused.h"
#include "tests/file_contents.h"

namespace trueshade {

TEST_CASE("One scene captured in each kind of file is judged the same") {
  const DrawnCapture c;
  const nlohmann::json expected = c.counts({"--gbuffer", "c.exr"});
  CHECK(violations(expected) == 0);
  const auto check = [&](const char* route, const Arguments& options) {
    INFO(route);
    CHECK(c.counts(options) == expected);
  };
  const Arguments xyz = {"P.X", "P.Y", "P.Z"}, nxyz = {"N.X", "N.Y", "N.Z"}, rgba = {"R", "G", "B", "A"},
                  albedo = {"albedo.R", "albedo.G", "albedo.B", "albedo.A"};

  const std::vector<EnginePart> parts = {
      {"geometry", xyz, "float", &c.position},   {"normals", nxyz, "float", &c.normal},
      {"materials", albedo, "float", &c.albedo}, {"z", {"depth.Z"}, "float", &c.depth},
      {"ids", {"id.object"}, "uint", &c.object}, {"lit", rgba, "float", &c.color}};
  write_exr_parts(c.path("parts.exr"), parts);
  check("parts of an EXR", {"--gbuffer", "parts.exr"});
  write_exr_parts(c.path("tiles.exr"), parts, 32);
  check("parts of an EXR in tiles", {"--gbuffer", "tiles.exr"});
  Arguments files;
  for (const EnginePart& part : parts) {
    write_exr_parts(c.path(part.name + ".exr"), {{"", part.channels, part.type, part.plane}},
                    part.name == "z" ? 16 : 0);
    files.insert(files.end(), {"--gbuffer", part.name + ".exr"});
  }
  check("an EXR a plane, by usual channels", files);

  const EnginePlane position4 = repacked(c.position, 4, [](const double* from, double* to) {
    std::copy(from, from + 3, to);
    to[3] = 1;
  });
  const EnginePlane normal4 =
      repacked(c.normal, 4, [](const double* from, double* to) { std::copy(from, from + 3, to); });
  for (const auto& [name, plane] : {std::pair{"t0", &position4}, {"t1", &normal4}, {"t2", &c.albedo}, {"t3", &c.color}})
    write_exr_parts(c.path(std::string(name) + ".exr"), {{"", rgba, "float", plane}});
  write_exr_parts(c.path("t4.exr"), {{"", {"R"}, "float", &c.depth}});
  write_exr_parts(c.path("t5.exr"), {{"", {"R"}, "uint", &c.object}});
  check("an EXR a texture, as RenderDoc saves them",
        {"--gbuffer", "t0.exr", "--gbuffer", "t1.exr", "--gbuffer", "t2.exr", "--map",
         "position=t0.RGB,normal=t1.XYZ,albedo=t2.RGBA,depth=t4.exr.R,id.object=t5.exr,color=t3.exr.RGBA"});

  write_dds(c.path("p.dds"), position4, 2);
  write_dds(c.path("n.dds"), normal4, 2);
  write_dds(c.path("a.dds"), c.albedo, 28);
  write_dds(c.path("d.dds"), c.depth, 40);
  write_dds(c.path("i.dds"), c.object, 42);
  write_dds(c.path("lit.dds"), c.color, 87);
  check("DDS of RGBA32F, RGBA8, D32, R32UI and BGRA8",
        {"--map", "position=p.dds.RGB,normal=n.dds.RGB,albedo=a.dds,depth=d.dds,id.object=i.dds,color=lit.dds"});

  const std::string npy_map = "position=p.npy,normal=n.npy,albedo=a.npy,depth=d.npy,id.object=i.npy,color=lit.npy";
  for (const bool fortran : {false, true})
    for (const char* type : {"<f4", ">f4", "<f8"}) {
      INFO(type << (fortran ? ", Fortran order" : ""));
      write_npy(c.path("p.npy"), c.position, type, fortran);
      write_npy(c.path("n.npy"), c.normal, type, fortran);
      write_npy(c.path("d.npy"), c.depth, type, fortran);
      write_npy(c.path("i.npy"), c.object, fortran ? ">i8" : "|u1", fortran);
      const auto codes = [](const double* from, double* to) {
        for (int k = 0; k < 4; ++k) to[k] = std::round(255 * from[k]);
      };
      write_npy(c.path("a.npy"), repacked(c.albedo, 4, codes), "|u1", fortran);
      write_npy(c.path("lit.npy"), repacked(c.color, 4, codes), "|u1", fortran);
      check(".npy", {"--map", npy_map});
    }
  c.folder.write("map.txt",
                 "# the engine's targets\nposition = p.npy\nnormal=n.npy  # world space\n"
                 "albedo=a.npy\ndepth=d.npy, id.object=i.npy\ncolor=lit.npy\n");
  check("a map in a file", {"--map", "@map.txt"});
  std::filesystem::create_directory(c.path("sub"));
  for (const char* name : {"p.npy", "n.npy", "a.npy", "d.npy", "i.npy", "lit.npy", "map.txt"})
    std::filesystem::copy(c.path(name), c.path(std::string("sub/") + name));
  check("a map in a folder of its own", {"--map", "@sub/map.txt"});

  EnginePlane all{c.position.width, c.position.height, 12, {}};
  for (int y = 0; y < all.height; ++y)
    for (int x = 0; x < all.width; ++x)
      for (const EnginePlane* p : {&c.position, &c.normal, &c.albedo, &c.depth, &c.object})
        for (int k = 0; k < p->channels; ++k) all.values.push_back(p->at(x, y, k));
  write_npy(c.path("all.npy"), all, "<f4");
  check("all planes in one array, by numbers, identifiers as floats",
        {"--gbuffer", "all.npy", "--map", "position=0-2,normal=3-5,albedo=all.6-9,depth=10,id.object=all.npy.11",
         "--image", "c.png"});

  for (const auto& [compression, tile] : {std::pair{"none", 0}, {"zip", 0}, {"zip", 32}}) {
    INFO(compression << ' ' << tile);
    write_tiff(c.path("p.tif"), c.position, "float", compression, tile);
    write_tiff(c.path("n.tif"), c.normal, "float", compression, tile);
    write_tiff(c.path("a.tif"), c.albedo, "uint8", compression, tile);
    write_tiff(c.path("d.tif"), c.depth, "float", compression, tile);
    write_tiff(c.path("i.tif"), c.object, "float", compression, tile);
    write_tiff(c.path("lit.tif"), c.color, "uint8", compression, tile);
    check("TIFF", {"--map", "position=p.tif,normal=n.tif,albedo=a.tif,depth=d.tif,id.object=i.tif,color=lit.tif"});
  }

  write_npy(c.path("p.npy"), bottom_up(c.position), "<f4");
  write_npy(c.path("n.npy"), bottom_up(c.normal), "<f4");
  check(
      "rows from the bottom, of two planes",
      {"--gbuffer", "c.exr", "--map", "position=p.npy:bottom_up,normal=n.npy:bottom_up,albedo,depth,id.object,color"});
  for (const auto& [name, plane] : {std::pair{"a", &c.albedo}, {"lit", &c.color}, {"d", &c.depth}, {"i", &c.object}})
    write_npy(c.path(std::string(name) + ".npy"), bottom_up(*plane), "<f4");
  check("rows from the bottom, of all", {"--map", npy_map + ",rows=bottom_up"});
}

TEST_CASE("A wrong map is convicted or refused") {
  const DrawnCapture c;
  const Axes axes = axes_of(c);
  const std::string rest = "albedo,id.object,color";
  const auto check_convicted = [&](const std::string& map) {
    INFO(map);
    const Outcome outcome = c.judge({"--gbuffer", "c.exr", "--map", map});
    INFO(outcome.err);
    CHECK(outcome.exit_code == 1);
  };
  const auto check_map_refused = [&](const std::string& map, int code, const std::string& about) {
    INFO(map);
    check_refused(c.judge({"--gbuffer", "c.exr", "--map", map, "-o", "v.html"}), code, about);
    CHECK_FALSE(std::filesystem::exists(c.path("v.html")));
  };
  write_npy(c.path("n01.npy"),
            repacked(c.normal, 3,
                     [](const double* n, double* e) {
                       for (int k = 0; k < 3; ++k) e[k] = n[k] * 0.5 + 0.5;
                     }),
            "<f4");
  check_convicted(rest + ",depth,position,normal=n01.npy");
  check_map_refused(rest + ",depth,position,normal=c.N.XYZ:unorm", 3, "and unorm numbers are from 0 to 1");
  check_map_refused(rest + ",depth,position,normal=n01.npy:unorm8", 3, "which is no code of 8 bits");
  check_convicted(rest + ",depth,position,normal=c.N.XY:octahedral");
  check_convicted(rest + ",depth,position,normal=c.N.XYZ:view");
  check_convicted(rest + ",depth,normal,position=c.P.XYZ:view");
  check_convicted(rest + ",depth,normal,position=c.P.XYZ:bottom_up");
  check_convicted(rest + ",depth,normal,position=c.P.ZYX");
  check_convicted(rest + ",depth=c.Z,position,normal");
  check_convicted(rest + ",depth=c.depth.Z:reversed,position,normal");
  check_convicted(rest + ",depth=c.depth.Z:linear,position,normal");
  check_convicted(rest + ",depth,normal,position=c.depth.Z:linear");
  EnginePlane view = repacked(c.normal, 3, [&](const double* n, double* e) { to_view(axes, n, e); });
  write_npy(c.path("vn.npy"), view, "<f4");
  check_convicted(rest + ",depth,position,normal=vn.npy");
  check_convicted(rest + ",depth,position,normal=vn.npy:view_z_away");
  check_map_refused("position,nromal=c.N.XYZ", 2, "there is no plane 'nromal' of a capture");
  check_map_refused("position=c.P.XYZ:octahedral", 2, "'octahedral' is not said of plane position");
  check_map_refused("normal=c.N.XY:octahedral:spheremap", 2, "contradict each other");
  check_map_refused("depth=c.depth.Z:times=2", 2, "'times' is said of a distance");
  check_map_refused("depth=c.depth.Z:linear:times=-1", 2, "times=-1");
  check_map_refused("depth=c.depth.Z:linear:times=1:times=3", 2, "said twice");
  check_map_refused("normal=c.N.XYZ:times=1", 2, "'times' is not said of plane normal");
  check_map_refused("normal=c.N.XYZ:octahedral", 3, "plane normal takes 2 channels, not 3");
  check_map_refused("normal=c.N.XYW", 3, "there are no channels 'N.XYW' for plane normal");
  check_map_refused("normal=none.exr.RGB", 5, "none.exr");
  check_map_refused("normal=c.N.XYZ,normal=c.N.XYZ", 2, "plane normal is named twice");
  check_map_refused("@none.txt", 5, "none.txt");
  c.folder.write("map.txt", "position\nnormal=c.N.XYZ:wiev\n");
  check_map_refused("@map.txt", 3, "map.txt: line 2: there is no word 'wiev'");
}

TEST_CASE("A value that a plane was cleared to says nothing, and what is left there of something else does") {
  const DrawnCapture c;
  EnginePlane cleared = c.normal;
  uint64_t empty = 0;
  for (int y = 0; y < 90; ++y)
    for (int x = 0; x < 120; ++x) {
      if (cleared.at(x, y, 0) != 0 || cleared.at(x, y, 1) != 0 || cleared.at(x, y, 2) != 0) continue;
      ++empty;
      cleared.at(x, y, 0) = cleared.at(x, y, 1) = 0.5, cleared.at(x, y, 2) = 1;
    }
  REQUIRE(empty > 100);
  const std::vector<std::string> map = {"--gbuffer", "c.exr", "--map",
                                        "position,albedo,depth,id.object,color,normal=cleared.npy"};
  write_npy(c.path("cleared.npy"), cleared, "<f4");
  const Outcome passed = c.judge(map);
  INFO(passed.out);
  CHECK(passed.exit_code == 0);
  CHECK(passed.out.find("normal holds one value wherever there is no surface") != std::string::npos);
  for (int y = 0; y < 90; ++y)
    for (int x = 0; x < 120; ++x)
      if (cleared.at(x, y, 2) == 1 && cleared.at(x, y, 0) == 0.5) cleared.at(x, y, 1) = 0.5 + 0.001 * x;
  write_npy(c.path("cleared.npy"), cleared, "<f4");
  CHECK(c.judge(map).exit_code == 1);
}

TEST_CASE("A bad file of a capture is refused in one line, and no report is left behind") {
  const DrawnCapture c;
  const auto check_bad = [&](const std::string& normal, int code, const std::string& about) {
    INFO(normal);
    const std::string map = "position,albedo,depth,id.object,color,normal=" + normal;
    check_refused(c.judge({"--gbuffer", "c.exr", "--map", map, "-o", "v.html"}), code, about);
    CHECK_FALSE(std::filesystem::exists(c.path("v.html")));
  };
  const Arguments rgb = {"R", "G", "B"};
  write_exr_parts(c.path("n.exr"), {{"", rgb, "float", &c.normal}});
  write_npy(c.path("n.npy"), c.normal, "<f4");
  write_tiff(c.path("n.tif"), c.normal, "float", "zip");
  write_dds(c.path("n.dds"), c.normal, 2);
  for (const std::string name : {"n.exr", "n.npy", "n.tif", "n.dds"}) {
    const std::string whole = contents(c.path(name));
    for (const double share : {0.0, 0.001, 0.01, 0.5, 0.98}) {
      INFO(name << " cut to " << share);
      c.folder.write("torn" + name, whole.substr(0, size_t(share * double(whole.size()))));
      check_bad("torn" + name + ".RGB", 3, "torn" + name);
    }
  }
  EnginePlane small{60, 90, 3, std::vector<double>(60 * 90 * 3)};
  write_npy(c.path("small.npy"), small, "<f4");
  check_bad("small.npy", 3, "it is 60x90, and the G-buffer 120x90");
  EnginePlane broken = c.normal;
  broken.at(60, 60, 1) = NAN;
  write_npy(c.path("nan.npy"), broken, "<f4");
  check_bad("nan.npy", 3, "normal at 60,60 is not a number");
  check_bad("nan.npy:unit", 3, "normal at 60,60 is ");
  check_bad("c.png.RGB", 3, "normal is stored in codes from 0 to 1, which hold no negative numbers (say unorm)");
  write_exr_parts(c.path("hd.exr"), {{"", {"R"}, "half", &c.depth}});
  check_refused(c.judge({"--gbuffer", "c.exr", "--map", "position,normal,depth=hd.exr.R", "-o", "v.html"}), 3,
                "depth is stored as half, and the pipeline's as d32f");
  c.folder.write("x.npy", std::string("\x93NUMPY\x01\x00\x10\x00{'descr': '<f4'}", 26));
  check_bad("x.npy", 3, "x.npy");
  c.folder.write("x.jpg", "\xff\xd8\xff\xe0 and more");
  check_refused(c.judge({"--gbuffer", "x.jpg"}), 3, "it is JPEG, which does not keep a plane's values");
  check_refused(c.judge({"--map", "rows=bottom_up"}), 3, "it names no plane, and there is no file of planes");
}

TEST_CASE("A fourth channel beside a plane of three is left out where it says nothing, and refused where it does") {
  const DrawnCapture c;
  c.folder.write("p.json", R"({"gbuffer": {"albedo": {"format": "rgb16f"}}})");
  const Outcome drawn = run_command({"render", kScene, "--size", "120x90", "--pipeline", "p.json", "-o", "h.exr",
                                     "--aov", "depth,position,normal,albedo,id.object"},
                                    c.path(""));
  REQUIRE(drawn.exit_code == 0);
  std::vector<NamedImage> planes = read_planes(c.path("h.exr"));
  EnginePlane albedo;
  for (const NamedImage& plane : planes)
    if (plane.name == "albedo") albedo = engine_plane(plane.image);
  REQUIRE(albedo.channels == 3);
  EnginePlane with_alpha = repacked(albedo, 4, [](const double* from, double* to) {
    std::copy(from, from + 3, to);
    to[3] = from[0] + from[1] + from[2] > 0 ? 1 : 0;
  });
  const auto judged = [&] {
    write_exr_parts(c.path("a.exr"), {{"", {"R", "G", "B", "A"}, "half", &with_alpha}});
    return c.judge(
        {"--pipeline", "p.json", "--gbuffer", "h.exr", "--map", "depth,position,normal,id.object,color,albedo=a.exr"});
  };
  CHECK(judged().exit_code == 0);
  with_alpha.at(60, 80, 3) = 0.5;
  check_refused(judged(), 3, "and rgb16f has no alpha (leave albedo.A out, or name a format with alpha in --pipeline)");
}

}  // namespace trueshade
