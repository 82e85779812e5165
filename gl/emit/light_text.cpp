#include "gl/emit/light_text.h"

#include <cstring>
#include <map>
#include <mutex>

#include "core/error.h"

namespace trueshade::oracle {
namespace {

LightText made(const LightProgram& program) {
  LightText out;
  out.outline = programs::light_outline(program.file, program.text);
  out.reads = program_reads(program.file, out.outline.inputs);
  require_fields(program.file, out.reads.captured);
  return out;
}

}  // namespace

std::shared_ptr<const LightText> light_text_of(const Pipeline& pipeline) {
  static std::mutex mutex;
  static std::map<std::string, std::shared_ptr<const LightText>> kept;
  constexpr size_t kMost = 64;  // programs of a process; then all are compiled anew
  const LightProgram& program = pipeline.light_program;
  if (!program.used()) return nullptr;
  if (program.text.empty())
    throw Error(ErrorKind::usage, program.file, "the text of this light program is not here", "give it with its name");
  std::shared_ptr<const LightText> out;
  {
    const std::lock_guard lock(mutex);
    if (kept.size() >= kMost) kept.clear();
    std::shared_ptr<const LightText>& there = kept[program.file + '\n' + program.text];
    if (there == nullptr) there = std::make_shared<LightText>(made(program));
    out = there;
  }
  check_values(program, out->outline.inputs, out->outline.declared);
  return out;
}

ProgramReads surface_reads(const Pipeline& pipeline, const GlslOptions& options) {
  const std::shared_ptr<const LightText> text = light_text_of(pipeline);
  if (text == nullptr) return {};
  ProgramReads reads = text->reads;
  reads.material = reads.material || options.unlit;
  return reads;
}

std::vector<uint8_t> parameter_bytes(const Pipeline& pipeline) {
  const std::shared_ptr<const LightText> text = light_text_of(pipeline);
  if (text == nullptr) return {};
  std::vector<uint8_t> bytes(text->outline.parameter_bytes);
  for (const programs::ParameterPlace& place : text->outline.parameters) {
    const float value = parameter_value(place.name, pipeline.light_program).value_or(0.0f);  // else it is not read
    const auto whole = uint32_t(int64_t(place.type == programs::Type::f32 ? 0.0f : value));
    std::memcpy(&bytes[place.offset], place.type == programs::Type::f32 ? static_cast<const void*>(&value) : &whole, 4);
  }
  return bytes;
}

}  // namespace trueshade::oracle
