// What the program does with files that are not what they should be: one line, exit status 1 or 2, nothing written.
#include <gtest/gtest.h>

#include <fstream>

#include "cli/program.h"
#include "core/testing/test_data.h"

namespace trocar::cli_test {
namespace {
namespace fs = std::filesystem;

void expect_refused_in_one_line(const std::string& arguments) {
  const Outcome outcome = trocar(arguments);
  EXPECT_TRUE(outcome.exit_status == 1 || outcome.exit_status == 2) << arguments << "\n" << outcome.exit_status;
  const auto at = outcome.err.find("error: ");
  ASSERT_NE(at, std::string::npos) << arguments << "\n" << outcome.err;
  EXPECT_EQ(line_count(outcome.err.substr(at)), 1) << arguments << "\n" << outcome.err;
}

class BadFiles : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& bytes) { std::ofstream(inputs_ / name) << bytes; }

  TemporaryFolder inputs_;
  TemporaryFolder outputs_;
};

TEST_F(BadFiles, RefusesTextAsAnImage) {
  write("ct.nii", "hello");
  expect_refused_in_one_line("patient build --ct '" + (inputs_ / "ct.nii") + "' --labels '" + (inputs_ / "ct.nii") +
                             "' --out '" + (outputs_ / "patient") + "'");
  EXPECT_TRUE(outputs_.is_empty());
}

TEST_F(BadFiles, RefusesTextAsSequenceOrCalibration) {
  write("sweep.igs.mha", "hello");
  write("calibration.xml", "hello");
  const std::string begin =
      "ultrasound reconstruct '" + (inputs_ / "sweep.igs.mha") + "' --out '" + (outputs_ / "v.nrrd");
  expect_refused_in_one_line(begin + "'");
  expect_refused_in_one_line(begin + "' --calibration '" + (inputs_ / "calibration.xml") + "'");
  expect_refused_in_one_line("ultrasound reconstruct /nowhere/sweep.igs.mha --out '" + (outputs_ / "v.nrrd") + "'");
  EXPECT_TRUE(outputs_.is_empty());
}

TEST_F(BadFiles, MissingImageIsNamed) {
  const Outcome outcome =
      trocar("patient build --ct /nowhere/ct.nii --labels /nowhere/l.nii --out '" + (outputs_ / "patient") + "'");
  EXPECT_EQ(outcome.exit_status, 1) << outcome.err;
  EXPECT_NE(outcome.err.find("/nowhere/ct.nii"), std::string::npos) << outcome.err;
  EXPECT_TRUE(outputs_.is_empty());
}

TEST_F(BadFiles, RefusesAnEmptyFolderAsPatient) {
  for (const std::string command : {"show", "check"})
    expect_refused_in_one_line("patient " + command + " '" + inputs_.path().string() + "'");
  expect_refused_in_one_line("patient render '" + inputs_.path().string() + "' --out '" + (outputs_ / "pictures") +
                             "'");
  expect_refused_in_one_line("run liver-biopsy --patient '" + inputs_.path().string() + "' --operator expert --out '" +
                             (outputs_ / "session") + "'");
  EXPECT_TRUE(outputs_.is_empty());
}

TEST_F(BadFiles, RefusesTextAsASession) {
  write("session", "hello");
  expect_refused_in_one_line("session export '" + (inputs_ / "session") + "' --csv '" + (outputs_ / "x.csv") + "'");
  expect_refused_in_one_line("session report '" + (inputs_ / "session") + "' --out '" + (outputs_ / "x.html") + "'");
  expect_refused_in_one_line("run liver-biopsy --patient abdomen --operator 'replay:" + (inputs_ / "session") +
                             "' --out '" + (outputs_ / "again") + "'");
  EXPECT_TRUE(outputs_.is_empty());
}

TEST_F(BadFiles, NeverCrashOnForeignImages) {
  const fs::path folder = trocar::testing::test_data() / "bad-input";
  if (!fs::exists(folder)) GTEST_SKIP() << "no test data at " << folder;
  int tried = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    ++tried;
    expect_refused_in_one_line("patient build --ct '" + entry.path().string() + "' --labels '" + entry.path().string() +
                               "' --out '" + (outputs_ / "patient") + "'");
    ASSERT_TRUE(outputs_.is_empty()) << entry.path();
  }
  EXPECT_GT(tried, 5);
}

}  // namespace
}  // namespace trocar::cli_test
