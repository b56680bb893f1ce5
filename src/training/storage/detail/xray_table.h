#pragma once

#include "storage/detail/timed_table.h"
#include "tasks/xray_use.h"

namespace trocar::storage::detail {

/// The table `xray`: time, place of the C-arm, whether the beam is on, contrast agent and dose up to then.
const TimedTable& xray_table();
void add(TimedBuffer& buffer, const tasks::XrayUse& use);
/// Throws soci::soci_error, also for a dose that is negative.
std::vector<tasks::XrayUse> read_xray(soci::session& database);

}  // namespace trocar::storage::detail
