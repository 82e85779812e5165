#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>

#include "core/error.h"
#include "programs/edits/edit_text.h"
#include "programs/edits/line_variants.h"
#include "programs/front/light_program.h"
#include "programs/run/code.h"

namespace trueshade::programs {

namespace {

constexpr size_t kMostVariants = 100;  // compiled, of one line
constexpr size_t kMostLine = 1000;     // characters: ways to write a line grow with the square of its length
constexpr int kDraws = 24;             // of numbers, that programs are compared by

uint64_t mixed(uint64_t hash, uint64_t word) {
  hash = (hash ^ word) * 0x9E3779B97F4A7C15ull;
  return hash ^ hash >> 29;
}

uint64_t hash_of_name(const std::string& name) {
  uint64_t hash = 17;
  for (const char c : name) hash = mixed(hash, uint64_t(c));
  return hash;
}

/// What a picture depends on.
std::vector<NodeId> outputs_of(const Program& program) {
  std::vector<NodeId> out;
  for (int i = 0; i < kOutputCount; ++i)
    if (i != kReachesOutput) out.push_back(program.output[size_t(i)]);
  return out;
}

/// A number for each output that says by which operations it is made, whatever the order of nodes and of the operands
/// of sums and products. A factor of 1 does not count.
std::vector<uint64_t> structure_of(const Program& program) {
  std::vector<uint64_t> hash;
  const auto is_one = [&](NodeId id) {
    return program.nodes[id].op == Op::constant && program.nodes[id].bits == std::bit_cast<uint32_t>(1.0f);
  };
  for (const ProgramNode& node : program.nodes) {
    if (node.op == Op::f_mul && (is_one(node.operand[0]) || is_one(node.operand[1]))) {
      hash.push_back(hash[node.operand[is_one(node.operand[0]) ? 1 : 0]]);
      continue;
    }
    std::array<uint64_t, 3> of{};
    for (size_t k = 0; k < node.operands().size(); ++k) of[k] = hash[node.operand[k]];
    if ((node.op == Op::f_add || node.op == Op::f_mul) && of[0] > of[1]) std::swap(of[0], of[1]);
    uint64_t h = mixed(uint64_t(node.op), uint64_t(node.type));
    if (node.op == Op::input) h = mixed(h, hash_of_name(program.inputs[node.bits].name));
    if (node.op == Op::constant) h = mixed(h, node.bits);
    for (const uint64_t operand : of) h = mixed(h, operand);
    hash.push_back(h);
  }
  std::vector<uint64_t> out;
  for (const NodeId id : outputs_of(program)) out.push_back(hash[id]);
  return out;
}

/// The bits of an input in one draw: lights and surfaces within a few units of each other, positive factors below 1.
uint32_t drawn_input(const ProgramInput& input, int draw, const KnownInputs& known) {
  const uint64_t random = mixed(mixed(hash_of_name(input.name), uint64_t(draw) + 1), 0x2545F4914F6CDD1Dull);
  if (const auto values = known.find(input.name); values != known.end())
    return values->second[size_t(draw) % values->second.size()];
  if (input.type != Type::f32) return uint32_t(random >> 40) % (input.type == Type::boolean ? 2 : 8);
  const double share = double(random >> 11) * 0x1p-53;
  const auto is = [&](const char* field) { return input.name.find(field) != std::string::npos; };
  const bool has_sign = is("position") || is("normal") || is("direction") || is("view.") || is("tangent");
  return std::bit_cast<uint32_t>(float(has_sign ? 3 * share - 1.5 : is("range") ? 3 + 3 * share : 0.1 + 0.9 * share));
}

/// The outputs of each draw.
std::vector<float> values_drawn(const Program& program, const KnownInputs& known) {
  std::vector<float> out;
  std::vector<uint32_t> bits(program.nodes.size());
  for (int draw = 0; draw < kDraws; ++draw) {
    for (NodeId id = 0; id < bits.size(); ++id) {
      const ProgramNode& node = program.nodes[id];
      uint32_t of[3] = {};
      for (size_t k = 0; k < node.operands().size(); ++k) of[k] = bits[node.operand[k]];
      bits[id] = node.op == Op::constant ? node.bits
                 : node.op == Op::input  ? drawn_input(program.inputs[node.bits], draw, known)
                                         : applied(node.op, node.type, of[0], of[1], of[2]);
    }
    for (const NodeId id : outputs_of(program)) out.push_back(std::bit_cast<float>(bits[id]));
  }
  return out;
}

bool are_alike(const std::vector<float>& a, const std::vector<float>& b) {
  constexpr float kPart = 1e-4f, kSmall = 1e-9f;
  for (size_t i = 0; i < a.size(); ++i) {
    if (!std::isfinite(a[i]) && a[i] == a[i] && a[i] != b[i]) return false;
    const bool is_same = a[i] == b[i] || (a[i] != a[i] && b[i] != b[i]);
    if (!is_same && !(std::fabs(a[i] - b[i]) <= kPart * std::fabs(a[i]) + kSmall)) return false;
  }
  return true;
}

/// A number as GLSL has floats.
std::string literal_of(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", x);
  std::string out = text;
  if (out.find_first_of(".e") == std::string::npos) out += ".0";
  return out;
}

/// What may stand for the other value of an edit: names that its line assigns; of the albedo how the text reads it.
std::vector<std::string> factors_of(const Program& program, const std::string& text, const ProgramEdit& edit) {
  if (edit.others.empty()) return {};
  const ProgramNode& other = program.nodes[edit.others[0]];
  if (other.op != Op::input) return assigned_names(source_line(text, other.line));
  for (const char* reads : {".albedo.rgb", ".albedo.xyz"})
    if (const size_t at = text.find(reads); at != std::string::npos) {
      size_t from = at;
      while (from > 0 && (std::isalnum(static_cast<unsigned char>(text[from - 1])) != 0 || text[from - 1] == '_'))
        --from;
      return {text.substr(from, at - from) + reads};
    }
  return {};
}

}  // namespace

std::optional<std::string> edited_line(const Program& program, const std::string& text, const ProgramEdit& asked,
                                       const KnownInputs& known) {
  const std::string_view line = source_line(text, asked.line);
  if (asked.is_parameter || line.empty() || line.size() > kMostLine) return std::nullopt;
  ProgramEdit edit = asked;
  const std::string number = literal_of(edit.number);
  if (edit.fitted) edit.number = std::strtod(number.c_str(), nullptr);
  const Program wanted = specialised(edited(program, edit), known);
  const std::vector<uint64_t> structure = structure_of(wanted);
  const std::vector<float> values = values_drawn(wanted, known);
  const bool shows = !are_alike(values, values_drawn(program, known));
  const size_t begin = size_t(line.data() - text.data());
  std::vector<std::string> variants = line_variants(line, edit, number, factors_of(program, text, edit));
  // The shortest first: `b` rather than `1.0 * b`.
  std::stable_sort(variants.begin(), variants.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
  variants.resize(std::min(variants.size(), kMostVariants));
  std::optional<std::string> alike;
  for (std::string& variant : variants) {
    std::string otherwise = text;
    otherwise.replace(begin, line.size(), variant);
    try {
      const Program made = specialised(program_from_glsl(program.name, otherwise), known);
      if (structure_of(made) == structure) return std::move(variant);
      if (shows && !alike && are_alike(values, values_drawn(made, known))) alike = std::move(variant);
    } catch (const Error&) {  // no GLSL, or none of a light
    }
  }
  return alike;
}

}  // namespace trueshade::programs
