#include "io/image/detail/quiet.h"

#include <fcntl.h>
#include <itkObject.h>
#include <nifti1_io.h>
#include <unistd.h>

#include <cstdio>
#include <mutex>

namespace trocar::io::detail {
namespace {

/// The original standard error, while at least one MutedStandardError exists.
struct Muting {
  std::mutex mutex;
  int count = 0;
  int saved = -1;
};

Muting& muting() {
  static Muting shared;
  return shared;
}

}  // namespace

ItkCall::ItkCall() {
  static std::once_flag once;
  std::call_once(once, [] {
    itk::Object::SetGlobalWarningDisplay(false);
    nifti_set_debug_level(0);
  });
}

MutedStandardError::MutedStandardError() {
  Muting& shared = muting();
  const std::lock_guard lock(shared.mutex);
  if (shared.count++ > 0) return;
  std::fflush(stderr);
  shared.saved = ::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (shared.saved >= 0 && nowhere >= 0) ::dup2(nowhere, STDERR_FILENO);
  if (nowhere >= 0) ::close(nowhere);
}

MutedStandardError::~MutedStandardError() {
  Muting& shared = muting();
  const std::lock_guard lock(shared.mutex);
  if (--shared.count > 0 || shared.saved < 0) return;
  std::fflush(stderr);
  ::dup2(shared.saved, STDERR_FILENO);
  ::close(shared.saved);
  shared.saved = -1;
}

}  // namespace trocar::io::detail
