// Embedded patients in the user's cache: the same results with it and without.
#include <gtest/gtest.h>

#include "cli/program.h"
#include "core/files/output_file.h"

namespace trocar::cli_test {
namespace {
namespace fs = std::filesystem;

TEST(Cache, CachedPatientGivesTheSameSession) {
  const TemporaryFolder folder;
  const std::string cached = "XDG_CACHE_HOME='" + (folder / "cache") + "'";
  const auto run = [&](const std::string& name, const std::string& more) {
    const Outcome ran =
        trocar("run liver-biopsy --patient layers-liver --patient-seed 3 --operator constant-velocity:40 --out '" +
                   (folder / name) + "' " + more,
               cached);
    EXPECT_EQ(ran.exit_status, 0) << ran.err;
    EXPECT_EQ(trocar("session export '" + (folder / name) + "' --csv '" + (folder / (name + ".csv")) + "'").exit_status,
              0);
  };
  run("plain", "--no-cache");
  EXPECT_FALSE(fs::exists(folder / "cache"));
  run("cold", "");
  const fs::path entries = fs::path(folder / "cache") / "trocar" / "patients";
  ASSERT_TRUE(fs::exists(entries));
  const auto entry = fs::directory_iterator(entries)->path();
  EXPECT_TRUE(entry.filename().string().starts_with("layers-liver-3-")) << entry;
  run("warm", "");
  const std::string plain = read_file(folder / "plain.csv").value_or("");
  ASSERT_GT(plain.size(), 100000u);
  for (const char* name : {"cold", "warm"})
    EXPECT_TRUE(read_file(folder / (name + std::string(".csv"))).value_or("") == plain) << name << ": another bit";
  // A damaged entry is generated again.
  fs::resize_file(entry / "ct.nrrd", 100);
  run("mended", "");
  EXPECT_GT(fs::file_size(entry / "ct.nrrd"), 100u);
}

}  // namespace
}  // namespace trocar::cli_test
