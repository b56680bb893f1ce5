#pragma once

#include <soci/soci.h>

namespace trocar::results::detail {

/// Changes the key of results::last_deletion, within the transaction of a deletion. Throws soci::soci_error.
void note_deletion(soci::session& session);

}  // namespace trocar::results::detail
