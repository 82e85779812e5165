#include "tests/gl/opened_driver.h"

#include <map>
#include <memory>

#include "core/error.h"
#include "tests/catch.hpp"

namespace trueshade::testing {

using oracle::GlContext;
using oracle::GlDriver;

const GlContext* opened(GlDriver which) {
  static std::map<GlDriver, std::unique_ptr<GlContext>> contexts;
  if (const auto found = contexts.find(which); found != contexts.end()) return found->second.get();
  try {
    return (contexts[which] = std::make_unique<GlContext>(which)).get();
  } catch (const Error& error) {
    contexts.erase(which);
    WARN("SKIPPED: " << error.what());
    return nullptr;
  }
}

bool is_of_known_profile(const GlContext& context) {
  const std::string driver = context.info().line();
  if (driver.find("llvmpipe") == std::string::npos) return false;
  return driver.find("Mesa 22.3.") != std::string::npos || driver.find("Mesa 25.0.") != std::string::npos;
}

const GlContext* opened_mesa_22_3() {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr || context->info().version.find("Mesa 22.3.") != std::string::npos) return context;
  WARN("SKIPPED: the profile is that of Mesa 22.3, this is " << context->info().line());
  return nullptr;
}

}  // namespace trueshade::testing
