#pragma once

#include <chrono>
#include <string>

#include "results/repository.h"

namespace trocar::results {

/// Takes deleted data out of the write-ahead log of an SQLite file, too. Functions that delete call it. False: another
/// connection read an older state of the database for longer than `wait`; the data are to be erased again later.
Result<bool> erase_deleted(Repository& repository, std::chrono::milliseconds wait = std::chrono::seconds(10));

/// A key that is another one after every deletion, by whatever program: values that were read before may show the
/// deleted data. Empty: nothing was deleted yet.
Result<std::string> last_deletion(Repository& repository);

}  // namespace trocar::results
