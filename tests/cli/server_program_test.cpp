// The haptic server is a program of its own without what only its clients need.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "cli/program.h"

namespace trocar::cli_test {
namespace {

std::string told_of_server(const std::string& tool) {
  const Outcome outcome = run_shell(tool + " '" + std::getenv("TROCAR_BIN_DIR") + "/trocar-hapticd'");
  EXPECT_EQ(outcome.exit_status, 0) << outcome.err;
  return outcome.out;
}

bool contains(const std::string& text, const char* part) {
  return text.find(part) != std::string::npos;
}

TEST(ServerProgram, LoadsNeitherSessionsNorSurfacesNorDicom) {
  const std::string libraries = told_of_server("readelf -d");
  EXPECT_TRUE(contains(libraries, "libITK")) << "it reads patient folders";
  for (const char* library : {"libvtk", "libgdcm", "libsoci", "libsqlite", "libQt", "libpng"})
    EXPECT_FALSE(contains(libraries, library)) << library;
}

TEST(ServerProgram, ContainsNoCodeOfItsClients) {
  const std::string symbols = told_of_server("nm -C");
  EXPECT_TRUE(contains(symbols, "trocar::io::load_patient("));
  for (const char* code : {"trocar::storage::", "trocar::surface::", "trocar::attempt::", "trocar::io::save_patient(",
                           "trocar::io::write_image(", "trocar::io::detail::write_with_itk("})
    EXPECT_FALSE(contains(symbols, code)) << code;
}

TEST(ServerProgram, ReportsAMalformedSavedWeightAndCanForgetIt) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "trocar/styluses/virtual%3Aomni.toml";
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file) << "device = \"virtual:omni\"\npreset = \"omni\"\nstylus_weight_n = nan\n";
  const std::string home = "XDG_CONFIG_HOME='" + folder.path().string() + "'";
  const std::string endpoint = " --endpoint 'ipc://" + (folder / "server") + "'";
  const Outcome refused = run_program("trocar-hapticd", "--device virtual:omni" + endpoint, home);
  EXPECT_EQ(refused.exit_status, 1);
  EXPECT_EQ(line_count(refused.err), 1) << refused.err;
  EXPECT_TRUE(contains(refused.err, file.c_str())) << refused.err;
  const Outcome forgot = run_program("trocar-hapticd", "--device virtual:omni --test", "echo forget | " + home);
  EXPECT_EQ(forgot.exit_status, 0) << forgot.err;
  EXPECT_TRUE(contains(forgot.out, "forgot\t")) << forgot.out;
  EXPECT_FALSE(std::filesystem::exists(file));
}

}  // namespace
}  // namespace trocar::cli_test
