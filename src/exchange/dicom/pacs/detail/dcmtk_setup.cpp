#include "dicom/pacs/detail/dcmtk_setup.h"

#include <pthread.h>

#include <ctime>
#include <mutex>

// DCMTK's headers need this one first.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmnet/dcmtrans.h>
#include <dcmtk/dcmnet/dul.h>
#include <dcmtk/oflog/oflog.h>

namespace trocar::dicom::detail {

void configure_dcmtk(int timeout_s) {
  static std::once_flag once;
  std::call_once(once, [] { OFLog::configure(OFLogger::OFF_LOG_LEVEL); });
  dcmDisableGethostbyaddr.set(OFTrue);
  dcmConnectionTimeout.set(timeout_s);
  dcmSocketReceiveTimeout.set(timeout_s);
  dcmSocketSendTimeout.set(timeout_s);
}

BrokenPipesIgnored::BrokenPipesIgnored() noexcept {
  sigset_t pipe;
  ::sigemptyset(&pipe);
  ::sigaddset(&pipe, SIGPIPE);
  ::pthread_sigmask(SIG_BLOCK, &pipe, &before_);
}

BrokenPipesIgnored::~BrokenPipesIgnored() {
  if (::sigismember(&before_, SIGPIPE) == 0) {
    sigset_t pipe;
    ::sigemptyset(&pipe);
    ::sigaddset(&pipe, SIGPIPE);
    const timespec now{};
    while (::sigtimedwait(&pipe, nullptr, &now) == SIGPIPE) {
    }
  }
  ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

}  // namespace trocar::dicom::detail
