// trocar register: the files that it writes, and what it refuses.
#include <gtest/gtest.h>

#include "cli/program.h"
#include "io/image/image_file.h"
#include "io/markups_file.h"
#include "io/sequence/transform_file.h"
#include "lab/registration/generated_pair.h"
#include "registration/ct_ultrasound/rigid_registration.h"

namespace trocar::cli_test {
namespace {

namespace testing = registration::testing;

constexpr double kWorst_mm = 0.8;  ///< As in the module's test.

testing::GeneratedPair write_pair(const TemporaryFolder& folder, double mm, double rad) {
  testing::PairOptions options;
  options.offset_mm = mm;
  options.offset_rad = rad;
  testing::GeneratedPair pair = testing::make_pair(options);
  EXPECT_TRUE(io::write_image(pair.ct, folder / "ct.nrrd"));
  EXPECT_TRUE(io::write_image(pair.us, folder / "us.nrrd"));
  return pair;
}

double error_mm(const testing::GeneratedPair& pair, const Pose& X_CU) {
  return *registration::mean_distance_mm(pair.us, *registration::Beams::along_axis("+y", pair.us.geometry), X_CU,
                                         pair.X_CU);
}

std::string volumes(const TemporaryFolder& folder) {
  return "register --ct " + (folder / "ct.nrrd") + " --us " + (folder / "us.nrrd");
}

bool exists(const std::string& path) {
  return std::filesystem::exists(path);
}

TEST(Register, WritesTransformImageAndFigures) {
  const TemporaryFolder folder;
  const testing::GeneratedPair pair = write_pair(folder, 10.0, radians(10.0));
  const config::Json json = json_of(
      trocar(volumes(folder) + " --json --out " + (folder / "x.tfm") + " --checkerboard " + (folder / "x.png")));
  for (const char* key : {"metric", "overlap", "confidence", "seconds"}) EXPECT_TRUE(json[key].is_number()) << key;
  const auto X_CU = io::read_transform(folder / "x.tfm");
  ASSERT_TRUE(X_CU);
  EXPECT_LT(error_mm(pair, *X_CU), kWorst_mm);
  EXPECT_EQ(read_text(folder / "x.png").substr(1, 3), "PNG");
}

TEST(Register, WritesADeformationBesideTheRigidTransform) {
  const TemporaryFolder folder;
  write_pair(folder, 3.0, 0.03);
  const config::Json json = json_of(trocar(volumes(folder) + " --deformable --json --out " + (folder / "x.tfm")));
  EXPECT_TRUE(json["deformable"]["least_jacobian"].is_number());
  EXPECT_TRUE(io::read_transform(folder / "x.tfm"));
  const std::string text = read_text(folder / "x.deformable.tfm");
  EXPECT_LT(text.find("CompositeTransform"), text.find("AffineTransform"));
  EXPECT_LT(text.find("AffineTransform"), text.find("BSplineTransform"));
}

TEST(Register, StartsFromLandmarks) {
  const TemporaryFolder folder;
  const testing::GeneratedPair pair = write_pair(folder, 120.0, 2.0);  // far beyond the reach of the headers
  std::vector<anatomy::Landmark> us = {
      {"apex", Vec3(0, 10, 0)}, {"hilum", Vec3(40, 0, 10)}, {"tip", Vec3(-20, 30, 0)}, {"vein", Vec3(5, -10, 45)}};
  std::vector<anatomy::Landmark> ct;
  for (anatomy::Landmark& landmark : us) {
    landmark.p_P = pair.X_CU.inverse() * landmark.p_P;
    ct.push_back({landmark.name, pair.X_CU * landmark.p_P + Vec3(1.0, -1.0, 0.5)});
  }
  ASSERT_TRUE(io::write_landmarks(us, folder / "us.mrk.json"));
  ASSERT_TRUE(io::write_landmarks(ct, folder / "ct.mrk.json"));
  const std::string line = volumes(folder) + " --landmarks " + (folder / "ct.mrk.json") + ' ' +
                           (folder / "us.mrk.json") + " --out " + (folder / "x.tfm");
  const Outcome outcome = trocar(line);
  ASSERT_EQ(outcome.exit_status, 0) << outcome.err;
  EXPECT_LT(error_mm(pair, *io::read_transform(folder / "x.tfm")), kWorst_mm);

  std::filesystem::remove(folder / "x.tfm");
  ct[2].p_P += Vec3(0, 40, 0);
  std::filesystem::remove(folder / "ct.mrk.json");
  ASSERT_TRUE(io::write_landmarks(ct, folder / "ct.mrk.json"));
  const Outcome refused = trocar(line);
  EXPECT_EQ(refused.exit_status, 1);
  EXPECT_NE(refused.err.find("\"tip\""), std::string::npos) << refused.err;
  EXPECT_FALSE(exists(folder / "x.tfm"));
}

TEST(Register, WritesNothingWithoutAReliableResult) {
  const TemporaryFolder folder;
  const testing::GeneratedPair pair = write_pair(folder, 0.0, 0.0);
  testing::PairOptions options;
  options.seed = 77;
  ASSERT_TRUE(io::write_image(testing::make_pair(options).ct, folder / "other.nrrd"));
  ASSERT_TRUE(io::write_image(volume::LabelGrid(pair.us.geometry, 80), folder / "constant.nrrd"));
  const auto refusal = [&](const std::string& ct, const std::string& us) {
    const Outcome outcome = trocar("register --ct " + (folder / ct) + " --us " + (folder / us) + " --out " +
                                   (folder / "x.tfm") + " --checkerboard " + (folder / "x.png"));
    EXPECT_EQ(outcome.exit_status, 1) << outcome.err;
    EXPECT_FALSE(exists(folder / "x.tfm"));
    EXPECT_FALSE(exists(folder / "x.png"));
    return outcome.err;
  };
  EXPECT_NE(refusal("other.nrrd", "us.nrrd").find("confidence"), std::string::npos);
  EXPECT_NE(refusal("ct.nrrd", "constant.nrrd").find("same gray level"), std::string::npos);
  EXPECT_NE(refusal("ct.nrrd", "ct.nrrd").find("not a gray level (0 to 255)"), std::string::npos);
}

TEST(Register, RefusesArgumentsThatCannotBeUsed) {
  const TemporaryFolder folder;
  write_pair(folder, 0.0, 0.0);
  for (const std::string wrong : {"x.txt", "x.tfm --beam-axis up", "x.tfm --init near", "x.tfm --checkerboard x.jpg"}) {
    const Outcome outcome = trocar(volumes(folder) + " --out " + (folder / wrong));
    EXPECT_EQ(outcome.exit_status, 2) << wrong << outcome.err;
  }
  EXPECT_FALSE(exists(folder / "x.tfm"));
}

}  // namespace
}  // namespace trocar::cli_test
