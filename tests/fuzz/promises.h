#pragma once
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string_view>

#include "core/error.h"
#include "scenes/scene.h"

// What the targets promise of what they read.
namespace trueshade::fuzz {

using Bytes = std::span<const uint8_t>;

inline std::string_view text_of(Bytes bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

/// Ends the process where a promise is broken, which is a finding.
inline void promise(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "broken promise: %s\n", what);
  std::abort();
}

/// Runs a job that may be refused by an Error alone, which says what to do.
template <typename Job>
void read(Job job) {
  try {
    job();
  } catch (const Error& error) {
    promise(std::string_view(error.what()).ends_with(")"), "an error says what to do");
  }
}

/// Limits under which an input takes milliseconds.
SceneLimits small_limits(Leniency leniency = Leniency::refused);

/// Strictly, and with faults passed over.
inline constexpr Leniency kEachWay[] = {Leniency::refused, Leniency::asked};

/// A scene that was read is in range, and stays so at any time or says so.
void check_scene(Scene scene);

/// Targets of captures.
void run_npy(Bytes bytes);
void run_dds(Bytes bytes);
void run_tiff(Bytes bytes);
void run_hdr(Bytes bytes);
void run_capture_map(Bytes bytes);

/// Of light programs.
void run_light_spv(Bytes bytes);
void run_light_glsl(Bytes bytes);
void run_light_nodes(Bytes bytes);

/// Targets of OBJ and MTL files.
void run_obj(Bytes bytes);
void run_mtl(Bytes bytes);

}  // namespace trueshade::fuzz
