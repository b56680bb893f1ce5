// trocar ultrasound stitch and keypoints: generated volumes with known poses, and what cannot be stitched.
#include <gtest/gtest.h>

#include <filesystem>

#include "cli/program.h"
#include "core/files/output_file.h"
#include "io/image/image_file.h"
#include "io/sequence/transform_file.h"
#include "lab/registration/volume_series.h"

namespace trocar::cli_test {
namespace {
namespace fs = std::filesystem;

/// Two overlapping volumes and one of another scene, as files.
struct Files {
  TemporaryFolder folder;
  std::vector<registration::GeneratedVolume> series;
  Files() {
    registration::SeriesOptions options;
    options.volumes = 2;
    series = registration::make_volume_series(options, 50);
    series.push_back(registration::make_volume_series(options, 51).front());
    const char* names[] = {"first.nrrd", "second.nrrd", "foreign.nrrd"};
    for (std::size_t n = 0; n < series.size(); ++n) EXPECT_TRUE(io::write_image(series[n].gray, folder / names[n]));
  }
  Outcome run(const std::string& line) const {
    return trocar("ultrasound " + line, "cd '" + folder.path().string() + "' &&");
  }
};

TEST(Stitch, WritesPanoramaTransformsAndReport) {
  const Files files;
  const Outcome outcome = files.run(
      "stitch first.nrrd second.nrrd --beam-axis +z --out pan.nrrd --transforms poses --report report.html --json");
  ASSERT_EQ(outcome.exit_status, 0) << outcome.err;
  const auto X = io::read_transform(files.folder / "poses/second.tfm");
  ASSERT_TRUE(X);
  const auto error = registration::target_error(files.series[0].gray.geometry, files.series[1].gray.geometry,
                                                files.series[0].X_WU.inverse() * files.series[1].X_WU, *X);
  EXPECT_LT(error.mean_mm, 0.5);
  const auto first = io::read_transform(files.folder / "poses/first.tfm");
  ASSERT_TRUE(first);
  EXPECT_LT(first->p().norm(), 1e-9);
  const auto panorama = io::read_labels(files.folder / "pan.nrrd");
  ASSERT_TRUE(panorama);
  EXPECT_GT(panorama->geometry.size[0], 120);
  const config::Json json = json_of(outcome);
  EXPECT_EQ(json["pairs"].size(), 1U);
  EXPECT_TRUE(json["pairs"][0]["used"]);
  const auto report = read_file(files.folder / "report.html");
  ASSERT_TRUE(report);
  EXPECT_NE(report->find("matches agree"), std::string::npos);
}

TEST(Stitch, LeavesNothingWhereThePanoramaCannotBeWritten) {
  const Files files;
  const Outcome outcome =
      trocar("ultrasound stitch first.nrrd second.nrrd --beam-axis +z --out pan.nrrd --transforms poses",
             "cd '" + files.folder.path().string() + "' && trap '' XFSZ && ulimit -f 64 &&");
  EXPECT_EQ(outcome.exit_status, 1);
  EXPECT_NE(outcome.err.find("pan.nrrd"), std::string::npos) << outcome.err;
  EXPECT_FALSE(fs::exists(files.folder / "pan.nrrd"));
  EXPECT_FALSE(fs::exists(files.folder / "poses"));
}

TEST(Stitch, NamesAnUnconnectedVolume) {
  const Files files;
  const Outcome outcome =
      files.run("stitch first.nrrd second.nrrd foreign.nrrd --beam-axis +z --out pan.nrrd --transforms poses");
  EXPECT_EQ(outcome.exit_status, 1);
  EXPECT_NE(outcome.err.find("foreign"), std::string::npos) << outcome.err;
  EXPECT_TRUE(fs::exists(files.folder / "poses/second.tfm"));
  EXPECT_FALSE(fs::exists(files.folder / "poses/foreign.tfm"));
  const Outcome alone = files.run("stitch first.nrrd foreign.nrrd --beam-axis +z --out no.nrrd --transforms none");
  EXPECT_EQ(alone.exit_status, 1);
  EXPECT_NE(alone.err.find("foreign"), std::string::npos) << alone.err;
  EXPECT_FALSE(fs::exists(files.folder / "no.nrrd"));
  EXPECT_FALSE(fs::exists(files.folder / "none"));
}

TEST(Stitch, RefusesUnusableVolumes) {
  const Files files;
  volume::GridGeometry small;
  small.size = {24, 24, 24};
  ASSERT_TRUE(io::write_image(volume::LabelGrid(small, 80), files.folder / "plain.nrrd"));
  ASSERT_TRUE(io::write_image(volume::LabelGrid(small, 0), files.folder / "black.nrrd"));
  volume::LabelGrid coarse = files.series[0].gray;
  coarse.geometry.spacing_mm *= 1.5;
  ASSERT_TRUE(io::write_image(coarse, files.folder / "coarse.nrrd"));
  ASSERT_TRUE(write_file_atomically(files.folder / "damaged.nrrd", "NRRD0004\ntype: unsigned char\n"));
  struct Case {
    const char* line;
    int exit_status;
    const char* named;
  };
  const std::string rest = " --beam-axis +z --out pan.nrrd --transforms poses";
  for (const Case& c : {Case{"first.nrrd", 1, "single"}, Case{"first.nrrd plain.nrrd", 1, "plain"},
                        Case{"first.nrrd black.nrrd", 1, "black"}, Case{"first.nrrd coarse.nrrd", 1, "voxel sizes"},
                        Case{"first.nrrd damaged.nrrd", 1, "damaged"}, Case{"first.nrrd none.nrrd", 1, "none.nrrd"},
                        Case{"first.nrrd first.nrrd", 2, "same file name"},
                        Case{"first.nrrd second.nrrd --shadow-threshold nan", 2, "--shadow-threshold"},
                        Case{"first.nrrd second.nrrd --spacing 0", 2, "--spacing"}}) {
    const Outcome outcome = files.run(std::string("stitch ") + c.line + rest);
    EXPECT_EQ(outcome.exit_status, c.exit_status) << c.line << outcome.err;
    EXPECT_NE(outcome.err.find(c.named), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(files.folder / "pan.nrrd"));
    EXPECT_FALSE(fs::exists(files.folder / "poses"));
  }
  const Outcome axis = files.run("stitch first.nrrd second.nrrd --beam-axis up --out pan.nrrd --transforms poses");
  EXPECT_EQ(axis.exit_status, 2);
  EXPECT_NE(axis.err.find("+x"), std::string::npos);
}

TEST(Keypoints, AreListedInMm) {
  const Files files;
  const Outcome outcome = files.run("keypoints first.nrrd --beam-axis +z --out k.json --json");
  ASSERT_EQ(outcome.exit_status, 0) << outcome.err;
  const auto text = read_file(files.folder / "k.json");
  ASSERT_TRUE(text);
  const config::Json json = config::Json::parse(*text);
  ASSERT_GT(json["keypoints"].size(), 30U);
  EXPECT_EQ(json["keypoints"].size(), json_of(outcome)["keypoints"]);
  for (const auto& k : json["keypoints"]) {
    EXPECT_GT(k["sigma_mm"], 1.0);
    EXPECT_LT(k["ratio"], 15.0);
    for (const auto& x : k["p_mm"]) EXPECT_TRUE(x >= 0.0 && x <= 95.0);
  }
  EXPECT_EQ(files.run("keypoints first.nrrd --edge-ratio 0 --out e.json").exit_status, 2);
  EXPECT_EQ(files.run("keypoints first.nrrd --contrast -1 --out e.json").exit_status, 2);
}

}  // namespace
}  // namespace trocar::cli_test
