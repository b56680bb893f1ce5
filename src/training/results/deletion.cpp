#include "results/deletion.h"

#include "results/detail/note_deletion.h"

namespace trocar::results {

Result<bool> erase_deleted(Repository& repository, std::chrono::milliseconds wait) {
  return repository.database().empty_log(wait);
}

Result<std::string> last_deletion(Repository& repository) {
  return repository.database().run("the deletions cannot be read", [](soci::session& session) {
    std::string key;
    session << "SELECT value FROM settings WHERE name = 'last_deletion'", soci::into(key);
    return session.got_data() ? key : std::string();
  });
}

namespace detail {

void note_deletion(soci::session& session) {
  const std::string key = make_id();
  session << "INSERT INTO settings (name, value) VALUES ('last_deletion', :k)"
             " ON CONFLICT (name) DO UPDATE SET value = excluded.value",
      soci::use(key);
}

}  // namespace detail
}  // namespace trocar::results
