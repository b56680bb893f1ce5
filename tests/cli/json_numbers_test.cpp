// Numbers of --json: digits of the value, not of the arithmetic.
#include <gtest/gtest.h>

#include <regex>

#include "cli/program.h"
#include "storage/session_file.h"

namespace trocar::cli_test {
namespace {

TEST(JsonNumbers, HaveNoRoundingDigits) {
  const TemporaryFolder folder;
  const std::string session = folder / "a.trocar";
  const Outcome ran =
      trocar("run liver-biopsy --patient abdomen --operator constant-velocity:20 --json --out '" + session + "'");
  ASSERT_EQ(ran.exit_status, 0) << ran.err;
  const Outcome measured = trocar("session metrics '" + session + "' --json");
  const auto recorded = storage::load_session(session);
  ASSERT_TRUE(recorded) << recorded.error().text();
  const std::regex noise("\\d\\.\\d*(0000000|9999999)\\d");
  for (const std::string& text : {ran.out, measured.out, recorded->info.tissue_table_toml}) {
    ASSERT_FALSE(text.empty());
    std::smatch found;
    EXPECT_FALSE(std::regex_search(text, found, noise)) << found.str() << found.suffix().str().substr(0, 40);
    EXPECT_FALSE(std::regex_search(text, found, std::regex("[1-9]\\d*\\.\\d{14}"))) << found.str();
  }
}

}  // namespace
}  // namespace trocar::cli_test
