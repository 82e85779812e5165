#include <cstring>
#include <map>
#include <mutex>
#include <utility>

#include "core/error.h"
#include "core/sha256.h"
#include "programs/front/light_program.h"
#include "programs/front/spirv_words.h"

namespace trueshade::programs {
namespace {

Program compiled(const std::string& file, const std::string& text) {
  uint32_t first = 0;
  if (text.size() >= sizeof first) std::memcpy(&first, text.data(), sizeof first);
  if (first != kSpirvMagic) return program_from_glsl(file, text);
  std::vector<uint32_t> words((text.size() + 3) / 4);
  std::memcpy(words.data(), text.data(), text.size());
  return program_from_spirv(file, std::move(words));
}

}  // namespace

std::shared_ptr<const Program> kept_program(const std::string& file, const std::string& text) {
  static std::mutex mutex;
  static std::map<std::string, std::shared_ptr<const Program>> kept;
  constexpr size_t kMost = 64;  // of a process; then all are compiled anew
  if (text.empty())
    throw Error(ErrorKind::usage, file, "the text of this light program is not here", "give it with its name");
  const std::string key = file + '\n' + sha256_of(text);
  const std::lock_guard lock(mutex);
  if (const auto there = kept.find(key); there != kept.end()) return there->second;
  if (kept.size() >= kMost) kept.clear();
  return kept[key] = std::make_shared<const Program>(compiled(file, text));
}

}  // namespace trueshade::programs
