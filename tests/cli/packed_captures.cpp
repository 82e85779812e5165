// Packed planes: what their codes say is judged, and faults in them are found.
#include "core/half.h"
#include "tests/cli/drawn_capture.h"

namespace trueshade {

TEST_CASE("Normals made unit and stored as the pipeline's halves are legal, whatever floats a file holds them in") {
  const DrawnCapture c;
  const EnginePlane halves = repacked(c.normal, 3, [](const double* n, double* e) {
    const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int k = 0; k < 3; ++k)
      e[k] = length > 0 ? double(float_from_half(half_from_float(float(n[k] / length), HalfRound::toward_zero))) : 0;
  });
  c.folder.write("halves.json", R"({"gbuffer": {"normal": {"format": "rgba16f"}}})");
  const auto violating = [&](const Arguments& more) {
    Arguments options = {"--gbuffer", "c.exr", "--map", "depth,id.object,normal=n.npy.RGB:unit"};
    options.insert(options.end(), more.begin(), more.end());
    return violations(c.counts(options));
  };
  for (const char* type : {"<f2", "<f4"}) {
    CAPTURE(type);
    write_npy(c.path("n.npy"), halves, type);
    CHECK(violating({"--pipeline", "halves.json"}) == 0);
  }
  CHECK(violating({}) > 100);  // floats, as the pipeline says then
}

TEST_CASE("A capture whose values are packed is judged by what its codes say, and no pixel is convicted", "[slow]") {
  const DrawnCapture c;
  const Axes axes = axes_of(c);
  const uint64_t pixels = uint64_t(c.normal.width) * uint64_t(c.normal.height);
  const nlohmann::json expected = c.counts({"--gbuffer", "c.exr"});
  const std::string rest = "position,albedo,depth,id.object";

  // The picture of packed planes is lit from what the codes say; it is made by our light pass, judged by the judge.
  const auto check = [&](const std::string& map, bool lights_again, uint64_t least_exact) {
    INFO(map);
    Arguments options = {"--gbuffer", "c.exr", "--map", map, "--image", "c.exr"};
    if (lights_again) {
      const Outcome lit =
          run_command({"shade", "c.exr", "--map", map, "--lights", kScene, "-o", "lit.png", "-q"}, c.path(""));
      INFO(lit.err);
      REQUIRE(lit.exit_code == 0);
      options.back() = "lit.png";
    }
    const nlohmann::json counts = c.counts(options);
    INFO(counts.dump());
    CHECK(violations(counts) == 0);
    for (const auto& stage : counts)
      CHECK(stage["EXACT"].get<uint64_t>() + stage["STORE-2"].get<uint64_t>() >= least_exact);
    return counts;
  };
  const uint64_t most = pixels - pixels / 50;

  const auto half_of = [](const double* n, double* e) {
    for (int k = 0; k < 3; ++k) e[k] = double(float(n[k] * 0.5 + 0.5));
  };
  write_npy(c.path("n01.npy"), repacked(c.normal, 3, half_of), "<f4");
  check(rest + ",normal=n01.npy:unorm", true, most);
  const EnginePlane half4 = repacked(c.normal, 4, half_of);
  write_dds(c.path("n8.dds"), half4, 28);
  check(rest + ",normal=n8.dds.RGB:unorm", true, most);
  write_dds(c.path("n16.dds"), half4, 11);
  check(rest + ",normal=n16.dds.RGB:unorm", true, most);
  const auto rounded = [](const double* n, double* e) {
    for (int k = 0; k < 3; ++k) e[k] = std::round(255 * n[k]) / 255;
  };
  const EnginePlane codes8 = repacked(half4, 3, rounded);
  write_exr_parts(c.path("n8.exr"), {{"", {"R", "G", "B"}, "half", &codes8}});
  check(rest + ",normal=n8.exr.RGB:unorm8", true, most);

  const EnginePlane signed_codes = repacked(c.normal, 2, octahedral);
  const EnginePlane unsigned_codes =
      repacked(signed_codes, 2, [](const double* n, double* e) { e[0] = n[0] * 0.5 + 0.5, e[1] = n[1] * 0.5 + 0.5; });
  write_npy(c.path("oct.npy"), signed_codes, "<f4");
  check(rest + ",normal=oct.npy:octahedral", true, most);
  write_npy(c.path("oct2.npy"), signed_codes, "<f2");
  check(rest + ",normal=oct2.npy:octahedral", true, most);
  write_dds(c.path("oct8.dds"), unsigned_codes, 49);
  check(rest + ",normal=oct8.dds:octahedral:unorm", true, most);
  write_dds(c.path("oct16.dds"), unsigned_codes, 35);
  check(rest + ",normal=oct16.dds:octahedral:unorm", true, most);
  write_dds(c.path("octs.dds"), signed_codes, 51);
  check(rest + ",normal=octs.dds:octahedral", true, most);

  const EnginePlane view_normal = repacked(c.normal, 3, [&](const double* n, double* e) { to_view(axes, n, e); });
  const EnginePlane view_position = repacked(c.position, 3, [&](const double* p, double* e) {
    const double from_eye[] = {p[0] - axes.eye[0], p[1] - axes.eye[1], p[2] - axes.eye[2]};
    to_view(axes, from_eye, e);
  });
  write_npy(c.path("vn.npy"), view_normal, "<f4");
  write_npy(c.path("vp.npy"), view_position, "<f4");
  check("normal=vn.npy:view,position=vp.npy:view,albedo,depth,id.object", false, most);
  const auto away = [](const double* v, double* e) { e[0] = v[0], e[1] = v[1], e[2] = -v[2]; };
  const auto down = [](const double* v, double* e) { e[0] = v[0], e[1] = -v[1], e[2] = -v[2]; };
  write_npy(c.path("vn.npy"), repacked(view_normal, 3, away), "<f4");
  write_npy(c.path("vp.npy"), repacked(view_position, 3, down), "<f4");
  check("normal=vn.npy:view_z_away,position=vp.npy:view_y_down_z_away,albedo,depth,id.object", false, most);

  const EnginePlane sphere = repacked(view_normal, 2, spheremap);
  write_npy(c.path("sphere.npy"), sphere, "<f4");
  check(rest + ",normal=sphere.npy:spheremap:view", true, most);
  write_dds(c.path("sphere.dds"), sphere, 49);
  check(rest + ",normal=sphere.dds:spheremap:view", true, most);

  EnginePlane reversed = c.depth, linear = c.depth, distance = c.depth;
  for (int y = 0; y < c.depth.height; ++y)
    for (int x = 0; x < c.depth.width; ++x) {
      reversed.at(x, y, 0) = double(float(1 - c.depth.at(x, y, 0)));
      double v[3], length = 0;
      for (int k = 0; k < 3; ++k) {
        v[k] = c.position.at(x, y, k) - axes.eye[k];
        length += v[k] * v[k];
      }
      linear.at(x, y, 0) = c.covered(x, y) ? double(float(-along(axes.back, v))) : 1e9;
      distance.at(x, y, 0) = c.covered(x, y) ? double(float(std::sqrt(length))) : 0;
    }
  write_npy(c.path("reversed.npy"), reversed, "<f4");
  write_npy(c.path("linear.npy"), linear, "<f4");
  write_npy(c.path("distance.npy"), distance, "<f4");
  const std::string but_depth = "position,normal,albedo,id.object,";
  const nlohmann::json by_reversed = check(but_depth + "depth=reversed.npy:reversed", false, most);
  CHECK(by_reversed["lighting"] == expected["lighting"]);
  check(but_depth + "depth=linear.npy:linear", false, most);
  check(but_depth + "depth=distance.npy:distance", false, most);
  const auto part_of_far = [](const double* d, double* e) { e[0] = double(float(d[0] / 50)); };
  write_npy(c.path("part.npy"), repacked(linear, 1, part_of_far), "<f4");
  check(but_depth + "depth=part.npy:linear:times=50", false, most);
  const std::string but_position = "depth,normal,albedo,id.object,";
  check(but_position + "position=linear.npy:linear", false, most);
  check(but_position + "position=distance.npy:distance", false, most);
  check(but_position + "position=c.depth.Z:window", true, most);
  check(but_position + "position=reversed.npy:reversed", true, most);
  check("position,normal,albedo=c.albedo.RGB,depth,color=c.png.RGB", false, most);
}

TEST_CASE(
    "Faults in a packed capture are convicted: normals a few codes off, and a picture that is not what they say") {
  const DrawnCapture c;
  const std::string map = "position,albedo,depth,id.object,normal=oct.dds:octahedral:unorm";
  EnginePlane codes = repacked(c.normal, 2, octahedral);
  for (double& e : codes.values) e = std::round(255 * (e * 0.5 + 0.5)) / 255;
  const auto counts = [&](const Arguments& picture) {
    write_dds(c.path("oct.dds"), codes, 49);
    Arguments options = {"--gbuffer", "c.exr", "--map", map};
    options.insert(options.end(), picture.begin(), picture.end());
    return c.counts(options);
  };
  // The picture was lit from the normals before they were packed: codes of 8 bits say another one.
  const nlohmann::json unpacked = counts({"--image", "c.exr"});
  CHECK(unpacked["gbuffer"]["VIOLATION"] == 0);
  CHECK(unpacked["lighting"]["VIOLATION"].get<int>() > 100);
  const auto light = [&] {
    write_dds(c.path("oct.dds"), codes, 49);
    const Outcome lit =
        run_command({"shade", "c.exr", "--lights", kScene, "--map", map, "-o", "lit.png", "-q"}, c.path(""));
    INFO(lit.err);
    REQUIRE(lit.exit_code == 0);
  };
  light();
  Image picture = read_planes(c.path("lit.png")).front().image;
  picture.texel(60, 70)[1] = uint8_t(picture.texel(60, 70)[1] + 2);
  write_image(c.path("off.png"), picture, {}, {});
  const nlohmann::json off = counts({"--image", "off.png"});
  CHECK(off["gbuffer"]["VIOLATION"] == 0);
  CHECK(off["lighting"]["VIOLATION"] == 1);
  codes.at(60, 60, 0) += 8.0 / 255;
  light();
  const nlohmann::json bent = counts({"--image", "lit.png"});
  CHECK(bent["gbuffer"]["VIOLATION"] == 1);
  CHECK(bent["lighting"]["VIOLATION"] == 0);
}

TEST_CASE("A packed capture whose rows are read from the wrong end is told apart from wrong normals and positions") {
  const DrawnCapture c;
  write_dds(c.path("up.dds"),
            bottom_up(repacked(c.normal, 2,
                               [](const double* n, double* e) {
                                 octahedral(n, e);
                                 for (int k = 0; k < 2; ++k) e[k] = e[k] * 0.5 + 0.5;
                               })),
            49);
  write_npy(c.path("z.npy"), bottom_up(c.depth), "<f4");
  write_npy(c.path("o.npy"), bottom_up(c.object), "<f4");
  write_npy(c.path("a.npy"), bottom_up(c.albedo), "<f4");
  const auto diagnosis = [&](const Arguments& options) {
    const Outcome outcome = c.judge(options);
    INFO(outcome.err);
    REQUIRE((outcome.exit_code == 0 || outcome.exit_code == 1));
    return nlohmann::json::parse(outcome.out)["diagnosis"];
  };
  const std::string map =
      "depth=z.npy.R,id.object=o.npy.R,albedo=a.npy.RGBA,normal=up.dds:octahedral:unorm,position=z.npy.R:window";
  CHECK(violations(c.counts({"--map", map + ",rows=bottom_up"})) == 0);
  const auto read_as_it_is = diagnosis({"--map", map});
  REQUIRE(read_as_it_is.size() == 1);
  CHECK(read_as_it_is[0]["name"] == "rows=bottom_up");
  CHECK(read_as_it_is[0]["explained"] == 1);
  CHECK(read_as_it_is[0]["proof"]["plane"] != "");

  // Ours has its rows from the top, as a file without a map is taken.
  const auto turned = diagnosis({"--gbuffer", "c.exr", "--map", "rows=bottom_up"});
  REQUIRE(turned.size() == 1);
  CHECK(turned[0]["name"] == "rows=top_down");

  // Arguments of planes that are turned twice: what the map says of all of them is wrong.
  const auto twice =
      diagnosis({"--gbuffer", "c.exr", "--map", "depth=c.depth.Z:bottom_up,id.object=c.id.object:bottom_up"});
  REQUIRE(twice.size() == 1);
  CHECK(twice[0]["name"] == "rows=bottom_up");

  // What lies under a mask has no say: here objects that stand the right way up as they are read.
  EnginePlane hidden = bottom_up(c.object), mask = c.depth;
  for (int y = 0; y < hidden.height; ++y)
    for (int x = 0; x < hidden.width; ++x) {
      const bool is_hidden = x < hidden.width / 3;
      mask.at(x, y, 0) = is_hidden ? 0 : 1;
      if (is_hidden) hidden.at(x, y, 0) = c.object.at(x, y, 0);
    }
  write_npy(c.path("hidden.npy"), hidden, "<f4");
  write_npy(c.path("mask.npy"), mask, "|u1");
  const auto masked =
      diagnosis({"--map", "depth=z.npy.R,id.object=hidden.npy.R", "--mask", "mask.npy", "--allow-mask"});
  REQUIRE(masked.size() == 1);
  CHECK(masked[0]["name"] == "rows=bottom_up");

  // Surfaces that are elsewhere, but not upside down.
  EnginePlane moved = c.depth;
  for (int y = 0; y < moved.height; ++y)
    for (int x = 0; x + 3 < moved.width; ++x) moved.at(x, y, 0) = c.depth.at(x + 3, y, 0);
  write_npy(c.path("moved.npy"), moved, "<f4");
  for (const auto& finding : diagnosis({"--gbuffer", "c.exr", "--map", "depth=moved.npy.R"}))
    CHECK(finding["plane"] != "capture");
}

TEST_CASE("A plane that is read with the wrong words of --map is named with those that fit, and a wrong plane is not") {
  const DrawnCapture c;
  const Axes axes = axes_of(c);
  const EnginePlane unit = repacked(c.normal, 3, [](const double* n, double* e) {
    const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int k = 0; k < 3; ++k) e[k] = length > 0 ? n[k] / length : 0;
  });
  const auto half_of = [](const double* n, double* e) {
    for (int k = 0; k < 3; ++k) e[k] = double(float(n[k] * 0.5 + 0.5));
  };
  const EnginePlane view = repacked(unit, 3, [&](const double* n, double* e) { to_view(axes, n, e); });
  write_npy(c.path("half.npy"), repacked(c.normal, 3, half_of), "<f4");
  write_npy(c.path("view.npy"), repacked(view, 3, half_of), "<f4");
  write_npy(c.path("oct.npy"), repacked(c.normal, 2, octahedral), "<f4");
  write_npy(c.path("mirrored.npy"),
            repacked(c.normal, 3, [](const double* n, double* e) { e[0] = -n[0], e[1] = n[2], e[2] = n[1]; }), "<f4");
  write_npy(c.path("p.npy"),
            repacked(c.position, 3,
                     [&](const double* p, double* e) {
                       const double v[] = {p[0] - axes.eye[0], p[1] - axes.eye[1], p[2] - axes.eye[2]};
                       to_view(axes, v, e), e[2] = -e[2];
                     }),
            "<f4");
  EnginePlane reversed = c.depth;
  for (double& z : reversed.values) z = double(float(1 - z));
  write_npy(c.path("z.npy"), reversed, "<f4");
  EnginePlane part = c.depth;
  for (int y = 0; y < part.height; ++y)
    for (int x = 0; x < part.width; ++x) {
      double v[3];
      for (int k = 0; k < 3; ++k) v[k] = c.position.at(x, y, k) - axes.eye[k];
      part.at(x, y, 0) = c.covered(x, y) ? double(float(-along(axes.back, v) / 50)) : 1;
    }
  write_npy(c.path("part.npy"), part, "<f4");
  struct Case {
    std::string map;
    std::vector<std::string> named;
  };
  const Case kCases[] = {
      {"depth,id.object,normal=half.npy", {"normal=...:unorm"}},
      {"depth,id.object,normal=half.npy:unorm:view", {"normal=...:unorm"}},
      {"depth,id.object,normal=view.npy:unit", {"normal=...:unorm:unit:view"}},
      {"depth,id.object,normal=oct.npy:octahedral:view_z_away", {"normal=...:octahedral"}},
      {"depth,id.object,position=p.npy", {"position=...:view_z_away"}},
      {"id.object,depth=z.npy", {"depth=...:reversed"}},
      {"id.object,depth=c.depth.Z:reversed", {"depth=..."}},
      {"id.object,depth=z.npy:linear,normal=half.npy:unorm:view", {"depth=...:reversed", "normal=...:unorm"}},
      {"depth,id.object,normal,albedo,position=z.npy:window", {"position=...:reversed"}},
      {"depth,id.object,normal=mirrored.npy", {}},
      {"id.object,depth=part.npy:distance:times=50", {"depth=...:linear:times=50"}},
      {"id.object,depth=part.npy", {"depth=...:linear:times=50"}},
  };
  for (const Case& test : kCases) {
    INFO(test.map);
    Arguments options = {"--gbuffer", "c.exr", "--map", test.map};
    if (test.map.find("albedo") != std::string::npos) options.insert(options.end(), {"--image", "c.exr"});
    const Outcome outcome = c.judge(options);
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 1);
    std::vector<std::string> named;
    const nlohmann::json findings = nlohmann::json::parse(outcome.out)["diagnosis"];
    for (const auto& finding : findings)
      if (finding["plane"] == "capture") named.push_back(finding["name"]);
    CHECK(named == test.named);
  }
}

TEST_CASE("View space and distances are told from an engine's matrix too, Vulkan's and Direct3D's among them") {
  const DrawnCapture c;
  const Axes axes = axes_of(c);
  struct Convention {
    const char *pipeline, *word;
    bool z_away, y_down, zero_to_one, upper_left;
  };
  constexpr Convention kConventions[] = {
      {R"({"geometry": {}})", "view", false, false, false, false},
      {R"({"geometry": {"clip_depth": "zero_to_one"}})", "view_z_away", true, false, true, false},
      {R"({"geometry": {"clip_depth": "zero_to_one", "clip_origin": "upper_left"}})", "view_y_down_z_away", true, true,
       true, true}};
  for (const Convention& convention : kConventions) {
    INFO(convention.pipeline);
    // Rows of the matrix: projection times view, z from 0.1 to 50.
    const double g = 1 / std::tan(0.5 * 45 * 3.14159265358979323846 / 180), near = 0.1, far = 50;
    const double x_scale = g * 90 / 120, y_scale = convention.upper_left ? -g : g;
    const double z_scale = convention.zero_to_one ? -far / (far - near) : -(far + near) / (far - near);
    const double z_offset = (convention.zero_to_one ? -1 : -2) * far * near / (far - near);
    double rows[4][4] = {};
    for (int k = 0; k < 3; ++k) {
      rows[0][k] = x_scale * axes.right[k], rows[1][k] = y_scale * axes.up[k];
      rows[2][k] = z_scale * axes.back[k], rows[3][k] = -axes.back[k];
    }
    rows[0][3] = -x_scale * along(axes.right, axes.eye), rows[1][3] = -y_scale * along(axes.up, axes.eye);
    rows[2][3] = -z_scale * along(axes.back, axes.eye) + z_offset, rows[3][3] = along(axes.back, axes.eye);
    auto scene = nlohmann::json::parse(kSceneText);
    nlohmann::json matrix = nlohmann::json::array();
    for (int column = 0; column < 4; ++column)
      for (const auto& row : rows) matrix.push_back(double(float(row[column])));
    scene["camera"] = {{"eye", {3, 2.5, 5}}, {"clip_from_world", matrix}};
    c.folder.write("m.json", scene.dump());
    c.folder.write("p.json", convention.pipeline);
    const Outcome drawn = run_command({"render", "m.json", "--pipeline", "p.json", "--size", "120x90", "-o", "m.exr",
                                       "-q", "--aov", "depth,position,normal,albedo,id.object"},
                                      c.path(""));
    INFO(drawn.err);
    REQUIRE(drawn.exit_code == 0);
    EnginePlane position, normal;
    for (const NamedImage& plane : read_planes(c.path("m.exr"))) {
      if (plane.name == "position") position = engine_plane(plane.image);
      if (plane.name == "normal") normal = engine_plane(plane.image);
    }
    const double y = convention.y_down ? -1 : 1, z = convention.z_away ? -1 : 1;
    write_npy(c.path("n.npy"),
              repacked(normal, 3,
                       [&](const double* n, double* e) {
                         to_view(axes, n, e);
                         e[1] *= y, e[2] *= z;
                       }),
              "<f4");
    write_npy(c.path("p.npy"),
              repacked(position, 3,
                       [&](const double* p, double* e) {
                         const double from_eye[] = {p[0] - axes.eye[0], p[1] - axes.eye[1], p[2] - axes.eye[2]};
                         to_view(axes, from_eye, e);
                         e[1] *= y, e[2] *= z;
                       }),
              "<f4");
    write_npy(c.path("d.npy"),
              repacked(position, 1,
                       [&](const double* p, double* e) {
                         const double from_eye[] = {p[0] - axes.eye[0], p[1] - axes.eye[1], p[2] - axes.eye[2]};
                         e[0] = p[0] == 0 && p[1] == 0 && p[2] == 0 ? 0 : -along(axes.back, from_eye);
                       }),
              "<f4");
    const std::string word = convention.word;
    const Outcome judged =
        run_command({"validate", "m.json", "--pipeline", "p.json", "--quick", "--gbuffer", "m.exr", "--map",
                     "position=p.npy:" + word + ",normal=n.npy:" + word + ",depth=d.npy:linear,albedo,id.object,color"},
                    c.path(""));
    INFO(judged.out << judged.err);
    CHECK(judged.exit_code == 0);
  }
}

}  // namespace trueshade
