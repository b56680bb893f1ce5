// The whole line by command: patient, plan, puncture, CSV, report, pictures.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <vector>

#include "cli/program.h"

namespace trocar::cli_test {
namespace {
namespace fs = std::filesystem;

std::string read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

class FirstPuncture : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    patient_ = *folder_ / "patient";
    session_ = *folder_ / "expert.session";
    const Outcome generated = trocar("patient generate abdomen --seed 3 --out '" + patient_ + "'");
    ASSERT_EQ(generated.exit_status, 0) << generated.err;
    const Outcome ran =
        trocar("run liver-biopsy --patient '" + patient_ + "' --operator expert --out '" + session_ + "' --json");
    ASSERT_EQ(ran.exit_status, 0) << ran.err;
    run_json_ = ran.out;
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static inline std::unique_ptr<TemporaryFolder> folder_;
  static inline std::string patient_;
  static inline std::string session_;
  static inline std::string run_json_;
};

TEST_F(FirstPuncture, ShowPrintsVolumesMeshesAndFrames) {
  const config::Json json = json_of(trocar("patient show '" + patient_ + "' --json"));
  double liver_ml = 0.0;
  for (const config::Json& label : json["labels"]) {
    if (label["name"] == "liver") liver_ml = label["volume_ml"];
  }
  EXPECT_GT(liver_ml, 500.0);
  EXPECT_LT(liver_ml, 3000.0);
  EXPECT_GT(json["meshes"].size(), 5u);
  EXPECT_EQ(json["volumes"]["ct"]["spacing_mm"].size(), 3u);
  EXPECT_FALSE(json["provenance"].empty());
}

TEST_F(FirstPuncture, CheckReportsThatABiopsyIsPossible) {
  const config::Json json = json_of(trocar("patient check '" + patient_ + "' --json"));
  bool is_possible = false;
  for (const config::Json& task : json["tasks"])
    is_possible |= task["task"] == "liver-biopsy" && task["possible"] == true;
  EXPECT_TRUE(is_possible) << json.dump(1);
}

TEST_F(FirstPuncture, PlanWritesAMarkupsFile) {
  const std::string file = *folder_ / "paths.mrk.json";
  const config::Json json =
      json_of(trocar("plan liver-biopsy --patient '" + patient_ + "' --count 3 --json --out '" + file + "'"));
  ASSERT_EQ(json["paths"].size(), 3u);
  double last_mm = 0.0;
  for (const config::Json& path : json["paths"]) {
    EXPECT_GE(path["organ_path_mm"], 10.0);
    EXPECT_GE(path["spare_margin_mm"], 0.0);
    EXPECT_GE(path["cost_mm"], last_mm);
    last_mm = path["cost_mm"];
  }
  EXPECT_TRUE(config::parse_json(read(file), file));
}

TEST_F(FirstPuncture, ExpertPuncturesEachLayerOnceInOrder) {
  const std::string csv = *folder_ / "expert.csv";
  ASSERT_EQ(trocar("session export '" + session_ + "' --csv '" + csv + "'").exit_status, 0);
  std::istringstream rows(read(csv));
  std::string header;
  std::getline(rows, header);
  EXPECT_TRUE(
      header.starts_with("time_s,tip_x_mm,tip_y_mm,tip_z_mm,axis_x,axis_y,axis_z,axial_velocity_mm_s,depth_mm"));
  std::string punctures;
  int count = 0;
  for (std::string row; std::getline(rows, row); ++count) {
    for (auto at = row.find("puncture:"); at != std::string::npos; at = row.find("puncture:", at + 1)) {
      punctures += row.substr(at + 9, row.find_first_of(",;\"", at + 9) - at - 9) + " ";
    }
  }
  EXPECT_EQ(punctures, "skin muscle liver_capsule ");
  EXPECT_GT(count, 1000);
}

TEST_F(FirstPuncture, ReportIsSelfContained) {
  const std::string html = *folder_ / "expert.html";
  const Outcome outcome = trocar("session report '" + session_ + "' --out '" + html + "'");
  ASSERT_EQ(outcome.exit_status, 0) << outcome.err;
  const std::string page = read(html);
  EXPECT_NE(page.find("<svg"), std::string::npos);
  EXPECT_NE(page.find("data:image/png;base64,"), std::string::npos);
  EXPECT_EQ(page.find("src=\"http"), std::string::npos);
}

TEST_F(FirstPuncture, ReportWithoutThePatientWarnsAndHasNoSlices) {
  const std::string html = *folder_ / "alone.html";
  const Outcome outcome =
      trocar("session report '" + session_ + "' --patient '" + (*folder_ / "gone") + "' --out '" + html + "'");
  EXPECT_EQ(outcome.exit_status, 0);
  EXPECT_NE(outcome.err.find("warning: "), std::string::npos) << outcome.err;
  EXPECT_EQ(read(html).find("data:image/png;base64,"), std::string::npos);
}

TEST_F(FirstPuncture, NoviceScoresLowerThanTheExpert) {
  const auto expert = config::parse_json(run_json_, "run");
  ASSERT_TRUE(expert) << run_json_;
  const config::Json novice =
      json_of(trocar("run liver-biopsy --patient '" + patient_ + "' --operator novice --json --out '" +
                     (*folder_ / "novice.session") + "'"));
  EXPECT_LT(novice["score"].get<double>(), (*expert)["score"].get<double>());
}

TEST_F(FirstPuncture, ReplayRepeatsTheRecording) {
  const std::string again = *folder_ / "again.session";
  const Outcome outcome = trocar("run liver-biopsy --patient '" + patient_ + "' --operator 'replay:" + session_ +
                                 "' --out '" + again + "'");
  ASSERT_EQ(outcome.exit_status, 0) << outcome.err;
  const std::string first_csv = *folder_ / "first.csv";
  const std::string again_csv = *folder_ / "again.csv";
  ASSERT_EQ(trocar("session export '" + session_ + "' --csv '" + first_csv + "'").exit_status, 0);
  ASSERT_EQ(trocar("session export '" + again + "' --csv '" + again_csv + "'").exit_status, 0);
  const std::string first = read(first_csv);
  ASSERT_GT(first.size(), 100000u);
  EXPECT_TRUE(read(again_csv) == first) << "another bit";
}

TEST_F(FirstPuncture, RenderWithoutAScreenWritesOnlySlices) {
  const fs::path pictures = *folder_ / "slices";
  const Outcome outcome =
      trocar("patient render '" + patient_ + "' --out '" + pictures.string() + "'", "env -u DISPLAY");
  EXPECT_EQ(outcome.exit_status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("xvfb-run"), std::string::npos) << outcome.err;
  EXPECT_TRUE(fs::exists(pictures / "slice_axial_labels.png"));
  EXPECT_FALSE(fs::exists(pictures / "view_anterior.png"));
}

TEST_F(FirstPuncture, RenderWithAScreenDrawsEveryView) {
  if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "no X server: run under scripts/with_display";
  const fs::path pictures = *folder_ / "pictures";
  const Outcome outcome = trocar("patient render '" + patient_ + "' --out '" + pictures.string() + "'");
  ASSERT_EQ(outcome.exit_status, 0) << outcome.err;
  EXPECT_EQ(std::distance(fs::directory_iterator(pictures), fs::directory_iterator()), 10);
}

TEST_F(FirstPuncture, SelectsALongerNeedleForAThickWall) {
  const auto needle_of = [](const std::string& options) {
    const TemporaryFolder folder;
    const std::string line = "run ascites-puncture --patient ascites-5 --operator expert --json --out '";
    return json_of(trocar(line + (folder / "a.session") + "'" + options))["needle"];
  };
  EXPECT_EQ(needle_of(""), "paracentesis-15g-long");
  EXPECT_EQ(needle_of(" --needle paracentesis-14g"), "paracentesis-14g");
}

}  // namespace
}  // namespace trocar::cli_test
