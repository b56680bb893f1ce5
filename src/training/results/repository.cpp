#include "results/repository.h"

#include <cstdlib>

#include "core/files/user_folders.h"
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

}  // namespace trocar::results
