#include "cli/limit_options.h"

#include <charconv>
#include <string_view>

#include "core/error.h"

namespace trueshade {
namespace {

using enum LimitOption::Unit;

constexpr LimitOption kOptions[] = {
    {"--max-memory", bytes, &Limits::memory, "Memory of the process; what would need more is refused before it begins"},
    {"--max-pixels", count, &Limits::pixels, "Pixels of a picture that is drawn or read"},
    {"--timeout", seconds, &Limits::seconds, "Seconds after which the command ends, and leaves no file torn"},
    {"--max-file", bytes, &Limits::file_bytes, "Bytes of an input file, and of what a .gz file holds"},
    {"--max-json", bytes, &Limits::json_bytes, "Bytes of a scene's JSON text"},
    {"--max-lights", count, &Limits::lights, "Lights of a scene"},
    {"--max-instances", count, &Limits::instances, "Drawings of meshes in a scene"},
    {"--max-nodes", count, &Limits::nodes, "Nodes of a glTF file"},
    {"--max-node-depth", count, &Limits::node_depth, "Nodes of a glTF file inside each other"},
    {"--max-texture-memory", bytes, &Limits::texture_bytes, "Bytes of all textures with their levels, decoded"},
    {"--max-buffer-memory", bytes, &Limits::buffer_bytes, "Bytes of a glTF file's buffers, unpacked"},
    {"--max-geometry-memory", bytes, &Limits::geometry_bytes, "Bytes of a glTF file's vertices and indices"},
    {"--max-expansion", count, &Limits::expansion, "Bytes that a byte of a compressed file may become, beyond 64M"},
    {"--max-program-nodes", count, &Limits::program_nodes, "Operations of a light program, its loops unrolled"},
    {"--max-loop-trips", count, &Limits::loop_trips, "Trips of a loop of a light program"},
    {"--max-program-time", seconds, &Limits::program_seconds, "Seconds that a light program may take to compile"}};

struct Suffix {
  char letter;
  int shift;
};
constexpr Suffix kSuffixes[] = {{'K', 10}, {'M', 20}, {'G', 30}, {'T', 40}};

std::string text_of(uint64_t value, LimitOption::Unit unit) {
  for (size_t i = std::size(kSuffixes); i-- > 0;)
    if (const Suffix& s = kSuffixes[i]; unit == bytes && value % (uint64_t(1) << s.shift) == 0)
      return std::to_string(value >> s.shift) + s.letter;
  return std::to_string(value);
}

}  // namespace

std::span<const LimitOption> limit_options() { return kOptions; }

const char* value_name(const LimitOption& option) {
  return option.unit == bytes ? "SIZE" : option.unit == seconds ? "SECONDS" : "COUNT";
}

std::string help_of(const LimitOption& option) {
  const uint64_t value = Limits{}.*option.limit;
  const std::string usual = value != 0             ? text_of(value, option.unit)
                            : option.unit == bytes ? "half of the machine's, or of its control group's"
                                                   : "any";
  return std::string(option.help) + " (" + usual + ")";
}

uint64_t limit_from_text(const LimitOption& option, const std::string& text) {
  std::string_view digits = text;
  int shift = 0;
  for (const Suffix& suffix : kSuffixes)
    if (option.unit == bytes && digits.ends_with(suffix.letter)) shift = suffix.shift;
  if (shift != 0) digits.remove_suffix(1);
  uint64_t value = 0;
  const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool whole = code == std::errc() && end == digits.data() + digits.size();
  if (!whole || value == 0 || value > UINT64_MAX >> shift)
    throw Error(ErrorKind::usage, option.name, "'" + text + "' is no limit",
                option.unit == bytes ? "give a size like 512M or 4G" : "give a whole number above 0");
  return value << shift;
}

}  // namespace trueshade
