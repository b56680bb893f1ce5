#pragma once

#include "storage/detail/timed_table.h"
#include "storage/session_file.h"

namespace trocar::storage::detail {

/// The table `transducer`: time, origin and rotation of X_PT, force of contact.
const TimedTable& transducer_table();
void add(TimedBuffer& buffer, const TransducerSample& sample);
/// Throws soci::soci_error, also for an invalid pose.
std::vector<TransducerSample> read_transducer(soci::session& database);

}  // namespace trocar::storage::detail
