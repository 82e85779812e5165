#include "programs/front/glsl_compiler.h"

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>
#include <glslang/build_info.h>
#include <pthread.h>

#include <cstdlib>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <string_view>

#include "core/error.h"
#include "core/printable_text.h"
#include "programs/front/bounded_process.h"
#include "programs/front/light_interface_text.h"
#include "programs/front/macro_growth.h"

namespace trueshade::programs {
namespace {

/// glslang for the length of the process.
struct GlslangProcess {
  GlslangProcess() { glslang::InitializeProcess(); }
  ~GlslangProcess() { glslang::FinalizeProcess(); }
  GlslangProcess(const GlslangProcess&) = delete;
  GlslangProcess& operator=(const GlslangProcess&) = delete;
  mutable std::mutex mutex;  ///< held while the process forks, so that no other thread holds a lock of glslang
};

/// What a line of glslang's log says: `ERROR: TEXT:LINE: message`, and of newer versions `ERROR: TEXT:LINE:COLUMN:
/// ...`.
struct GlslError {
  int text = -1, line = 0, column = 0;  ///< text: its number among those that were compiled
  std::string message;
};

std::optional<GlslError> error_in(std::string_view log_line) {
  constexpr std::string_view kStart = "ERROR: ";
  if (!log_line.starts_with(kStart)) return std::nullopt;
  log_line.remove_prefix(kStart.size());
  GlslError out;
  for (int* const number : {&out.text, &out.line, &out.column}) {
    const size_t digits = log_line.find_first_not_of("0123456789");
    if (digits == 0 || digits > 9 || digits == std::string_view::npos || log_line[digits] != ':') break;
    *number = std::atoi(std::string(log_line.substr(0, digits)).c_str());
    log_line.remove_prefix(digits + 1);
  }
  while (log_line.starts_with(' ')) log_line.remove_prefix(1);
  out.message = printable(log_line, Lines::one);
  while (out.message.ends_with(' ')) out.message.pop_back();
  return out;
}

/// Older versions tell no column: it is found where the text that they quote stands once in its line.
int column_of(const std::string& text, const GlslError& error) {
  if (error.column > 0) return error.column;
  const size_t end = error.message.find('\'', 1);
  if (!error.message.starts_with('\'') || end == std::string::npos || end == 1) return 0;
  const std::string quoted = error.message.substr(1, end - 1);
  size_t first = 0;
  for (int line = 1; line < error.line && first != std::string::npos; ++line) {
    first = text.find('\n', first);
    if (first != std::string::npos) ++first;
  }
  if (first == std::string::npos) return 0;
  const std::string_view line = std::string_view(text).substr(first, text.find('\n', first) - first);
  const size_t at = line.find(quoted);
  return at == std::string_view::npos || line.find(quoted, at + 1) != std::string_view::npos ? 0 : int(at) + 1;
}

/// What an editor may have put before the text, which no compiler takes for it.
void refuse_byte_order_mark(const std::string& file, std::string_view text) {
  for (const std::string_view mark : {"\xEF\xBB\xBF", "\xFF\xFE", "\xFE\xFF"})
    if (text.starts_with(mark))
      throw Error(ErrorKind::bad_input, file + ":1:1", "begins with a byte order mark", "save it as UTF-8 without one");
}

/// A few lines of macros are more than any memory holds, once they are expanded.
void refuse_growth(const std::string& file, uint64_t tokens, const ProgramLimits& limits) {
  if (tokens <= limits.tokens) return;
  const std::string most = std::to_string(limits.tokens);
  throw Error(
      ErrorKind::limit, file,
      tokens >= kEndlessGrowth
          ? "has macros that grow beyond all bounds, where " + most + " tokens are the most"
          : "has " + std::to_string(tokens) + " tokens once its macros are expanded, where " + most + " are the most",
      "make it shorter");
}

/// `number`: of the user's text among those that were compiled.
[[noreturn]] void throw_first(const std::string& file, const std::string& text, int number, const std::string& log) {
  for (size_t first = 0; first < log.size();) {
    const size_t end = std::min(log.find('\n', first), log.size());
    const std::optional<GlslError> error = error_in(std::string_view(log).substr(first, end - first));
    first = end + 1;
    if (!error) continue;
    std::string where = file;
    if (error->text == number && error->line > 0) {
      where += ":" + std::to_string(error->line);
      if (const int column = column_of(text, *error); column > 0) where += ":" + std::to_string(column);
    }
    if (error->text == number + 1)
      throw Error(ErrorKind::bad_input, where, "clashes with the entry point: " + error->message,
                  "leave no brace or comment open, and define neither main nor names with ts_");
    if (error->message.starts_with("'#version'"))
      throw Error(ErrorKind::bad_input, where, "states a #version, and stands behind a text that has stated it",
                  "leave the line out: it is GLSL 4.60");
    throw Error(ErrorKind::bad_input, where, error->message,
                number == 0 ? "correct the GLSL" : "leave alone what a driver's shader has before it");
  }
  throw Error(ErrorKind::bad_input, file, "is not GLSL that glslang compiles", "correct the GLSL");
}

std::vector<uint32_t> compiled(const std::string& file, const std::string& text, const std::string& tail,
                               bool keep_uncalled, const std::string& before) {
  constexpr int kVersion = 460;
  auto messages = EShMessages(EShMsgSpvRules | EShMsgVulkanRules);
  if (keep_uncalled) messages = EShMessages(messages | EShMsgKeepUncalled);
#if GLSLANG_VERSION_GREATER_OR_EQUAL_TO(15, 0, 0)
  messages = EShMessages(messages | EShMsgDisplayErrorColumn);
#endif
  const std::string ended = text + "\n";  // a last line without an end would run into the tail
  const char* const texts[] = {before.c_str(), ended.c_str(), tail.c_str()};
  const int lengths[] = {int(before.size()), int(ended.size()), int(tail.size())};
  const int number = before.empty() ? 0 : 1, left_out = 1 - number;  // without `before`, the text is the first
  glslang::TShader shader(EShLangCompute);
  shader.setStringsWithLengths(texts + left_out, lengths + left_out, 3 - left_out);
  shader.setPreamble(kLightInterface);
  shader.setEnvInput(glslang::EShSourceGlsl, EShLangCompute, glslang::EShClientVulkan, 100);
  shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_1);
  shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_3);
  shader.setAutoMapBindings(true);
  if (!shader.parse(GetDefaultResources(), kVersion, false, messages))
    throw_first(file, text, number, shader.getInfoLog());
  glslang::TProgram program;
  program.addShader(&shader);
  if (!program.link(messages) || !program.mapIO()) throw_first(file, text, number, program.getInfoLog());
  glslang::SpvOptions options;
  options.generateDebugInfo = true;
  options.disableOptimizer = true;
  std::vector<uint32_t> words;
  glslang::GlslangToSpv(*program.getIntermediate(EShLangCompute), words, &options);
  return words;
}

/// glslang with the tables of what GLSL has, which its first text makes it build in some 50 ms: processes that are copied
/// from this one have them.
const GlslangProcess& glslang_process() {
  static const struct Ready {
    GlslangProcess process;
    Ready() { compiled("", "", "layout(local_size_x = 1) in; void main() {}", false, {}); }
  } ready;
  return ready.process;
}

/// Runs a task on a thread whose stack holds a recursion so deep, with what a step of glslang's takes, some 1 kB, and
/// as much thrice as room for checked builds; on the caller's where the system gives no such thread.
void on_deep_stack(uint64_t depth, const std::function<void()>& task) {
  constexpr size_t kLeast = size_t(8) << 20, kStep = 4096;  // the pages that are used count
  const size_t stack = kLeast + kStep * size_t(depth);
  struct Call {
    const std::function<void()>& task;
    std::exception_ptr thrown;
  } call{task, nullptr};
  const auto run = [](void* of) -> void* {
    Call& mine = *static_cast<Call*>(of);
    try {
      mine.task();
    } catch (...) {
      mine.thrown = std::current_exception();
    }
    return nullptr;
  };
  pthread_attr_t attributes;
  pthread_t thread;
  pthread_attr_init(&attributes);
  const bool started =
      pthread_attr_setstacksize(&attributes, stack) == 0 && pthread_create(&thread, &attributes, run, &call) == 0;
  pthread_attr_destroy(&attributes);
  if (!started) return task();
  pthread_join(thread, nullptr);
  if (call.thrown) std::rethrow_exception(call.thrown);
}

}  // namespace

std::vector<uint32_t> spirv_of_glsl(const std::string& file, const std::string& text, const std::string& tail,
                                    bool keep_uncalled, const std::string& before, const ProgramLimits& limits) {
  refuse_byte_order_mark(file, text);
  std::vector<uint32_t> words;
  uint64_t tokens = 0;
  on_deep_stack(text.size() / 4, [&] { tokens = tokens_with_macros(text); });
  refuse_growth(file, tokens, limits);
  const GlslangProcess& process = glslang_process();
  on_deep_stack(tokens, [&] {
    const std::lock_guard lock(process.mutex);
    words = in_bounded_process(file, limits, [&] { return compiled(file, text, tail, keep_uncalled, before); });
  });
  return words;
}

}  // namespace trueshade::programs
