#pragma once

#include <signal.h>

namespace trocar::dicom::detail {

/// DCMTK prints nothing, waits at most `timeout_s` for bytes, and looks up no names of peers. The settings belong to
/// the whole process.
void configure_dcmtk(int timeout_s);

/// While an object exists, writing to a closed connection is an error of the call and does not end the program. For
/// libraries that write without MSG_NOSIGNAL; affects the calling thread.
class BrokenPipesIgnored {
 public:
  BrokenPipesIgnored() noexcept;
  ~BrokenPipesIgnored();
  BrokenPipesIgnored(const BrokenPipesIgnored&) = delete;
  BrokenPipesIgnored& operator=(const BrokenPipesIgnored&) = delete;

 private:
  sigset_t before_{};
};

}  // namespace trocar::dicom::detail
