#include "io/sequence/sequence_file.h"

#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "io/image/image_file.h"
#include "io/test/test_support.h"

namespace trocar::io {
namespace {

using testing::read_bytes;
using testing::test_data;
using testing::write_bytes;

/// Two pictures of 3 by 2 pixels, plain, as PLUS writes them.
std::string header(std::string_view changes_from = {}, std::string_view changes_to = {}) {
  std::string text =
      "ObjectType = Image\nNDims = 3\nBinaryData = True\nCompressedData = False\nDimSize = 3 2 2   \n"
      "Kinds = domain domain list\nElementType = MET_UCHAR\nUltrasoundImageOrientation = MFA\n"
      "Seq_Frame0000_ProbeToTrackerTransform = 1 0 0 10 0 1 0 20 0 0 1 30 0 0 0 1\n"
      "Seq_Frame0000_ProbeToTrackerTransformStatus = OK\nSeq_Frame0000_Timestamp = 1.5\n"
      "Seq_Frame0000_ImageStatus = OK\n"
      "Seq_Frame0001_ProbeToTrackerTransform = nan 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n"
      "Seq_Frame0001_ProbeToTrackerTransformStatus = INVALID\nSeq_Frame0001_Timestamp = 1.75\n"
      "Seq_Frame0001_ImageStatus = INVALID\nElementDataFile = LOCAL\n";
  if (!changes_from.empty()) {
    const auto at = text.find(changes_from);
    EXPECT_NE(at, std::string::npos) << changes_from;
    text.replace(at, changes_from.size(), changes_to);
  }
  return text;
}

const std::string kPixels = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};

class SequenceFile : public ::testing::Test {
 protected:
  Result<ultrasound::TrackedSequence> read(const std::string& bytes) {
    write_bytes(path_, bytes);
    return read_sequence(path_);
  }
  /// Reads bytes that must be refused; gives the error's text.
  std::string refusal(const std::string& bytes) {
    const auto result = read(bytes);
    if (result) return "was read";
    EXPECT_EQ(result.error().where, path_.string());
    return result.error().what;
  }
  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "sweep.igs.mha";
};

TEST_F(SequenceFile, ReadsImagesPosesAndTimes) {
  const auto sequence = read(header() + kPixels);
  ASSERT_TRUE(sequence) << sequence.error().text();
  EXPECT_EQ(sequence->columns, 3);
  EXPECT_EQ(sequence->rows, 2);
  ASSERT_EQ(sequence->frames.size(), 2U);
  EXPECT_EQ(sequence->pixels, std::vector<std::uint8_t>(kPixels.begin(), kPixels.end()));
  EXPECT_EQ(sequence->frames[0].transforms.at("ProbeToTracker")(1, 3), 20.0);
  EXPECT_EQ(sequence->frames[1].time_s, 1.75);
}

TEST_F(SequenceFile, IsDistinguishedFromAVolume) {
  write_bytes(path_, header() + kPixels);
  EXPECT_TRUE(is_sequence(path_).value());
  std::vector<std::string> warnings;
  const auto gray = read_gray_levels(path_, warnings);
  ASSERT_FALSE(gray);
  EXPECT_EQ(gray.error().what, "a tracked sequence of images, not a volume");
  EXPECT_NE(gray.error().advice.find("trocar ultrasound reconstruct"), std::string::npos);
  EXPECT_FALSE(read_ct(path_)) << "nor as a CT";
  volume::LabelGrid volume;
  volume.geometry.size = {3, 2, 2};
  volume.voxels.assign(12, 7);
  for (const char* name : {"volume.mha", "volume.nrrd"}) {
    ASSERT_TRUE(write_image(volume, folder_ / name));
    EXPECT_FALSE(is_sequence(folder_ / name).value()) << name;
  }
  EXPECT_FALSE(is_sequence(folder_ / "none.mha"));
}

TEST_F(SequenceFile, HonoursStatuses) {
  const auto sequence = read(header() + kPixels);
  ASSERT_TRUE(sequence) << sequence.error().text();
  EXPECT_TRUE(sequence->frames[0].is_valid);
  EXPECT_FALSE(sequence->frames[1].is_valid);
  EXPECT_TRUE(sequence->frames[1].transforms.empty());
}

TEST_F(SequenceFile, ReordersImagesToOneOrientation) {
  const auto far_near = read(header("MFA", "MNA") + kPixels);
  ASSERT_TRUE(far_near) << far_near.error().text();
  EXPECT_EQ(far_near->pixels, (std::vector<std::uint8_t>{4, 5, 6, 1, 2, 3, 10, 11, 12, 7, 8, 9}));
  const auto unmarked = read(header("MFA", "UFA") + kPixels);
  ASSERT_TRUE(unmarked) << unmarked.error().text();
  EXPECT_EQ(unmarked->pixels, (std::vector<std::uint8_t>{3, 2, 1, 6, 5, 4, 9, 8, 7, 12, 11, 10}));
  EXPECT_NE(refusal(header("MFA", "AMF") + kPixels).find("orientation AMF"), std::string::npos);
}

TEST_F(SequenceFile, ReadsADetachedHeader) {
  write_bytes(folder_ / "pixels.raw", kPixels);
  const auto sequence = read(header("LOCAL", "pixels.raw"));
  ASSERT_TRUE(sequence) << sequence.error().text();
  EXPECT_EQ(sequence->pixels[11], 12);
  EXPECT_NE(refusal(header("LOCAL", "gone.raw")).find("gone.raw"), std::string::npos);
}

TEST_F(SequenceFile, RefusesDamagedFilesInOneLine) {
  struct Case {
    std::string bytes, word;
  };
  const std::string digits(400, '9');
  const std::vector<Case> cases = {
      {"", "not a tracked sequence"},
      {std::string(5'000'000, 'x'), "not a tracked sequence"},
      {std::string("NRRD0004\ntype: uchar\n"), "not a tracked sequence"},
      {header().substr(0, 300), "ends before ElementDataFile"},
      {header("DimSize = 3 2 2", "DimSize = 3 2") + kPixels, "DimSize"},
      {header("DimSize = 3 2 2", "DimSize = 3 -2 2") + kPixels, "DimSize"},
      {header("DimSize = 3 2 2", "DimSize = 3 nan 2") + kPixels, "DimSize"},
      {header("DimSize = 3 2 2", "Size = 3 2 2") + kPixels, "DimSize"},
      {header("DimSize = 3 2 2", "DimSize = 60000 60000 2") + kPixels, "impossible size"},
      {header("DimSize = 3 2 2", "DimSize = 3 2 " + digits) + kPixels, "DimSize"},
      {header("DimSize = 3 2 2", "DimSize = 3 2 3") + kPixels, "has 3 pictures, but the fields of 2"},
      {header("DimSize = 3 2 2", "DimSize = 3 2 1") + kPixels, "has 1 pictures, but the fields of 2"},
      {header("Frame0001_Image", "Frame999999999_Image") + kPixels, "up to number 999999999"},
      {header("MET_UCHAR", "MET_SHORT") + kPixels, "pixels of type MET_SHORT"},
      {header("ElementType = MET_UCHAR\n", "") + kPixels, "ElementType is missing"},
      {header("Kinds", "ElementNumberOfChannels = 3\nKinds") + kPixels, "several values a pixel"},
      {header("= 1 0 0 10", "= 1 nan 0 10") + kPixels, "Seq_Frame0000_ProbeToTrackerTransform is not a matrix"},
      {header("= 1 0 0 10", "= 1 inf 0 10") + kPixels, "16 finite numbers"},
      {header("= 1 0 0 10", "= 0 0 10") + kPixels, "16 finite numbers"},
      {header("30 0 0 0 1", "30 0 0 0 2") + kPixels, "last row"},
      {header("= 1.5", "= soon") + kPixels, "Timestamp is not a time"},
      {header() + kPixels.substr(1), "end before the last pixel (11 of 12 bytes)"},
      {header("CompressedData = False", "CompressedData = True") + kPixels, "compressed pixels are damaged"},
      {header("CompressedData = False", "CompressedData = True\nCompressedDataSize = 99") + kPixels, "too early"},
  };
  for (const Case& bad : cases) {
    EXPECT_NE(refusal(bad.bytes).find(bad.word), std::string::npos) << bad.word << ": " << refusal(bad.bytes);
  }
  EXPECT_NE(read_sequence(folder_ / "none.mha").error().what.find("no such file"), std::string::npos);
  EXPECT_FALSE(read_sequence(folder_.path()));
}

TEST_F(SequenceFile, RefusesAnEndlessHeader) {
  std::string other, frames;
  for (int n = 0; n < 10'001; ++n) other += "field" + std::to_string(n) + " = 1\n";
  for (int n = 0; n < 1'000'001; ++n) frames += "Seq_Frame0000_a" + std::to_string(n % 10) + " =\n";
  for (const std::string& fields : {other, frames})
    EXPECT_NE(refusal(header("Kinds", fields + "Kinds") + kPixels).find("header is too large"), std::string::npos);
}

TEST_F(SequenceFile, RefusesATruncatedFile) {
  ultrasound::TrackedSequence sequence = *read(header() + kPixels);
  const auto whole_path = folder_ / "whole.igs.mha";
  ASSERT_TRUE(write_sequence(sequence, whole_path));
  const std::string whole = read_bytes(whole_path);
  EXPECT_FALSE(read(whole.substr(0, whole.size() - 1)));
  for (std::size_t length = 0; length < whole.size(); length += 7)
    EXPECT_FALSE(read(whole.substr(0, length))) << length;
}

ultrasound::TrackedSequence sweep() {
  ultrasound::TrackedSequence sequence;
  sequence.columns = 20;
  sequence.rows = 31;
  sequence.frames.resize(3);
  sequence.pixels.resize(sequence.frame_pixels() * 3);
  std::iota(sequence.pixels.begin(), sequence.pixels.end(), std::uint8_t{0});
  for (std::size_t n = 0; n < 3; ++n) {
    ultrasound::TrackedSequence::Matrix4 matrix = ultrasound::TrackedSequence::Matrix4::Identity();
    matrix(0, 3) = 1.0 / 3.0 + static_cast<double>(n);
    matrix(2, 1) = 0.1 * std::sqrt(2.0);
    sequence.frames[n].time_s = 0.1 * static_cast<double>(n);
    sequence.frames[n].transforms.emplace("ImageToReference", matrix);
  }
  sequence.frames[1].transforms.emplace("ProbeToTracker", ultrasound::TrackedSequence::Matrix4::Identity());
  sequence.frames[2].is_valid = false;
  return sequence;
}

TEST_F(SequenceFile, RoundTrips) {
  const ultrasound::TrackedSequence sequence = sweep();
  ASSERT_TRUE(write_sequence(sequence, path_));
  const auto read_back = read_sequence(path_);
  ASSERT_TRUE(read_back) << read_back.error().text();
  EXPECT_EQ(read_back->columns, sequence.columns);
  EXPECT_EQ(read_back->rows, sequence.rows);
  EXPECT_EQ(read_back->pixels, sequence.pixels);
  ASSERT_EQ(read_back->frames.size(), 3U);
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_EQ(read_back->frames[n].time_s, sequence.frames[n].time_s);
    EXPECT_EQ(read_back->frames[n].is_valid, sequence.frames[n].is_valid);
    EXPECT_EQ(read_back->frames[n].transforms, sequence.frames[n].transforms);
  }
}

TEST_F(SequenceFile, WritesPlusFieldNames) {
  ASSERT_TRUE(write_sequence(sweep(), path_));
  const std::string text = read_bytes(path_);
  for (const char* line : {"UltrasoundImageOrientation = MFA\n", "Seq_Frame0000_ImageToReferenceTransformStatus = OK\n",
                           "Seq_Frame0001_ProbeToTrackerTransform = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n",
                           "Seq_Frame0000_ProbeToTrackerTransformStatus = INVALID\n", "Seq_Frame0001_Timestamp = 0.1\n",
                           "Seq_Frame0002_ImageStatus = INVALID\n", "DimSize = 20 31 3\n", "ElementDataFile = LOCAL\n"})
    EXPECT_NE(text.find(line), std::string::npos) << line;
}

TEST_F(SequenceFile, RefusesToWriteInvalidSequences) {
  ultrasound::TrackedSequence sequence = sweep();
  EXPECT_FALSE(write_sequence({}, path_));
  EXPECT_FALSE(write_sequence(sequence, folder_ / "sweep.nrrd"));
  sequence.frames[0].transforms.emplace("Probe\nToTracker", ultrasound::TrackedSequence::Matrix4::Identity());
  EXPECT_FALSE(write_sequence(sequence, path_));
  sequence = sweep();
  sequence.frames[0].transforms.begin()->second(0, 0) = std::nan("");
  EXPECT_FALSE(write_sequence(sequence, path_));
  sequence = sweep();
  sequence.pixels.pop_back();
  EXPECT_FALSE(write_sequence(sequence, path_));
  EXPECT_FALSE(std::filesystem::exists(path_));
}

TEST(RealSequence, MatchesPlus) {
  const auto path = test_data() / "us-spine-phantom" / "SpinePhantomFreehand.igs.mha";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no real data at " << path;
  const auto sequence = read_sequence(path);
  ASSERT_TRUE(sequence) << sequence.error().text();
  EXPECT_EQ(sequence->columns, 820);
  EXPECT_EQ(sequence->rows, 616);
  ASSERT_EQ(sequence->frames.size(), 21U);
  EXPECT_EQ(sequence->frames[20].transforms.at("ReferenceToTracker")(2, 3), 3.12539);
  EXPECT_EQ(sequence->frames[0].time_s, 215.102186);
  // A volume of the same folder is no sequence.
  const auto volume = read_sequence(path.parent_path() / "vtkVolumeReconstructorTestNNMEANvolumeRef.mha");
  ASSERT_FALSE(volume);
  EXPECT_NE(volume.error().what.find("105 pictures, but the fields of 1"), std::string::npos);
}

}  // namespace
}  // namespace trocar::io
