// The haptic server is a program of its own without what only its clients need.
#include <gtest/gtest.h>

#include <cstdlib>

#include "cli/program.h"

namespace trocar::cli_test {
namespace {

std::string told_of_server(const std::string& tool) {
  const Outcome outcome = run_shell(tool + " '" + std::getenv("TROCAR_BIN_DIR") + "/trocar-hapticd'");
  EXPECT_EQ(outcome.exit_status, 0) << outcome.err;
  return outcome.out;
}

bool has(const std::string& text, const char* part) {
  return text.find(part) != std::string::npos;
}

TEST(ServerProgram, LoadsNeitherSessionsNorSurfacesNorDicom) {
  const std::string libraries = told_of_server("readelf -d");
  EXPECT_TRUE(has(libraries, "libITK")) << "it reads patient folders";
  for (const char* library : {"libvtk", "libgdcm", "libsoci", "libsqlite", "libQt", "libpng"})
    EXPECT_FALSE(has(libraries, library)) << library;
}

TEST(ServerProgram, ContainsNoCodeOfItsClients) {
  const std::string symbols = told_of_server("nm -C");
  EXPECT_TRUE(has(symbols, "trocar::io::load_patient("));
  for (const char* code : {"trocar::storage::", "trocar::surface::", "trocar::attempt::", "trocar::io::save_patient(",
                           "trocar::io::write_image(", "trocar::io::detail::write_with_itk("})
    EXPECT_FALSE(has(symbols, code)) << code;
}

}  // namespace
}  // namespace trocar::cli_test
