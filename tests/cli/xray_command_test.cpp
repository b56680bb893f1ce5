// trocar xray: images of ptcd-1 with needle and contrast agent, and arguments that it refuses.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <regex>
#include <vector>

#include "cli/program.h"
#include "geometry/pose.h"
#include "io/image/image_file.h"
#include "io/sequence/transform_file.h"

namespace trocar::cli_test {
namespace {
namespace fs = std::filesystem;

/// A place in a bile duct of ptcd-1, and one in the liver.
const Vec3 kDuct_P{-36.75, -62.89, 16.08};
const std::string kDuct = "-36.75,-62.89,16.08";
const std::string kLiver = "-19.77,-59.89,30.09";

/// ptcd-1, generated once: coarse voxels are enough.
class XrayCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new TemporaryFolder;
    const Outcome outcome =
        trocar("patient generate ptcd-1 --voxel-mm 3 --out '" + (*shared_ / "ptcd1") + "' >/dev/null");
    ASSERT_EQ(outcome.exit_status, 0) << outcome.err;
  }
  static void TearDownTestSuite() {
    delete shared_;
    shared_ = nullptr;
  }

  static std::string patient() { return *shared_ / "ptcd1"; }

  /// `trocar xray` of 96 × 96 pixels into the test's folder.
  Outcome xray(const std::string& arguments, const std::string& out) {
    return trocar("xray --patient '" + patient() + "' --pixels 96 " + arguments + " --out '" + (folder_ / out) + "'");
  }

  volume::FloatGrid attenuation(const std::string& arguments, const std::string& out) {
    const Outcome outcome = xray(arguments, out);
    EXPECT_EQ(outcome.exit_status, 0) << outcome.err;
    auto grid = io::read_float(folder_ / out);
    if (grid) return *std::move(grid);
    ADD_FAILURE() << grid.error().text();
    return {};
  }

  std::string needle_file(const Pose& X_PN) {
    const std::string path = folder_ / "needle.tfm";
    EXPECT_TRUE(io::write_transform(X_PN, path));
    return path;
  }

  /// One line that says what is wrong, nothing written.
  void expect_refused(const std::string& arguments, int exit_status, const std::string& out = "x.png") {
    const TemporaryFolder outputs;
    const Outcome outcome = trocar("xray " + arguments + " --out '" + (outputs / out) + "'");
    EXPECT_EQ(outcome.exit_status, exit_status) << arguments << "\n" << outcome.err;
    const auto at = outcome.err.find("error: ");
    ASSERT_NE(at, std::string::npos) << arguments << "\n" << outcome.err;
    EXPECT_EQ(line_count(outcome.err.substr(at)), 1) << arguments << "\n" << outcome.err;
    EXPECT_TRUE(outputs.is_empty()) << arguments;
  }
  void expect_usage_error(const std::string& arguments, const std::string& out = "x.png") {
    expect_refused("--patient '" + patient() + "' --pixels 32 " + arguments, 2, out);
  }

  TemporaryFolder folder_;

 private:
  static TemporaryFolder* shared_;
};
TemporaryFolder* XrayCommand::shared_ = nullptr;

/// Attenuation at a pixel of the first slice.
float at(const volume::FloatGrid& grid, int column, int row) {
  return grid.voxels[static_cast<std::size_t>(row * grid.geometry.size[0] + column)];
}

std::vector<float> difference(const volume::FloatGrid& a, const volume::FloatGrid& b) {
  std::vector<float> values(std::min(a.voxels.size(), b.voxels.size()));
  for (std::size_t n = 0; n < values.size(); ++n) values[n] = a.voxels[n] - b.voxels[n];
  return values;
}

bool has_dicom3tools() {
  return run_shell("command -v dciodvfy && command -v dcdump").exit_status == 0;
}

TEST_F(XrayCommand, HelpNamesOptionsAndExamples) {
  const Outcome outcome = trocar("xray --help");
  EXPECT_EQ(outcome.exit_status, 0);
  for (const char* word : {"--carm", "--contrast", "--subtract", "Examples:"})
    EXPECT_NE(outcome.out.find(word), std::string::npos) << word;
}

TEST_F(XrayCommand, SameSeedGivesSameBytes) {
  for (const std::string name : {"a.png", "b.png"}) EXPECT_EQ(xray("--seed 3", name).exit_status, 0);
  EXPECT_EQ(xray("--seed 4", "c.png").exit_status, 0);
  const std::string bytes = read_text(folder_ / "a.png");
  ASSERT_GT(bytes.size(), 24U);
  EXPECT_EQ(bytes.substr(1, 3), "PNG");
  EXPECT_EQ(static_cast<int>(bytes[19]), 96);  // columns, in the header
  EXPECT_EQ(static_cast<int>(bytes[23]), 96);  // rows
  EXPECT_EQ(bytes, read_text(folder_ / "b.png"));
  EXPECT_NE(bytes, read_text(folder_ / "c.png"));
}

/// The first place of that name in the JSON that a command prints.
Vec3 place_in(const Outcome& outcome, const std::string& name) {
  const std::regex numbers("\"" + name + R"re(": \[\s*([-0-9.e]+),\s*([-0-9.e]+),\s*([-0-9.e]+))re");
  std::smatch found;
  if (!std::regex_search(outcome.out, found, numbers)) return Vec3::Constant(std::nan(""));
  return {std::stod(found[1]), std::stod(found[2]), std::stod(found[3])};
}

TEST_F(XrayCommand, CentresOnTheTargetOfThePatientsTask) {
  const Outcome outcome = xray("--json", "x.png");
  ASSERT_EQ(outcome.exit_status, 0) << outcome.err;
  const Vec3 target_P = place_in(trocar("patient show '" + patient() + "' --json"), "target_mm");
  EXPECT_NEAR((place_in(outcome, "isocentre_mm") - target_P).norm(), 0.0, 1e-6);
}

TEST_F(XrayCommand, CentresOnTheBodyWithoutATask) {
  // A body of 60 x 40 x 100 mm in air, off the middle of the scan and cut off by its end.
  volume::GridGeometry geometry;
  geometry.size = {50, 40, 60};
  geometry.spacing_mm = Vec3::Constant(2.0);
  geometry.origin_P = Vec3(-10.0, 20.0, -30.0);
  volume::CtGrid ct(geometry, -1000);
  for (std::int64_t k = 10; k < 60; ++k)
    for (std::int64_t j = 5; j < 25; ++j)
      for (std::int64_t i = 15; i < 45; ++i) ct.voxels[geometry.offset({i, j, k})] = 40;
  ASSERT_TRUE(io::write_image(ct, folder_ / "ct.nrrd"));
  volume::LabelGrid labels(geometry, 0);
  for (std::int64_t k = 20; k < 30; ++k) labels.voxels[geometry.offset({30, 15, k})] = 5;
  ASSERT_TRUE(io::write_image(labels, folder_ / "labels.nrrd"));
  const std::string build = "patient build --ct '" + (folder_ / "ct.nrrd") + "' --labels '" +
                            (folder_ / "labels.nrrd") + "' --out '" + (folder_ / "body") + "' >/dev/null";
  const Outcome built = trocar(build);
  ASSERT_EQ(built.exit_status, 0) << built.err;
  const Outcome outcome =
      trocar("xray --patient '" + (folder_ / "body") + "' --pixels 32 --json --out '" + (folder_ / "x.png") + "'");
  ASSERT_EQ(outcome.exit_status, 0) << outcome.err;
  const Vec3 centre_P = geometry.to_mm(Vec3(29.5, 14.5, 34.5));
  EXPECT_NEAR((place_in(outcome, "isocentre_mm") - centre_P).norm(), 0.0, 1.0);
}

TEST_F(XrayCommand, NrrdLiesAtTheDetector) {
  const volume::FloatGrid image = attenuation("--at 0,0,0 --field 220", "x.nrrd");
  EXPECT_EQ(image.geometry.size, (volume::Index3{96, 96, 2}));
  EXPECT_NEAR(image.geometry.spacing_mm.x(), 220.0 / 96, 1e-6);
  // The angiography unit has 1100 mm from source to detector and 765 mm to the isocentre; the detector is in front.
  const Vec3 middle_P = image.geometry.centre_mm({48, 48, 0});
  EXPECT_NEAR(middle_P.y(), -(1100.0 - 765.0), 1e-3);
  EXPECT_LT((image.geometry.R_PV.col(0) - Vec3::UnitX()).norm(), 1e-6);  // the patient's left is on the right
  EXPECT_LT((image.geometry.R_PV.col(1) + Vec3::UnitZ()).norm(), 1e-6);  // the head is up
  // More than 10 cm and less than 35 cm of tissue in the beam's middle.
  EXPECT_GT(at(image, 48, 48), 1.5F);
  EXPECT_LT(at(image, 48, 48), 8.0F);
}

TEST_F(XrayCommand, RaoAndCranialAnglesMoveTheDetector) {
  const auto middle_P = [&](const std::string& angles, const std::string& out) -> Vec3 {
    return attenuation("--at 0,0,0 --carm " + angles, out).geometry.centre_mm({48, 48, 0});
  };
  const Vec3 rao_P = middle_P("-30,0", "rao.nrrd"), cranial_P = middle_P("0,20", "cranial.nrrd");
  // 335 mm from the isocentre; a pixel is 3.1 mm. P is LPS: the right is -x, the front -y, the head +z.
  EXPECT_LT((rao_P - Vec3(-335.0 * 0.5, -335.0 * std::sqrt(0.75), 0.0)).norm(), 3.2);
  EXPECT_NEAR(cranial_P.z(), 335.0 * std::sin(std::numbers::pi / 9.0), 3.2);
  EXPECT_LT(cranial_P.y(), -300.0);
}

TEST_F(XrayCommand, JsonNamesGeometryExposureAndContrast) {
  const config::Json plain = json_of(xray("--carm -30,20 --at 1,2,3 --json", "a.png"));
  EXPECT_EQ(plain["lao_deg"], -30.0);
  EXPECT_EQ(plain["cranial_deg"], 20.0);
  EXPECT_EQ(plain["isocentre_mm"], config::Json({1.0, 2.0, 3.0}));
  EXPECT_NEAR(plain["magnification"].get<double>(), 1100.0 / 765.0, 1e-9);
  EXPECT_GT(plain["air_kerma_mgy"], 0.0);
  EXPECT_EQ(plain["contrast"], nullptr);
  const config::Json low = json_of(xray("--carm -30,20 --at 1,2,3 --dose low --json", "b.png"));
  EXPECT_NEAR(low["air_kerma_mgy"].get<double>(), 0.5 * plain["air_kerma_mgy"].get<double>(), 1e-9);
  const config::Json contrast = json_of(xray("--contrast 3@" + kDuct + " --rate 2 --json", "c.png"))["contrast"];
  EXPECT_EQ(contrast["place"], "bile duct");
  EXPECT_NEAR(contrast["time_s"].get<double>(), 1.5, 1e-9);  // when the injection ends
  EXPECT_NEAR(contrast["injected_ml"].get<double>(), 3.0, 1e-6);
  const double mg = contrast["in_body_mg"].get<double>() + contrast["drained_mg"].get<double>() +
                    contrast["washed_away_mg"].get<double>();
  EXPECT_NEAR(mg, 3.0 * 300.0, 1e-3);  // data/contrast.toml: 300 mg iodine per ml
  EXPECT_GT(contrast["ducts_mg"].get<double>(), 100.0);
}

/// A needle from the patient's right, whose tip is in the middle of the image.
TEST_F(XrayCommand, NeedleIsDarkUpToItsTip) {
  Mat3 R_PN;
  R_PN << 0, 0, 1, 1, 0, 0, 0, 1, 0;  // +z of the needle towards the patient's left
  const std::string line = "--field 110 --at " + kDuct + " ";
  const volume::FloatGrid without = attenuation(line, "without.nrrd");
  const volume::FloatGrid with = attenuation(line + "--needle " + needle_file(Pose(R_PN, kDuct_P)), "with.nrrd");
  const std::vector<float> added = difference(with, without);
  const auto added_at = [&](int column, int row) { return added[static_cast<std::size_t>(row * 96 + column)]; };
  // 0.8 mm per pixel at the isocentre: 0.38 mm² of steel are 0.05 cm on the mean of a row, shared by the middle two.
  for (int column = 5; column < 45; column += 5) {
    EXPECT_GT(added_at(column, 47) + added_at(column, 48), 0.2F) << column;
    EXPECT_LT(std::abs(added_at(column, 30)), 0.02F) << column;
  }
  for (int column = 52; column < 92; column += 5)
    EXPECT_LT(std::abs(added_at(column, 47)) + std::abs(added_at(column, 48)), 0.02F) << column;
}

TEST_F(XrayCommand, ContrastAgentShowsADuctFartherThanParenchyma) {
  // Pixels that gain more than 0.1, near the injection and away from it.
  const auto count = [&](const std::string& place) {
    const std::string line = "--seed 2 --at " + place + " ";
    const volume::FloatGrid without = attenuation(line, "without" + place + ".nrrd");
    const volume::FloatGrid with = attenuation(line + "--contrast 5@" + place, "with" + place + ".nrrd");
    std::array<int, 2> counted{};
    for (int row = 0; row < 96; ++row)
      for (int column = 0; column < 96; ++column) {
        const bool is_far = std::hypot(column - 47.5, row - 47.5) > 16.0;  // 35 mm
        counted[is_far ? 1 : 0] += at(with, column, row) - at(without, column, row) > 0.1F ? 1 : 0;
      }
    return counted;
  };
  const auto duct = count(kDuct), liver = count(kLiver);
  EXPECT_GT(duct[0], 10);
  EXPECT_GT(duct[1], 10);
  EXPECT_GT(liver[0], 10);
  EXPECT_EQ(liver[1], 0);
}

TEST_F(XrayCommand, SubtractionShowsTheContrastAgentOnly) {
  const std::string line = "--contrast 5@" + kDuct;
  EXPECT_EQ(xray(line, "live.png").exit_status, 0);
  EXPECT_EQ(xray(line + " --subtract", "subtracted.png").exit_status, 0);
  EXPECT_NE(read_text(folder_ / "live.png"), read_text(folder_ / "subtracted.png"));
}

TEST_F(XrayCommand, DicomRunPassesDciodvfyWithFrameTimes) {
  const Outcome outcome = xray("--contrast 3@" + kDuct + " --frames 4", "run.dcm");
  ASSERT_EQ(outcome.exit_status, 0) << outcome.err;
  if (!has_dicom3tools()) GTEST_SKIP() << "dicom3tools is not installed";
  const std::string file = "'" + (folder_ / "run.dcm") + "'";
  const Outcome checked = run_shell("dciodvfy " + file);
  EXPECT_NE(checked.err.find("XAImage"), std::string::npos) << checked.err;
  EXPECT_EQ(checked.err.find("Error"), std::string::npos) << checked.err;
  const Outcome dump = run_shell("dcdump " + file);
  EXPECT_TRUE(std::regex_search(dump.err, std::regex("Number of Frames.*<4 *>"))) << dump.err;
  EXPECT_TRUE(std::regex_search(dump.err, std::regex("Frame Time.*<1000[ .0]*>"))) << dump.err;  // 3 ml at 1 ml/s
}

TEST_F(XrayCommand, ImpossibleGeometryIsRefused) {
  expect_usage_error("--at 0,-765,0");   // the source is in the liver
  expect_usage_error("--at 0,335,0");    // the detector is in it
  expect_usage_error("--at 0,1500,0");   // the detector is between the source and the patient
  expect_usage_error("--at 0,-1500,0");  // the patient is behind the source
  expect_usage_error("--at 800,0,0");    // beside the beam
  expect_usage_error("--at 0,0,9999");   // outside of the room
  expect_usage_error("--at nan,0,0");
  expect_usage_error("--at 0,0");
  expect_usage_error("--field 400");   // larger than the detector
  expect_usage_error("--carm 121,0");  // beyond the arm's reach
  expect_usage_error("--carm 0,-46");
  expect_usage_error("--carm inf,0");
  expect_usage_error("--carm 30");
  expect_usage_error("--unit ct");  // unknown
  expect_usage_error("--collimate 0,1");
  expect_usage_error("--unit mobile --carm 95,0");
}

TEST_F(XrayCommand, BadInjectionIsRefused) {
  for (const std::string text : {"abc", "5", "5@", "5@1,2", "5@1,2,3x", "5@1,2,nan", "-5@1,2,3", "0@1,2,3", "nan@1,2,3",
                                 "0x5@1,2,3", "201@1,2,3", "5@500,500,500"})
    expect_usage_error("--contrast=" + text);
  expect_usage_error("--time -1 --contrast 3@" + kDuct);
  expect_usage_error("--rate 0 --contrast 3@" + kDuct);
  for (const std::string option : {"--time 3", "--rate 2", "--subtract"}) expect_usage_error(option);
}

TEST_F(XrayCommand, CatheterAndMarkersAreDrawn) {
  const std::string file = folder_ / "tools.mrk.json";
  std::ofstream(file) << R"({"markups": [
    {"type": "Curve", "name": "catheter", "controlPoints": [{"position": [-140, -63, 16]}, {"position": [-60, -63, 16]},
      {"position": [-37, -63, 0]}]},
    {"type": "Fiducial", "name": "marker", "controlPoints": [{"position": [-37, -63, 40]}]}]})";
  const std::string at = "--at " + kDuct + " --field 160 ";
  const volume::FloatGrid without = attenuation(at, "without.nrrd");
  const volume::FloatGrid with = attenuation(at + "--tools '" + file + "'", "with.nrrd");
  // Pixels of 1.67 mm, foot side down: the catheter from the left edge to the middle and down, the marker above it.
  float catheter = 0.0F, marker = 0.0F, elsewhere = 0.0F;
  for (std::size_t n = 0; n < 96UL * 96UL; ++n) {
    const std::size_t row = n / 96, column = n % 96;
    const float added = with.voxels[n] - without.voxels[n];
    if (row > 44 && row < 52 && column < 40) catheter = std::max(catheter, added);
    if (row > 25 && row < 40 && column > 42 && column < 54) marker = std::max(marker, added);
    if (column > 60) elsewhere = std::max(elsewhere, std::abs(added));
  }
  EXPECT_GT(catheter, 0.07F);  // 0.015 g/cm² of iodine, 7 cm²/g
  EXPECT_GT(marker, 0.05F);
  EXPECT_LT(elsewhere, 0.05F);
}

TEST_F(XrayCommand, BadToolsAreRefused) {
  const std::string begin = "--patient '" + patient() + "' --tools '";
  expect_refused(begin + (folder_ / "missing.mrk.json") + "'", 1);
  std::ofstream(folder_ / "stent.mrk.json")
      << R"({"markups": [{"type": "Line", "name": "stent", "controlPoints": [{"position": [0, 0, 0]},
          {"position": [0, 0, 9]}]}]})";
  expect_refused(begin + (folder_ / "stent.mrk.json") + "'", 2);
  std::ofstream(folder_ / "short.mrk.json") << R"({"markups": [{"type": "Curve", "name": "catheter"}]})";
  expect_refused(begin + (folder_ / "short.mrk.json") + "'", 1);
}

TEST_F(XrayCommand, BadNeedleIsRefused) {
  const std::string begin = "--patient '" + patient() + "' --needle '";
  expect_refused(begin + (folder_ / "missing.tfm") + "'", 1);
  std::ofstream(folder_ / "short.tfm") << "#Insight Transform File V1.0\n";
  expect_refused(begin + (folder_ / "short.tfm") + "'", 1);
  expect_usage_error("--needle-diameter 0.8");
  // Without --at the arm follows the needle, away from the patient.
  expect_usage_error("--needle '" + needle_file(Pose(Mat3::Identity(), Vec3(900, 900, 900))) + "'");
}

TEST_F(XrayCommand, NeedleOutsideOfImageOrPatientIsReported) {
  for (const Vec3& tip_P : {Vec3(900, 900, 900), Vec3(0, 0, -100)}) {
    const Outcome outcome =
        xray("--at 0,0,100 --field 110 --needle '" + needle_file(Pose(Mat3::Identity(), tip_P)) + "'", "x.png");
    EXPECT_EQ(outcome.exit_status, 0) << outcome.err;
    const auto found = outcome.err.find("warning: the needle's tip is outside of");
    ASSERT_NE(found, std::string::npos) << outcome.err;
    EXPECT_TRUE(fs::remove(folder_ / "x.png"));
  }
}

TEST_F(XrayCommand, PatientWithoutCtIsRefused) {
  const std::string copy = folder_ / "no_ct";
  fs::copy(patient(), copy, fs::copy_options::recursive);
  fs::remove(copy + "/ct.nrrd");
  expect_refused("--patient '" + copy + "'", 1);
  expect_refused("--patient '" + (folder_ / "nothing") + "'", 1);
}

TEST_F(XrayCommand, BadOutputIsRefused) {
  expect_usage_error("", "x.jpg");
  expect_usage_error("--frames 3", "x.png");
  expect_usage_error("--frames 0", "x.dcm");
  expect_usage_error("--subtract --contrast 3@" + kDuct, "x.nrrd");
  expect_refused("--patient '" + patient() + "'", 1, "no folder/x.png");
  std::ofstream(folder_ / "there.png") << "old";
  EXPECT_EQ(xray("", "there.png").exit_status, 2);
  EXPECT_EQ(read_text(folder_ / "there.png"), "old");
  const Outcome outcome = trocar("xray --patient '" + patient() + "' --out /proc/x.png");  // no one can write there
  EXPECT_EQ(outcome.exit_status, 1) << outcome.err;
  EXPECT_NE(outcome.err.find("/proc/x.png"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace trocar::cli_test
