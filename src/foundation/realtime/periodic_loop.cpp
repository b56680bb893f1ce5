#include "realtime/periodic_loop.h"

#include <fmt/format.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>

namespace trocar::realtime {

std::string RealTimeGrant::text() const {
  if (!was_asked) return "ordinary scheduling, as requested";
  const std::string scheduling =
      has_fifo ? fmt::format("SCHED_FIFO priority {}", priority)
               : std::string("no SCHED_FIFO (to allow it, add an rtprio line to /etc/security/limits.conf)");
  return scheduling + (has_locked_memory ? ", memory locked" : ", memory not locked (raise memlock in limits.conf)");
}

RealTimeGrant request_real_time(int priority) noexcept {
  RealTimeGrant grant;
  grant.has_fine_timers = prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL) == 0;
  grant.was_asked = priority > 0;
  if (!grant.was_asked) return grant;
  grant.has_locked_memory = mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
  sched_param wanted{};
  wanted.sched_priority = priority;
  grant.has_fifo = sched_setscheduler(0, SCHED_FIFO, &wanted) == 0;
  if (grant.has_fifo) grant.priority = priority;
  return grant;
}

}  // namespace trocar::realtime
