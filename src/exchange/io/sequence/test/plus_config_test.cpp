#include "io/sequence/plus_config.h"

#include <fmt/format.h>

#include <cmath>

#include "io/test/test_support.h"

namespace trocar::io {
namespace {

using testing::test_data;
using testing::write_bytes;

class PlusConfigFile : public ::testing::Test {
 protected:
  Result<PlusConfig> read(const std::string& text) {
    write_bytes(path_, text);
    return read_plus_config(path_);
  }
  std::string refusal(const std::string& text) {
    const auto result = read(text);
    if (result) return "was read";
    EXPECT_EQ(result.error().where, path_.string());
    return result.error().what;
  }
  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "config.xml";
};

std::string with_reconstruction(std::string_view attributes, std::string_view inside = {}) {
  return fmt::format("<PlusConfiguration><VolumeReconstruction {}>{}</VolumeReconstruction></PlusConfiguration>",
                     attributes, inside);
}

TEST_F(PlusConfigFile, ReadsTransformsAndReconstruction) {
  const auto config = read(
      "<?xml version=\"1.0\"?><!-- calibrated --><PlusConfiguration version=\"2.1\"><CoordinateDefinitions>"
      "<Transform From=\"Image\" To=\"Probe\" Matrix=\"0.1 0 0 1\n 0 0.2 0 2 0 0 0.3 3 0 0 0 1\"/>"
      "</CoordinateDefinitions><VolumeReconstruction ImageCoordinateFrame=\"Image\" ReferenceCoordinateFrame=\"Bed\" "
      "OutputSpacing=\"0.5 0.6 0.7\" ClipRectangleOrigin=\"10 20\" ClipRectangleSize=\"30 40\" "
      "Interpolation=\"LINEAR\" CompoundingMode=\"MAXIMUM\" FillHoles=\"ON\"><HoleFilling>"
      "<HoleFillingElement Type=\"GAUSSIAN\" Size=\"7\" Stdev=\"1.5\" MinimumKnownVoxelsRatio=\"0.25\"/>"
      "<HoleFillingElement Type=\"STICK\" StickLengthLimit=\"11\" NumberOfSticksToUse=\"2\"/>"
      "</HoleFilling></VolumeReconstruction></PlusConfiguration>");
  ASSERT_TRUE(config) << config.error().text();
  EXPECT_EQ(config->transforms.at("ImageToProbe")(1, 3), 2.0);
  const ultrasound::FreehandOptions& options = config->reconstruction;
  EXPECT_EQ(options.reference_frame, "Bed");
  EXPECT_EQ(options.spacing_mm, Vec3(0.5, 0.6, 0.7));
  ASSERT_TRUE(options.rectangle);
  EXPECT_EQ(options.rectangle->first_row, 20);
  EXPECT_EQ(options.rectangle->columns, 30);
  EXPECT_EQ(options.interpolation, ultrasound::FreehandInterpolation::kLinear);
  EXPECT_EQ(options.compounding, ultrasound::FreehandCompounding::kMaximum);
  ASSERT_EQ(options.holes.size(), 2U);
  EXPECT_EQ(options.holes[0].kind, ultrasound::HoleFilling::Kind::kGaussian);
  EXPECT_EQ(options.holes[0].size, 7);
  EXPECT_EQ(options.holes[0].least_share, 0.25);
  EXPECT_EQ(options.holes[1].stick_length_limit, 11);
  EXPECT_EQ(options.holes[1].sticks, 2);
}

TEST_F(PlusConfigFile, FillsHolesOnlyIfEnabled) {
  const auto config =
      read(with_reconstruction("FillHoles=\"OFF\"", "<HoleFilling><HoleFillingElement/></HoleFilling>"));
  ASSERT_TRUE(config) << config.error().text();
  EXPECT_TRUE(config->has_reconstruction);
  EXPECT_TRUE(config->reconstruction.holes.empty());
}

TEST_F(PlusConfigFile, ReadsAFanInDegrees) {
  const auto config = read(with_reconstruction(
      "FanAnglesDeg=\"-45 30\" FanOriginPixel=\"320 -50\" FanRadiusStartPixel=\"60\" FanRadiusStopPixel=\"500\" "
      "OutputOrigin=\"1 2 3\""));
  ASSERT_TRUE(config) << config.error().text();
  ASSERT_TRUE(config->reconstruction.fan);
  EXPECT_NEAR(config->reconstruction.fan->first_angle_rad, -0.785398, 1e-6);
  EXPECT_EQ(config->reconstruction.fan->origin_row, -50.0);
  EXPECT_EQ(config->reconstruction.fan->last_radius_px, 500.0);
  ASSERT_EQ(config->left_aside.size(), 1U);
  EXPECT_NE(config->left_aside[0].find("OutputOrigin"), std::string::npos);
}

TEST_F(PlusConfigFile, RefusesDamagedFilesInOneLine) {
  struct Case {
    std::string text, word;
  };
  const auto transform = [](std::string_view matrix) {
    return fmt::format(
        "<PlusConfiguration><CoordinateDefinitions><Transform From=\"Image\" To=\"Probe\" Matrix=\"{}\"/>"
        "</CoordinateDefinitions></PlusConfiguration>",
        matrix);
  };
  std::string deep;
  for (int n = 0; n < 50'000; ++n) deep += "<a>";
  const std::vector<Case> cases = {
      {"", "is no"},
      {"[toml]\n", "is not well-formed XML at byte"},
      {"<PlusConfiguration><Coord", "is not well-formed XML"},
      {"<PlusConfiguration></Other>", "is not well-formed XML"},
      {"<svg/>", "is not a PLUS configuration"},
      {deep, "nested too deeply"},
      {"<!DOCTYPE a [<!ENTITY b \"c\">]><PlusConfiguration/>", "document type"},
      {std::string("<Plus\0Configuration/>", 21), "is not well-formed XML"},
      {transform("1 0 0 0 0 1 0 0 0 0 1 0 0 0 0"), "ImageToProbe is not a matrix of 16"},
      {transform("nan 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"), "16 finite numbers"},
      {transform("1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1"), "last row"},
      {"<PlusConfiguration><CoordinateDefinitions><Transform From=\"Image\"/></CoordinateDefinitions>"
       "</PlusConfiguration>",
       "lacks From, To or Matrix"},
      {with_reconstruction("OutputSpacing=\"0.5 0.5\""), "does not give 3 numbers"},
      {with_reconstruction("Interpolation=\"CUBIC\""), "Interpolation=\"CUBIC\" is not known"},
      {with_reconstruction("CompoundingMode=\"IMPORTANCE_MASK\""), "is not known"},
      {with_reconstruction("", "<HoleFilling><HoleFillingElement Size=\"2.5\"/></HoleFilling>"), "whole number"},
  };
  for (const Case& bad : cases)
    EXPECT_NE(refusal(bad.text).find(bad.word), std::string::npos) << bad.word << ": " << refusal(bad.text);
  EXPECT_FALSE(read(std::string(2'000'000, ' ')));
  EXPECT_FALSE(read_plus_config(folder_ / "none.xml"));
}

TEST(RealPlusConfig, IsRead) {
  const auto path =
      test_data() / "us-spine-phantom" / "PlusDeviceSet_VolumeReconstructionOnly_SpinePhantom_NN_MEAN.xml";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no real data at " << path;
  const auto config = read_plus_config(path);
  ASSERT_TRUE(config) << config.error().text();
  EXPECT_EQ(config->transforms.at("ImageToProbe")(0, 3), 15.3978);
  EXPECT_EQ(config->reconstruction.spacing_mm, Vec3(0.5, 0.5, 0.5));
  EXPECT_EQ(config->reconstruction.rectangle->columns, 820);
  ASSERT_EQ(config->reconstruction.holes.size(), 1U);
  EXPECT_EQ(config->reconstruction.holes[0].stick_length_limit, 9);
}

}  // namespace
}  // namespace trocar::io
