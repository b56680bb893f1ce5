// What patient build prints about the patient that it has made.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "cli/program.h"
#include "core/files/folders.h"
#include "io/image/image_file.h"
#include "phantom/phantom.h"

namespace trocar::cli_test {
namespace {

/// CT and labels of a coarse embedded patient, as files.
class BuildSummary : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto patient = phantom::generate_phantom("abdomen", 1, {{90, 72, 64}});
    ASSERT_TRUE(patient) << patient.error().text();
    ASSERT_TRUE(io::write_image(patient->ct, folder_ / "ct.nrrd"));
    volume::LabelGrid liver(patient->labels.geometry, 0);
    for (std::size_t n = 0; n < liver.voxels.size(); ++n) {
      const anatomy::Label* label = patient->label_table.find(patient->labels.voxels[n]);
      if (label != nullptr && label->tissue == "liver") liver.voxels[n] = 1;
    }
    ASSERT_TRUE(io::write_image(liver, folder_ / "liver.nrrd"));
  }
  Outcome build(const std::string& more) {
    return trocar("patient build --ct '" + (folder_ / "ct.nrrd") + "' --labels '" + (folder_ / "liver.nrrd") +
                  "' --out '" + (folder_ / "made") + "' " + more);
  }
  TemporaryFolder folder_;
};

TEST_F(BuildSummary, HasSizeVolumesSurfacesAndTasksAsJson) {
  const config::Json json = json_of(build("--json"));
  EXPECT_EQ(json["volume"]["size_voxels"], config::Json({90, 72, 64}));
  EXPECT_EQ(json["folder"], folder_ / "made");
  EXPECT_GT(json["body_ml"].get<double>(), 5000.0);
  EXPECT_LT(json["body_ml"].get<double>(), 60000.0);
  double liver_ml = 0.0;
  for (const config::Json& label : json["labels"])
    if (label["name"] == "liver") liver_ml = label["volume_ml"];
  EXPECT_GT(liver_ml, 500.0);
  EXPECT_LT(liver_ml, 3000.0);
  EXPECT_FALSE(json["meshes"].empty());
  bool has_biopsy = false;
  for (const config::Json& task : json["tasks"]) has_biopsy |= task["task"] == "liver-biopsy";
  EXPECT_TRUE(has_biopsy);
  EXPECT_TRUE(json["doubtful"].is_array());
}

TEST_F(BuildSummary, IsPrintedAsText) {
  const Outcome outcome = build("");
  ASSERT_EQ(outcome.exit_status, 0) << outcome.err;
  for (const char* text : {"90 x 72 x 64 voxels", "liver", " ml", "body", "surfaces", "tasks", "doubtful"})
    EXPECT_NE(outcome.out.find(text), std::string::npos) << text << "\n" << outcome.out;
}

TEST_F(BuildSummary, MarksDerivedStructures) {
  const config::Json json = json_of(build("--json"));
  std::map<std::string, bool> derived;
  for (const config::Json& label : json["labels"]) derived[label["name"]] = label["derived"];
  EXPECT_FALSE(derived.at("liver"));
  EXPECT_TRUE(derived.at("fat"));
  EXPECT_TRUE(derived.at("peritoneum"));
  const Outcome shown = trocar("patient show '" + (folder_ / "made") + "'");
  EXPECT_NE(shown.out.find("HU  derived"), std::string::npos) << shown.out;
  const config::Json check = json_of(trocar("patient check '" + (folder_ / "made") + "' --json"));
  EXPECT_NE(std::find(check["derived"].begin(), check["derived"].end(), "peritoneum"), check["derived"].end());
}

TEST_F(BuildSummary, DerivesOnlyRequestedStructures) {
  const config::Json json = json_of(build("--derive none --json"));
  for (const config::Json& label : json["labels"]) EXPECT_NE(label["name"], "peritoneum");
  const Outcome bad = trocar("patient build --ct a --labels b --out '" + (folder_ / "bad") + "' --derive liver");
  EXPECT_EQ(bad.exit_status, 2);
  EXPECT_EQ(line_count(bad.err), 1) << bad.err;
}

TEST_F(BuildSummary, DrawsQuestionableLocations) {
  ASSERT_EQ(build("").exit_status, 0);
  const Outcome outcome = trocar("patient check '" + (folder_ / "made") + "' --pictures '" + (folder_ / "pictures") +
                                 "' --report '" + (folder_ / "check.html") + "'");
  ASSERT_EQ(outcome.exit_status, 0) << outcome.err;
  EXPECT_TRUE(std::filesystem::is_directory(folder_ / "pictures"));
  const std::string page = read_text(folder_ / "check.html");
  EXPECT_NE(page.find("liver-biopsy"), std::string::npos);
  EXPECT_NE(page.find("Derived structures"), std::string::npos);
  EXPECT_EQ(page.find("://"), std::string::npos) << "self-contained: no address; no letters of a picture's data either";
  const Outcome again =
      trocar("patient check '" + (folder_ / "made") + "' --report '" + (folder_ / "check.html") + "'");
  EXPECT_EQ(again.exit_status, 2) << again.err;
}

TEST_F(BuildSummary, PutsATissueTableIntoTheFolder) {
  const std::string table = "'" + trocar::data_dir().string() + "/tissues.toml'";
  ASSERT_EQ(build("--tissues " + table).exit_status, 0);
  EXPECT_EQ(read_text((folder_ / "made") + "/tissues.toml"), read_text((trocar::data_dir() / "tissues.toml").string()));
  const config::Json shown = json_of(trocar("patient show '" + (folder_ / "made") + "' --json"));
  EXPECT_EQ(shown["tissues"]["origin"], "the patient's own table");
  const Outcome missing =
      trocar("patient build --ct a --labels b --out '" + (folder_ / "bad") + "' --tissues nowhere.toml");
  EXPECT_EQ(missing.exit_status, 1);
  EXPECT_EQ(line_count(missing.err), 1) << missing.err;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "bad"));
}

TEST_F(BuildSummary, RecordsThePosture) {
  ASSERT_EQ(build("--posture left-lateral").exit_status, 0);
  EXPECT_NE(read_text((folder_ / "made") + "/patient.toml").find("left-lateral"), std::string::npos);
  const Outcome bad = trocar("patient build --ct a --labels b --out '" + (folder_ / "bad") + "' --posture standing");
  EXPECT_EQ(bad.exit_status, 2);
  EXPECT_EQ(line_count(bad.err), 1) << bad.err;
}

TEST_F(BuildSummary, SeriesOfAFileIsRefused) {
  const Outcome outcome = build("--series 2");
  EXPECT_EQ(outcome.exit_status, 2) << outcome.err;
  EXPECT_EQ(outcome.out, "");
}

}  // namespace
}  // namespace trocar::cli_test
