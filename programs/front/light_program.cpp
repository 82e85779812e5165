#include "programs/front/light_program.h"

#include <spirv-tools/libspirv.h>

#include <memory>
#include <utility>

#include "core/error.h"
#include "core/printable_text.h"
#include "core/sha256.h"
#include "programs/front/lowering.h"

namespace trueshade::programs {
namespace {

/// Dead nodes and those that choices leave behind are made too; so many times what is left may be.
constexpr size_t kMadeForEachLeft = 20;

struct SpirvToolsDeleter {
  void operator()(spv_context context) const { spvContextDestroy(context); }
  void operator()(spv_validator_options options) const { spvValidatorOptionsDestroy(options); }
};

/// Refuses what spirv-val refuses. Offsets are not looked at, because blocks are read by their members' names.
void validate_spirv(const std::string& file, const std::vector<uint32_t>& words) {
  const std::unique_ptr<spv_context_t, SpirvToolsDeleter> context(spvContextCreate(SPV_ENV_VULKAN_1_1));
  const std::unique_ptr<spv_validator_options_t, SpirvToolsDeleter> options(spvValidatorOptionsCreate());
  spvValidatorOptionsSetSkipBlockLayout(options.get(), true);
  spv_const_binary_t binary{words.data(), words.size()};
  spv_diagnostic diagnostic = nullptr;
  const spv_result_t result = spvValidateWithOptions(context.get(), options.get(), &binary, &diagnostic);
  std::string reason = diagnostic != nullptr && diagnostic->error != nullptr ? diagnostic->error : "no reason given";
  spvDiagnosticDestroy(diagnostic);
  if (result == SPV_SUCCESS) return;
  reason = printable(reason.substr(0, reason.find('\n')), Lines::one);
  throw Error(ErrorKind::bad_input, file, "spirv-val refuses it: " + reason, "compile it for Vulkan 1.1");
}

std::string sha256_of(const std::vector<uint32_t>& words) {
  Sha256 sum;
  sum.update(words.data(), words.size() * sizeof(uint32_t));
  return sum.hex();
}

Program lowered(const std::string& file, std::vector<uint32_t> words, const ProgramLimits& limits, bool main_is_ours) {
  uint32_t line = 0;
  try {
    const SpirvModule module = spirv_module(std::move(words));
    NodeBuilder builder(file, limits.nodes * kMadeForEachLeft);
    Lowering lowering(module, builder, limits, main_is_ours);
    try {
      lowering.run();
    } catch (...) {
      line = lowering.line();
      throw;
    }
    return without_dead_nodes(builder.program());
  } catch (const Refusal& refusal) {
    const std::string where = line == 0 ? file : file + ":" + std::to_string(line);
    throw Error(refusal.kind, where, refusal.reason, refusal.remedy);
  }
}

Program program_of(const std::string& file, std::vector<uint32_t> words, const ProgramLimits& limits,
                   bool main_is_ours) {
  if (words.size() > limits.words)
    throw Error(ErrorKind::limit, file, "has more than " + std::to_string(limits.words) + " words of SPIR-V",
                "make it shorter");
  validate_spirv(file, words);
  const std::string sha256 = sha256_of(words);
  Program program = lowered(file, std::move(words), limits, main_is_ours);
  program.name = file;
  program.sha256 = sha256;
  if (program.nodes.size() > limits.nodes)
    throw Error(ErrorKind::limit, file, "has " + std::to_string(program.nodes.size()) + " operations on scalars",
                "make it shorter, or raise --max-program-nodes");
  set_rates(program);
  const std::string fault = fault_of_outputs(program);
  if (!fault.empty()) throw Error(ErrorKind::bad_input, file, fault, "see programs/light_interface.glsl");
  return program;
}

}  // namespace

Program program_from_glsl(const std::string& file, const std::string& text, const ProgramLimits& limits) {
  CompiledLight compiled = compiled_light(file, text, limits);
  Program program = program_of(file, std::move(compiled.words), limits, true);
  program.defines_reaches = compiled.defines_reaches;
  program.defines_start = compiled.defines_start;
  program.defines_finish = compiled.defines_finish;
  return program;
}

Program program_from_spirv(const std::string& file, std::vector<uint32_t> words, const ProgramLimits& limits) {
  Program program = program_of(file, std::move(words), limits, false);
  program.defines_reaches = program.defines_start = program.defines_finish = true;
  return program;
}

}  // namespace trueshade::programs
