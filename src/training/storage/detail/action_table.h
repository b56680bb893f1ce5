#pragma once

#include "storage/detail/timed_table.h"
#include "tasks/action.h"

namespace trocar::storage::detail {

/// The table `actions`: time, kind, amount, what came back, place of the tip.
const TimedTable& action_table();
void add(TimedBuffer& buffer, const tasks::Action& action);
/// Throws soci::soci_error, also for a kind or substance that does not exist.
std::vector<tasks::Action> read_actions(soci::session& database);

}  // namespace trocar::storage::detail
