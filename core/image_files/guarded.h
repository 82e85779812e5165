#pragma once
#include <exception>
#include <new>
#include <string>

#include "core/error.h"

namespace trueshade {

/// What `job` returns, with an exception of OpenImageIO's own made one of ours. Running out of memory stays that.
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
