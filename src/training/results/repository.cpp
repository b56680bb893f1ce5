#include "results/repository.h"

#include <cstdlib>

#include "core/files/folders.h"
#include "results/detail/attempt_query.h"
#include "results/detail/schema.h"

namespace trocar::results {

Result<database::DatabaseUrl> default_url() {
  const char* const given = std::getenv("TROCAR_DB");
  if (given == nullptr || *given == '\0') return database::DatabaseUrl{user_data_folder() / "results.sqlite", {}};
  auto url = database::parse_url(given);
  if (!url) url.error().where = "$TROCAR_DB";
  return url;
}

Result<Repository> Repository::open(const database::DatabaseUrl& url, database::Missing missing) {
  TROCAR_TRY(database::Database opened, database::Database::open(url, missing));
  TROCAR_TRY_STATUS(database::migrate(opened, kApplicationId, detail::migrations()));
  return Repository(std::move(opened));
}

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
