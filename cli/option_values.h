#pragma once
#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "cli/options.h"
#include "core/error.h"
#include "core/likeliest_name.h"

namespace trueshade {

/// Values of options from their texts. Each throws Error(usage) naming the option and what it takes; a size over 65,536
/// pixels a side is Error(limit).
int integer_in(const std::string& option, const std::string& text, int least, int most);
int tile_from_text(const std::string& option, const std::string& text);
Size size_from_text(const std::string& text, int most);
void check_size(int64_t width, int64_t height, int most);            ///< Error(limit): over `most` pixels a side
std::chrono::seconds lost_after_from_text(const std::string& text);  ///< of --lost-after
PictureRegion region_from_text(const std::string& text);             ///< of `X,Y,WxH`
double time_from_text(const std::string& text);
/// Above 0 and at most 0.01.
double chance_from_text(const std::string& option, const std::string& text);
inline constexpr int kMostFrames = 1000000;
FrameRange frames_from_text(const std::string& text);
NumericProfile profile_from_text(const std::string& text);
ImageView view_from_text(const std::string& option, const std::string& text);
Format target_from_text(const std::string& option, const std::string& text);
PngEncoding encoding_from_text(const std::string& text);
Strategy strategy_from_text(const std::string& option, const std::string& text);
/// The names of a list. With `depth` comes `Z`: two channels of a file for one name.
std::vector<std::string> aovs_from_text(const std::string& option, const std::string& list);
/// Names of peers: gl, gl=DESIGN+DESIGN, embree, or ours drawn otherwise, KEY=VALUE. Names of designs are not checked.
std::vector<std::string> peers_from_text(const std::string& list);

/// How a variant of the bench draws what is timed: one option of render in another way.
struct Variant {
  std::optional<Strategy> strategy;
  std::optional<Format> target;
  std::optional<ImageView> view;
  std::optional<int> threads, tile;
  std::string simd;  ///< empty: the same
  std::vector<std::string> aovs;
};
/// Of strategy=S, target=F, view=V, threads=N, tile=N, simd=NAME, aov=PLANE+PLANE...
Variant variant_from_text(const std::string& text);

// Names that values may have, for completions and suggestions.
inline constexpr std::string_view kDriverNames[] = {"default", "llvmpipe", "softpipe",
                                                    "vulkan",  "lavapipe", "swiftshader"};
inline constexpr std::string_view kEncodingNames[] = {"srgb", "raw"}, kColorSpaceNames[] = {"srgb", "linear"};
inline constexpr std::string_view kRowOrders[] = {"top_down", "bottom_up"};
inline constexpr std::string_view kSimdNames[] = {"best", "avx512", "avx2", "sse4", "scalar"};
inline constexpr std::string_view kShellNames[] = {"bash", "zsh", "fish"};
inline constexpr std::string_view kTileSides[] = {"8", "16", "32", "48", "64"};
std::vector<std::string_view> preset_names();
/// What `trueshade list NAME` lists alone, in the order in which it lists all.
inline constexpr std::string_view kListNames[] = {"scenes",          "presets", "models", "strategies", "profiles",
                                                  "driver-profiles", "formats", "planes", "views",      "simd",
                                                  "faults",          "schemas"};

/// `1.5,0,-2`, a place in the world within 1e9 of its origin. `or_else`: what the option takes besides, for the error.
glm::vec3 world_place_from_text(const std::string& option, const std::string& text, const std::string& or_else = "");
OrbitPlace orbit_from_text(const std::string& text);  ///< of `30,20`, `30,20,2.5` or `30,20,150%`
double fov_from_text(const std::string& text);        ///< degrees
/// The same; nothing of `eye`.
std::optional<glm::vec3> cube_eye_from_text(const std::string& text);

bool is_picture_name(const std::string& file);  ///< what info and compare take for a picture, by its ending
bool is_one_page(const std::string& output);    ///< what `man -o` takes for a file, and not for a folder
void check_scene(const std::string& scene);
void check_preset(const std::optional<std::string>& preset);
void check_simd(const std::string& option, const std::string& name);

/// Names as a message lists them.
template <typename Names>
std::string joined(const Names& names) {
  std::string text;
  for (const auto& name : names) text += (text.empty() ? "" : " ") + std::string(name);
  return text;
}

Error usage(const std::string& where, const std::string& reason, const std::string& remedy);

/// `what` as in "there is no preset"; the remedy names the known name that was probably meant, and all.
template <typename Names>
Error unknown_name(const std::string& option, const std::string& what, const std::string& name, const Names& known) {
  return usage(option, what + " '" + name + "'", did_you_mean(name, known) + "one of: " + joined(known));
}

std::vector<std::string_view> target_names();
std::string plane_names();

/// A pixel by column and row, from the top left.
struct PixelPlace {
  int x, y;
};
/// `412,310`. Error(usage) for anything but two whole numbers from 0 to 65,535.
PixelPlace place_from_text(const std::string& option, const std::string& text);

}  // namespace trueshade
