#pragma once
// Option values as text, and what the commands make of them: so every error is of one form.
#include <optional>
#include <string>
#include <vector>

#include "cli/options.h"

namespace trueshade {

/// Of all that show a scene: which camera, and which animation.
struct CameraTexts {
  std::optional<std::string> camera, orbit, eye, look_at, fov, animation;

  /// The first of them that is given, with its dashes; empty: none is.
  std::string given() const;
};

/// Of render.
struct RenderTexts {
  CameraTexts camera;
  std::optional<std::string> size, time, frames, target, strategy, profile, view, aov, encode, threads, tile, cube_map,
      region, lost_after, turntable;
  bool no_light_culling = false, cube_cross = false;
};

/// Of info.
struct InfoTexts {
  CameraTexts camera;
  std::optional<std::string> size, target, strategy, profile, time, folder;
};

/// Of export.
struct ExportTexts {
  CameraTexts camera;
  std::optional<std::string> time;
};

/// Of glsl.
struct GlslTexts {
  CameraTexts camera;
  std::optional<std::string> api, size, strategy, time;
};

/// Of validate and compare.
struct MaskTexts {
  std::optional<std::string> file;
  std::vector<std::string> ignored;
  bool allow = false;
};

/// Of validate.
struct ValidationTexts {
  CameraTexts camera;
  MaskTexts mask;
  std::optional<std::string> size, subpixel_bits, strategy, time, significance;
};

/// Of shade.
struct ShadeTexts {
  CameraTexts camera;
  std::optional<std::string> time, target, strategy, profile, threads;
};

/// Of explain.
struct ExplainTexts {
  CameraTexts camera;
  std::optional<std::string> size, pixel, time, target, strategy, profile;
};

/// Of bench.
struct BenchTexts {
  CameraTexts camera;
  std::optional<std::string> size, strategy, threads, against, frames;
};

/// Of view.
struct ViewTexts {
  CameraTexts camera;
  std::optional<std::string> size, time, target, strategy, profile, view, threads, scale;
};

/// Of compare.
struct CompareTexts {
  std::optional<std::string> difference, ulp, pixels, delta, psnr, flip, flip_median, ppd, mapper, exposures,
      color_space, threads, channels, rows;
  std::vector<std::string> windows;
  MaskTexts mask;
  bool low = false, high = false, no_judge = false;
};

/// Of batch.
struct BatchTexts {
  std::optional<std::string> jobs, threads, lost_after;
};

/// One file cannot hold two documents, and who wants two has mistyped a name: Error(usage).
void check_named_once(const std::string& option, std::vector<std::string> files);

/// The options of a command with the values of their texts, checked by themselves and together. Error(usage) names the
/// option.
RenderOptions finished(RenderOptions options, const RenderTexts& texts);
InfoOptions finished(InfoOptions options, const InfoTexts& texts);
GlslFilesOptions finished(GlslFilesOptions options, const GlslTexts& texts);
ExportOptions finished(ExportOptions options, const ExportTexts& texts);
ValidationOptions finished(ValidationOptions options, const ValidationTexts& texts);
ProbeOptions finished(ProbeOptions options);
ShadeOptions finished(ShadeOptions options, const ShadeTexts& texts);
ExplainOptions finished(ExplainOptions options, const ExplainTexts& texts);
BenchOptions finished(BenchOptions options, const BenchTexts& texts);
ViewOptions finished(ViewOptions options, const ViewTexts& texts);
CompareOptions finished(CompareOptions options, const CompareTexts& texts);
BatchOptions finished(BatchOptions options, const BatchTexts& texts);

}  // namespace trueshade
