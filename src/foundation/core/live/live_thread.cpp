#include "core/live/live_thread.h"

#ifdef __linux__
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>
#endif

namespace trocar {
inline namespace core {

void lower_priority(int nice) noexcept {
#ifdef __linux__
  const auto thread = static_cast<id_t>(::syscall(SYS_gettid));
  (void)::setpriority(PRIO_PROCESS, thread, ::getpriority(PRIO_PROCESS, thread) + nice);
#else
  (void)nice;
#endif
}

}  // namespace core
}  // namespace trocar
