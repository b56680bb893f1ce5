#include "results/repository.h"

#include <cstdlib>

#include "core/check.h"
#include "core/files/user_folders.h"
#include "results/detail/schema.h"
#include "signing/token.h"

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

std::string make_id() {
  constexpr int kBits = 128;
  const auto token = signing::make_token(kBits);
  TROCAR_CHECK(token.has_value());  // libsodium was loaded with this program
  return signing::token_digest(*token).substr(0, kBits / 4);
}

}  // namespace trocar::results
