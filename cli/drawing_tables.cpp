// The tables of commands that draw: render, shade, explain, view.
#include "cli/command_tables.h"
#include "cli/looks.h"
#include "cli/option_values.h"
#include "scenes/pipeline/presets.h"
#include "shading/frame.h"

namespace trueshade {

const char* const kSceneHelp =
    "Scene file (.json, .gltf, .glb, .obj, .obj.gz, .ply, .ply.gz), builtin:NAME[,KEY=VALUE...], or - for JSON, glTF, "
    "GLB or PLY from standard input";
const char* const kThreadsHelp = "Threads, 0 for one a core; never changes a pixel";

void add_layers(CommandTable& table, PipelineOptions& options) {
  table.open_group = "Pipeline";
  add_choice(table, "--preset", "NAME", options.preset, "Row of numbers the pipeline starts from:", preset_names());
  add_value(table, "--pipeline", "FILE", options.pipeline_file,
            "JSON file of values that replace the preset's and the scene's");
}

void add_light_program(CommandTable& table, PipelineOptions& options) {
  add_value(
      table, "--light-shader", "FILE", options.light_shader,
      "In place of the preset's formula: a light model that ships, which trueshade list names, or a file of GLSL or "
      "SPIR-V (docs/light_programs.md)");
  add_values(table, "--light-parameter", "NAME=VALUE", options.light_parameters,
             "A member of its uniform block Parameters, components with commas; may be repeated");
  add_switch(table, "--no-machine-code", options.no_machine_code,
             "Interpret it, so that no memory becomes executable; never changes a pixel");
}

void add_size(CommandTable& table, std::optional<Size>& size, int most) {
  add_read(
      table, "--size", "WxH", size, [most](const std::string& text) { return size_from_text(text, most); },
      "Image size in pixels, WIDTHxHEIGHT")
      .group = kCameraGroup;
}

void add_time(CommandTable& table, SceneOptions& options) {
  add_read(table, "--time", "SECONDS", options.time, time_from_text, "Time of the scene's timeline, seconds").group =
      kCameraGroup;
}

void add_camera(CommandTable& table, SceneOptions& options) {
  CameraChanges& camera = options.camera;
  const auto place = [](const char* option) {
    return [option](const std::string& text) { return world_place_from_text(option, text); };
  };
  add_value(table, "--camera", "NUMBER|NAME", options.parts.camera,
            "Which of the scene's cameras sees it, by number from 0 or by name; trueshade info lists them")
      .group = kCameraGroup;
  add_read(table, "--orbit", "AZ,EL[,DISTANCE]", camera.orbit, orbit_from_text,
           "See all of the scene from a side: AZ degrees from +z towards +x (0 is the front, 90 the right, as you see "
           "it, 180 the back), EL degrees above. DISTANCE is in scene units from the centre, or like 150% of the one "
           "from which all is seen, which it is unless given")
      .group = kCameraGroup;
  add_read(table, "--eye", "X,Y,Z", camera.eye, place("--eye"), "Where the camera is, in the world").group =
      kCameraGroup;
  add_read(table, "--look-at", "X,Y,Z", camera.target, place("--look-at"),
           "The place in the world that the camera looks at; with --orbit the one that it goes around")
      .group = kCameraGroup;
  add_read(table, "--fov", "DEGREES", camera.fov_y_deg, fov_from_text,
           "Angle that is seen from the picture's lower edge to its upper one")
      .group = kCameraGroup;
  add_value(table, "--animation", "NUMBER|NAME|all", options.parts.animation,
            "Which of a glTF file's animations moves it, by number from 0 or by name, or all as one; without it the "
            "first")
      .group = kCameraGroup;
}

void add_target(CommandTable& table, PipelineOptions& options) {
  const auto read = [](const std::string& text) { return target_from_text("--target", text); };
  of_names(add_read(table, "--target", "FORMAT", options.target, read, "Format the image is stored in:"),
           target_names())
      .group = "Pipeline";
}

void add_strategy(CommandTable& table, PipelineOptions& options) {
  const auto read = [](const std::string& text) { return strategy_from_text("--strategy", text); };
  of_names(add_read(table, "--strategy", "NAME", options.strategy, read, "How lights come to pixels:"), kStrategyNames)
      .group = "Pipeline";
}

void add_profile(CommandTable& table, PipelineOptions& options) {
  of_names(add_read(table, "--profile", "NAME", options.profile, profile_from_text,
                    "Whose bits where OpenGL leaves a choice:"),
           kProfileNames)
      .group = "Pipeline";
}

void add_view(CommandTable& table, PipelineOptions& options) {
  const auto read = [](const std::string& text) { return view_from_text("--view", text); };
  of_names(add_read(table, "--view", "NAME", options.view, read, "Show this instead of the lit picture:"), kViewNames)
      .group = "Pipeline";
}

void add_threads(CommandTable& table, int& threads, const char* help) {
  constexpr int kMostThreads = 1024;
  const auto read = [](const std::string& text) { return integer_in("--threads", text, 0, kMostThreads); };
  add_read(table, "--threads", "COUNT", threads, read, help).group = "Execution";
}

void add_simd(CommandTable& table, std::string& simd, const std::string& help) {
  add_choice(table, "--simd", "NAME", simd, help, kSimdNames).group = "Execution";
}

void add_capture(CommandTable& table, CaptureOptions& options, const char* gbuffer, const char* help) {
  table.open_group = "Capture";
  add_values(table, gbuffer, "FILE", options.gbuffer_files, help);
  add_value(table, "--map", "PLANES", options.map,
            "Which channels are which planes, and how they are packed: PLANE=FILE.CHANNELS[:WORD]... with commas, say "
            "position=gbuf2.RGB,normal=gbuf1.RG:octahedral,depth=depth.R:reversed; or @FILE with such entries. Words: "
            "octahedral, spheremap, unorm, unorm8, unorm10, unorm16, unit; view, view_z_away, view_y_down_z_away; "
            "window, reversed, linear, distance; bottom_up. rows=bottom_up turns every plane over");
  add_value(table, "--image", "FILE", options.image_file,
            "The picture of the capture, as a file of its own; else the channels R G B A, or color of --map");
}

namespace {

const char* const kQuietHelp = "Say neither notes nor progress nor which files were written";

void add_render_output(CommandTable& table, RenderOptions& options) {
  table.open_group = "Output";
  add_values(
      table, "-o,--output", "FILE", options.outputs,
      "File to write: .png, .exr, or .html for a report; - is a PNG on standard output, -.exr an EXR, -.html a report; "
      "may be repeated");
  const auto read_planes = [](const std::string& text) { return aovs_from_text("--aov", text); };
  of_names(add_read(table, "--aov", "PLANES", options.aovs, read_planes,
                    "Planes for the EXR, with commas: " + plane_names()),
           aov_names())
      .is_list = true;
  of_names(add_read(table, "--encode", "CODES", options.encode, encoding_from_text,
                    "Codes of a PNG. srgb: values taken as linear light and sRGB-encoded; raw: values as they are, "
                    "tagged gAMA 1.0; without it fixed-point targets as they are, floats sRGB-encoded"),
           kEncodingNames);
  add_switch(table, "--cube-cross", options.cube_cross, "Write a cube map as one picture of 4 x 3 faces");
  add_switch(table, "--raw-video", options.raw_video,
             "With -o -: the codes of all frames, one after the other, for ffmpeg to read from a pipe");
  add_switch(table, "--resume", options.resume,
             "Go on with a large picture where an earlier run has stopped: its FILE.part and FILE.progress are there");
  add_switch(table, "--hash", options.hash, "Print the hash of the image's stored bytes");
  add_switch(table, "--stats", options.stats, "Print counts and times");
  add_switch(table, "--json", options.json, "Print all of it as one JSON document");
  add_quiet(table, options, kQuietHelp);
}

void add_render_execution(CommandTable& table, RenderOptions& options) {
  table.open_group = "Execution";
  add_threads(table, options.execution.threads, kThreadsHelp);
  add_simd(table, options.simd, "best, scalar, sse4, avx2 or avx512; never changes a pixel");
  const auto read_tile = [](const std::string& text) { return tile_from_text("--tile", text); };
  of_names(add_read(table, "--tile", "PIXELS", options.execution.tile, read_tile,
                    "Tile side: 8, 16, 32, 48 or 64; without it by size and threads; never changes a pixel"),
           kTileSides);
  OptionRow culling{
      .names = "--no-light-culling", .value_name = "", .help = "Try every light on every pixel; never changes a pixel"};
  culling.take = [&options](const std::vector<std::string>&) { options.execution.light_culling = false; };
  table.add(std::move(culling));
}

}  // namespace

void add_sharing(CommandTable& table, SharingRules& sharing) {
  table.open_group = "Work shared by MPI (docs/farm.md)";
  add_read(table, "--lost-after", "SECONDS", sharing.lost_after, lost_after_from_text,
           "A process that was not heard for so long is lost, 1 to 86400 (60)");
  add_switch(
      table, "--continue-without-lost", sharing.continue_without_lost,
      "Give the work of a process that is lost, that fails or that has another scene or list to the others; else "
      "the run ends with an error");
}

CommandTable render_table(RenderOptions& options) {
  CommandTable table{"render", "Draw a scene"};
  add_value(table, "SCENE", "SCENE", options.scene, kSceneHelp).is_required = true;
  add_render_output(table, options);
  add_size(table, options.size, kMostPictureSide);
  add_read(table, "--region", "X,Y,WxH", options.execution.region, region_from_text,
           "Draw this part of the picture alone, with the very pixels that the picture has there; X and Y count from "
           "its top left")
      .group = kCameraGroup;
  add_time(table, options);
  add_camera(table, options);
  add_read(table, "--frames", "FIRST-LAST", options.frames, frames_from_text,
           "Frames FIRST-LAST of the timeline; output names hold %04d or ####, or get .0000 before the ending")
      .group = kCameraGroup;
  const auto read_count = [](const std::string& text) { return integer_in("--turntable", text, 1, kMostFrames); };
  add_read(table, "--turntable", "COUNT", options.turntable, read_count,
           "So many pictures around the scene, from --orbit's side or from 0,20 on; output names as of --frames")
      .group = kCameraGroup;
  const auto read_eye = [](const std::string& text) { return CubeMapOptions{cube_eye_from_text(text)}; };
  add_read(table, "--cube-map", "X,Y,Z", options.cube_map, read_eye,
           "Draw the six faces of a cube map of this place in the world, or of the camera's (eye): names get .px .nx "
           ".py .ny .pz .nz before the ending")
      .group = kCameraGroup;
  add_layers(table, options);
  add_light_program(table, options);
  add_target(table, options);
  add_strategy(table, options);
  add_profile(table, options);
  add_view(table, options);
  add_looks(table, options.looks);
  add_render_execution(table, options);
  add_sharing(table, options.sharing);
  add_lenient(table, options.limits);
  add_trust(table, options.limits);
  add_limits(table, options.limits);
  table.examples = {
      {"trueshade render builtin:city -o city.png --hash", "A picture, and the hash that it has on every machine."},
      {"trueshade render scene.json -o out.exr --aov depth,position,normal,albedo", "A picture with its G-buffer."},
      {"trueshade render model.glb -o report.html", "A page with pictures, lights, counts and times."},
      {"mpirun -n 4 trueshade render scene.json --frames 0-99 -o out.####.png",
       "A hundred frames, shared by four processes."}};
  table.see_also = {"explain", "validate", "compare", "list"};
  table.finished = [&options]() -> Command { return finished(std::move(options)); };
  return table;
}

CommandTable shade_table(ShadeOptions& options) {
  CommandTable table{"shade", "Light a G-buffer that something else has drawn"};
  add_capture(table, options.capture, "GBUFFER",
              "Files of planes: .exr, .dds, .tif, .npy or .png, channels as --aov names them or as --map says");
  add_value(table, "--lights", "SCENE", options.scene,
            "Scene file or builtin:NAME, whose lights, camera and clear colour are taken")
      .is_required = true;
  table.open_group = "Output";
  add_values(table, "-o,--output", "FILE", options.outputs,
             "File to write: .png or .exr; - is a PNG on standard output, -.exr an EXR; may be repeated");
  add_switch(table, "--hash", options.hash, "Print the hash of the image's stored bytes");
  add_quiet(table, options, kQuietHelp);
  add_time(table, options);
  add_camera(table, options);
  add_layers(table, options);
  add_light_program(table, options);
  add_target(table, options);
  const auto read_strategy = [](const std::string& text) { return strategy_from_text("--strategy", text); };
  of_names(add_read(table, "--strategy", "NAME", options.strategy, read_strategy, "How lights come to pixels:"),
           std::vector<std::string>{"forward-loop", "deferred-volumes", "deferred-loop"});
  add_profile(table, options);
  add_threads(table, options.execution.threads, kThreadsHelp);
  add_trust(table, options.limits);
  add_limits(table, options.limits);
  table.examples = {{"trueshade shade out.exr --lights scene.json -o should.png",
                     "What the lights of a scene should have made of a G-buffer."}};
  table.see_also = {"render", "validate"};
  table.finished = [&options]() -> Command { return finished(std::move(options)); };
  return table;
}

CommandTable explain_table(ExplainOptions& options) {
  CommandTable table{"explain",
                     "Say how one pixel got its value: every triangle, light, blend and rounding, with their numbers"};
  add_value(table, "SCENE", "SCENE", options.scene, kSceneHelp).is_required = true;
  OptionRow pixel{.names = "--pixel", .value_name = "X,Y", .help = "Column and row of the pixel, from the top left"};
  pixel.take = [&options](const std::vector<std::string>& given) {
    const PixelPlace place = place_from_text("--pixel", given.back());
    options.x = place.x, options.y = place.y;
  };
  table.add(std::move(pixel));
  add_value(table, "--against", "IMAGE", options.against,
            "A picture of the same frame, .png, .exr, .tif, .dds or .npy: whether its value is legal there, and what "
            "would have made it");
  table.open_group = "Output";
  add_switch(
      table, "--all", options.all,
      "Print every covering triangle, every light and every draw, also those that change nothing, and every step of "
      "a light program");
  add_switch(table, "--brief", options.brief,
             "Print what is seen and stored alone, and with --against that value, its class and its causes");
  add_switch(table, "--json", options.json, "Print all of it as one JSON document");
  add_quiet(table, options, "Say neither notes nor progress");
  add_size(table, options.size);
  add_time(table, options);
  add_camera(table, options);
  add_layers(table, options);
  add_light_program(table, options);
  add_target(table, options);
  add_strategy(table, options);
  add_profile(table, options);
  add_looks(table, options.looks);
  add_lenient(table, options.limits);
  add_trust(table, options.limits);
  add_limits(table, options.limits);
  table.details =
      "Lights, objects and triangles are counted from 0, in the scene's order, in which info --resolved lists them. "
      "The "
      "last line is the stored pixel, as render stores it.";
  table.examples = {{"trueshade explain scene.json --pixel 160,120", "Everything behind one pixel's value."}};
  table.see_also = {"render", "validate"};
  table.finished = [&options]() -> Command { return finished(std::move(options)); };
  return table;
}

CommandTable view_table(ViewOptions& options) {
  CommandTable table{"view", "Show a scene in a window, to fly through and to change"};
  add_value(table, "SCENE", "SCENE", options.scene, kSceneHelp).is_required = true;
  table.open_group = "Window";
  add_value(table, "--script", "FILE", options.script,
            "Do in the window what the lines of this file say, then go on as by hand (docs/view.md)");
  const auto read_scale = [](const std::string& text) { return integer_in("--ui-scale", text, 50, 400) / 100.0; };
  add_read(table, "--ui-scale", "PERCENT", options.scale, read_scale,
           "Size of texts and panels, 50 to 400; without it by the display's dots an inch");
  add_quiet(table, options, "Say neither notes nor progress");
  add_size(table, options.size);
  add_time(table, options);
  add_camera(table, options);
  add_layers(table, options);
  add_light_program(table, options);
  add_strategy(table, options);
  add_target(table, options);
  add_profile(table, options);
  add_view(table, options);
  add_looks(table, options.looks);
  add_threads(table, options.execution.threads, kThreadsHelp);
  add_lenient(table, options.limits);
  add_trust(table, options.limits);
  add_limits(table, options.limits);
  table.details =
      "With --size the picture keeps its size, otherwise it is as large as the window. F1 in the window names all "
      "keys.";
  table.examples = {{"trueshade view builtin:city", "A city at night, to fly through."},
                    {"trueshade view builtin:city --size 800x600 --script flight.txt", "A flight that a file tells."}};
  table.see_also = {"render", "explain"};
  table.finished = [&options]() -> Command { return finished(std::move(options)); };
  return table;
}

}  // namespace trueshade
