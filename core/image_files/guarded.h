#pragma once
#include <exception>
#include <new>
#include <string>

#include "core/error.h"

namespace trueshade {

/// Returns what `job` returns. An exception of OpenImageIO's is turned into Error(io); Error and std::bad_alloc pass as
/// they are.
template <typename Job>
auto guarded(const std::string& path, Job job) {
  try {
    return job();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& failure) {
    throw Error(ErrorKind::io, path, std::string("OpenImageIO failed: ") + failure.what(), "check the file");
  }
}

}  // namespace trueshade
