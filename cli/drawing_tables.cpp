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

void add_size(CommandTable& table, std::optional<std::string>& size) {
  add_value(table, "--size", "WxH", size, "Image size in pixels, WIDTHxHEIGHT").group = kCameraGroup;
}

void add_time(CommandTable& table, std::optional<std::string>& time) {
  add_value(table, "--time", "SECONDS", time, "Time of the scene's timeline, seconds").group = kCameraGroup;
}

void add_camera(CommandTable& table, CameraTexts& texts) {
  add_value(table, "--camera", "NUMBER|NAME", texts.camera,
            "Which of the scene's cameras sees it, by number from 0 or by name; trueshade info lists them")
      .group = kCameraGroup;
  add_value(table, "--orbit", "AZ,EL[,DISTANCE]", texts.orbit,
            "See all of the scene from a side: AZ degrees from +z towards +x (0 is the front, 90 the right, as you see "
            "it, 180 "
            "the back), EL degrees above. DISTANCE is "
            "in scene "
            "units from the centre, or like 150% of the one from which all is seen, which it is unless given")
      .group = kCameraGroup;
  add_value(table, "--eye", "X,Y,Z", texts.eye, "Where the camera is, in the world").group = kCameraGroup;
  add_value(table, "--look-at", "X,Y,Z", texts.look_at,
            "The place in the world that the camera looks at; with --orbit the one that it goes around")
      .group = kCameraGroup;
  add_value(table, "--fov", "DEGREES", texts.fov, "Angle that is seen from the picture's lower edge to its upper one")
      .group = kCameraGroup;
  add_value(table, "--animation", "NUMBER|NAME|all", texts.animation,
            "Which of a glTF file's animations moves it, by number from 0 or by name, or all as one; without it the "
            "first")
      .group = kCameraGroup;
}

void add_target(CommandTable& table, std::optional<std::string>& target) {
  add_choice(table, "--target", "FORMAT", target, "Format the image is stored in:", target_names()).group = "Pipeline";
}

void add_strategy(CommandTable& table, std::optional<std::string>& strategy) {
  add_choice(table, "--strategy", "NAME", strategy, "How lights come to pixels:", kStrategyNames).group = "Pipeline";
}

void add_profile(CommandTable& table, std::optional<std::string>& profile) {
  add_choice(table, "--profile", "NAME", profile, "Whose bits where OpenGL leaves a choice:", kProfileNames).group =
      "Pipeline";
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

void add_render_output(CommandTable& table, RenderOptions& options, RenderTexts& texts) {
  table.open_group = "Output";
  add_values(
      table, "-o,--output", "FILE", options.outputs,
      "File to write: .png, .exr, or .html for a report; - is a PNG on standard output, -.exr an EXR, -.html a report; "
      "may be repeated");
  OptionRow& planes =
      add_choice(table, "--aov", "PLANES", texts.aov, "Planes for the EXR, with commas: " + plane_names(), aov_names());
  planes.is_list = true;
  add_choice(table, "--encode", "CODES", texts.encode,
             "Codes of a PNG. srgb: values taken as linear light and sRGB-encoded; raw: values as they are, "
             "tagged gAMA 1.0; without it fixed-point targets as they are, floats sRGB-encoded",
             kEncodingNames);
  add_switch(table, "--cube-cross", texts.cube_cross, "Write a cube map as one picture of 4 x 3 faces");
  add_switch(table, "--raw-video", options.raw_video,
             "With -o -: the codes of all frames, one after the other, for ffmpeg to read from a pipe");
  add_switch(table, "--resume", options.resume,
             "Go on with a large picture where an earlier run has stopped: its FILE.part and FILE.progress are there");
  add_switch(table, "--hash", options.hash, "Print the hash of the image's stored bytes");
  add_switch(table, "--stats", options.stats, "Print counts and times");
  add_switch(table, "--json", options.json, "Print all of it as one JSON document");
  add_quiet(table, options, kQuietHelp);
}

void add_render_execution(CommandTable& table, RenderOptions& options, RenderTexts& texts) {
  table.open_group = "Execution";
  add_value(table, "--threads", "COUNT", texts.threads, kThreadsHelp);
  add_simd(table, options.simd, "best, scalar, sse4, avx2 or avx512; never changes a pixel");
  add_choice(table, "--tile", "PIXELS", texts.tile,
             "Tile side: 8, 16, 32, 48 or 64; without it by size and threads; never changes a pixel", kTileSides);
  add_switch(table, "--no-light-culling", texts.no_light_culling,
             "Try every light on every pixel; never changes a pixel");
}

}  // namespace

void add_sharing(CommandTable& table, SharingRules& sharing, std::optional<std::string>& lost_after) {
  table.open_group = "Work shared by MPI (docs/farm.md)";
  add_value(table, "--lost-after", "SECONDS", lost_after,
            "A process that was not heard for so long is lost, 1 to 86400 (60)");
  add_switch(
      table, "--continue-without-lost", sharing.continue_without_lost,
      "Give the work of a process that is lost, that fails or that has another scene or list to the others; else "
      "the run ends with an error");
}

CommandTable render_table(RenderOptions& options, RenderTexts& texts) {
  CommandTable table{"render", "Draw a scene"};
  add_value(table, "SCENE", "SCENE", options.scene, kSceneHelp).is_required = true;
  add_render_output(table, options, texts);
  add_size(table, texts.size);
  add_value(table, "--region", "X,Y,WxH", texts.region,
            "Draw this part of the picture alone, with the very pixels that the picture has there; X and Y count from "
            "its top left")
      .group = kCameraGroup;
  add_time(table, texts.time);
  add_camera(table, texts.camera);
  add_value(table, "--frames", "FIRST-LAST", texts.frames,
            "Frames FIRST-LAST of the timeline; output names hold %04d or ####, or get .0000 before the ending")
      .group = kCameraGroup;
  add_value(table, "--turntable", "COUNT", texts.turntable,
            "So many pictures around the scene, from --orbit's side or from 0,20 on; output names as of --frames")
      .group = kCameraGroup;
  add_value(table, "--cube-map", "X,Y,Z", texts.cube_map,
            "Draw the six faces of a cube map of this place in the world, or of the camera's (eye): names get .px .nx "
            ".py .ny .pz .nz before the ending")
      .group = kCameraGroup;
  add_layers(table, options);
  add_light_program(table, options);
  add_target(table, texts.target);
  add_strategy(table, texts.strategy);
  add_profile(table, texts.profile);
  add_choice(table, "--view", "NAME", texts.view, "Show this instead of the lit picture:", kViewNames);
  add_looks(table, options.looks);
  add_render_execution(table, options, texts);
  add_sharing(table, options.sharing, texts.lost_after);
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
  table.finished = [&options, &texts]() -> Command { return finished(std::move(options), texts); };
  return table;
}

CommandTable shade_table(ShadeOptions& options, ShadeTexts& texts) {
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
  add_time(table, texts.time);
  add_camera(table, texts.camera);
  add_layers(table, options);
  add_light_program(table, options);
  add_target(table, texts.target);
  add_choice(table, "--strategy", "NAME", texts.strategy,
             "How lights come to pixels: forward-loop, deferred-volumes or deferred-loop",
             std::vector<std::string>{"forward-loop", "deferred-volumes", "deferred-loop"});
  add_profile(table, texts.profile);
  add_value(table, "--threads", "COUNT", texts.threads, kThreadsHelp).group = "Execution";
  add_trust(table, options.limits);
  add_limits(table, options.limits);
  table.examples = {{"trueshade shade out.exr --lights scene.json -o should.png",
                     "What the lights of a scene should have made of a G-buffer."}};
  table.see_also = {"render", "validate"};
  table.finished = [&options, &texts]() -> Command { return finished(std::move(options), texts); };
  return table;
}

CommandTable explain_table(ExplainOptions& options, ExplainTexts& texts) {
  CommandTable table{"explain",
                     "Say how one pixel got its value: every triangle, light, blend and rounding, with their numbers"};
  add_value(table, "SCENE", "SCENE", options.scene, kSceneHelp).is_required = true;
  add_value(table, "--pixel", "X,Y", texts.pixel, "Column and row of the pixel, from the top left");
  add_value(table, "--against", "IMAGE", options.against,
            "A picture of the same frame, .png, .exr, .tif, .dds or .npy: whether its value is legal there, and what "
            "would have made it");
  table.open_group = "Output";
  add_switch(
      table, "--all", options.all,
      "Print every covering triangle, every light and every draw, also those that change nothing, and every step of "
      "a light program");
  add_switch(table, "--json", options.json, "Print all of it as one JSON document");
  add_quiet(table, options, "Say neither notes nor progress");
  add_size(table, texts.size);
  add_time(table, texts.time);
  add_camera(table, texts.camera);
  add_layers(table, options);
  add_light_program(table, options);
  add_target(table, texts.target);
  add_strategy(table, texts.strategy);
  add_profile(table, texts.profile);
  add_looks(table, options.looks);
  add_lenient(table, options.limits);
  add_trust(table, options.limits);
  add_limits(table, options.limits);
  table.details = "The last line is the stored pixel, as render stores it.";
  table.examples = {{"trueshade explain scene.json --pixel 160,120", "Everything behind one pixel's value."}};
  table.see_also = {"render", "validate"};
  table.finished = [&options, &texts]() -> Command { return finished(std::move(options), texts); };
  return table;
}

CommandTable view_table(ViewOptions& options, ViewTexts& texts) {
  CommandTable table{"view", "Show a scene in a window, to fly through and to change"};
  add_value(table, "SCENE", "SCENE", options.scene, kSceneHelp).is_required = true;
  table.open_group = "Window";
  add_value(table, "--script", "FILE", options.script,
            "Do in the window what the lines of this file say, then go on as by hand (docs/view.md)");
  add_value(table, "--ui-scale", "PERCENT", texts.scale,
            "Size of texts and panels, 50 to 400; without it by the display's dots an inch");
  add_quiet(table, options, "Say neither notes nor progress");
  add_size(table, texts.size);
  add_time(table, texts.time);
  add_camera(table, texts.camera);
  add_layers(table, options);
  add_light_program(table, options);
  add_strategy(table, texts.strategy);
  add_target(table, texts.target);
  add_profile(table, texts.profile);
  add_choice(table, "--view", "NAME", texts.view, "Show this instead of the lit picture:", kViewNames).group =
      "Pipeline";
  add_looks(table, options.looks);
  add_value(table, "--threads", "COUNT", texts.threads, kThreadsHelp).group = "Execution";
  add_lenient(table, options.limits);
  add_trust(table, options.limits);
  add_limits(table, options.limits);
  table.details =
      "With --size the picture keeps its size, otherwise it is as large as the window. F1 in the window names all "
      "keys.";
  table.examples = {{"trueshade view builtin:city", "A city at night, to fly through."},
                    {"trueshade view builtin:city --size 800x600 --script flight.txt", "A flight that a file tells."}};
  table.see_also = {"render", "explain"};
  table.finished = [&options, &texts]() -> Command { return finished(std::move(options), texts); };
  return table;
}

}  // namespace trueshade
