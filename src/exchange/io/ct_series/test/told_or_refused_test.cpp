// Series that contradict themselves or lost a part: each is refused, or told; none is read as another patient.

#include <gtest/gtest.h>

#include <cmath>

#include "dicom/testing/dicom_writer.h"
#include "io/image/image_file.h"
#include "io/test/test_support.h"

namespace trocar::io {
namespace {
namespace fs = std::filesystem;

using testing::CtSeries;
using testing::write_slice;
using testing::write_slices;

/// A body that changes from slice to slice.
double body_hu(const Vec3& p_P) {
  return 30.0 * p_P.x() - 20.0 * p_P.y() + 5.0 * p_P.z() + 40.0;
}

std::vector<Vec3> heights(int count, double step_mm = 2.0, double first_mm = 0.0) {
  std::vector<Vec3> origins_P;
  for (int n = 0; n < count; ++n) origins_P.emplace_back(0.0, 0.0, first_mm + step_mm * n);
  return origins_P;
}

/// "read" with its warnings, or the error.
std::string outcome_of(const fs::path& folder) {
  const auto scan = read_ct_scan(folder);
  return scan ? fmt::format("read{}", fmt::join(scan->warnings, "; ")) : scan.error().text();
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(DicomNumbers, RefuseNonDecimalText) {
  for (const std::string text : {"4,8\\4,8", "4.8mm\\4.8mm", "4.8\\4.8\\4.8", "4.8", "4.8\\x", "\\4.8"}) {
    const TemporaryFolder folder;
    CtSeries series;
    series.spacing_text = text;
    write_slices(folder.path(), series, heights(3), body_hu);
    EXPECT_TRUE(has(outcome_of(folder.path()), "PixelSpacing is \"" + text)) << text << outcome_of(folder.path());
  }
  for (const std::string text : {" 4.80\\+4.8 ", "4.8 \\ 4.8", "48e-1\\4.8"}) {
    const TemporaryFolder folder;
    CtSeries series;
    series.spacing_text = text;
    write_slices(folder.path(), series, heights(3), body_hu);
    const auto scan = read_ct_scan(folder.path());
    ASSERT_TRUE(scan) << scan.error().text();
    EXPECT_NEAR(scan->grid.geometry.spacing_mm.x(), 4.8, 1e-12) << text;
  }
}

TEST(DicomNumbers, OfTheRescaleAreParsedCompletely) {
  for (const std::string text : {"-1024,0", "-1024\\0", "1 024"}) {
    const TemporaryFolder folder;
    CtSeries series;
    series.intercept = text;
    write_slices(folder.path(), series, heights(3), body_hu);
    EXPECT_TRUE(has(outcome_of(folder.path()), "RescaleIntercept is \"" + text)) << outcome_of(folder.path());
  }
}

TEST(DicomScaling, IsRefusedIfSomeSlicesLackIt) {
  for (const std::string other : {"", " "}) {
    const TemporaryFolder folder;
    CtSeries series;
    series.intercept = "-1024";
    write_slices(folder.path(), series, heights(5), body_hu);
    EXPECT_EQ(outcome_of(folder.path()), "read");
    series.intercept = other;
    write_slice(folder / "slice3", series, heights(5)[3], "1.2.3.4", body_hu);
    EXPECT_TRUE(has(outcome_of(folder.path()), "RescaleIntercept is missing in some slices"))
        << outcome_of(folder.path());
  }
  const TemporaryFolder folder;
  CtSeries series;
  series.intercept = "";
  write_slices(folder.path(), series, heights(5), body_hu);
  EXPECT_EQ(outcome_of(folder.path()), "read");  // none has one: stored as HU
}

TEST(LostSlices, AreRefusedByTheirNames) {
  const TemporaryFolder folder;
  write_slices(folder.path(), {}, heights(5), body_hu);
  testing::write_bytes(folder / "._slice5.dcm", "resource fork");
  testing::write_bytes(folder / "notes", "");
  testing::write_bytes(folder / "readme1.txt", "text");
  EXPECT_EQ(outcome_of(folder.path()), "read");
  for (const auto& [name, content] : {std::pair<std::string, std::string>{"slice5.dcm", ""},
                                      {"slice5.DCM", std::string(20'000, '\0')},
                                      {"slice5.ima", "<html>404</html>"},
                                      {"slice5", ""},
                                      {"I0005", std::string(9'000, '\0')}}) {
    testing::write_bytes(folder / name, content);
    const std::string outcome = outcome_of(folder.path());
    EXPECT_TRUE(has(outcome, "a slice may be missing") && has(outcome, name)) << name << ": " << outcome;
    fs::remove(folder / name);
  }
}

TEST(Acquisitions, AreReadInBlocksButRefusedWhenInterleaved) {
  const auto outcome = [](const std::vector<std::string>& numbers) {
    const TemporaryFolder folder;
    for (std::size_t n = 0; n < numbers.size(); ++n) {
      CtSeries series;
      series.acquisition = numbers[n];
      write_slice(folder / fmt::format("slice{}", n), series, Vec3(0, 0, 2.0 * static_cast<double>(n)),
                  fmt::format("1.2.3.{}", n), body_hu);
    }
    return outcome_of(folder.path());
  };
  EXPECT_EQ(outcome({"1", "1", "1", "2", "2", "2"}), "read");  // steps of a table
  EXPECT_EQ(outcome({"6", "5", "4", "3", "2", "1"}), "read");  // one acquisition a slice
  EXPECT_EQ(outcome({"1", "1", "2", "1", "1", "1"}), "read");  // a slice scanned again
  EXPECT_EQ(outcome({"", "", "", "", "", ""}), "read");
  EXPECT_TRUE(has(outcome({"1", "2", "1", "2", "1", "2"}), "of 2 acquisitions or phases alternate 5 times"));
  EXPECT_TRUE(has(outcome({"1", "1", "2", "2", "1", "1", "2", "2"}), "alternate 3 times"));
}

TEST(Acquisitions, WithoutNumbersAreDistinguishedByPixels) {
  const auto outcome = [](double other_shift_mm, double noise_hu) {
    const TemporaryFolder folder;
    std::uint32_t random = 1;
    for (int n = 0; n < 20; ++n) {
      const double shift_mm = n % 2 == 0 ? 0.0 : other_shift_mm;
      write_slice(folder / fmt::format("slice{}", n), {}, Vec3(0, 0, 2.0 * n), fmt::format("1.2.3.{}", n),
                  [&](const Vec3& p_P) {
                    random = random * 1664525U + 1013904223U;
                    return body_hu(p_P + Vec3(shift_mm, 0, 0)) +
                           noise_hu * (static_cast<double>(random >> 16) / 65536.0 - 0.5);
                  });
    }
    return outcome_of(folder.path());
  };
  EXPECT_EQ(outcome(0.0, 0.0), "read");
  EXPECT_EQ(outcome(0.0, 400.0), "read");  // nothing but noise
  EXPECT_TRUE(has(outcome(5.0, 0.0), "resembles the next but one")) << outcome(5.0, 0.0);
  EXPECT_TRUE(has(outcome(-5.0, 40.0), "resembles the next but one")) << outcome(-5.0, 40.0);
}

TEST(Copies, OfOneInstanceWithDifferentPixelsAreRefused) {
  for (const char* name : {"a", "z"}) {
    const TemporaryFolder folder;
    write_slices(folder.path(), {}, heights(5), body_hu);
    write_slice(folder / name, {}, heights(5)[2], "1.2.3.3", [](const Vec3& p_P) { return body_hu(p_P) + 1.0; });
    const std::string outcome = outcome_of(folder.path());
    EXPECT_TRUE(has(outcome, "slice2") && has(outcome, "one SOPInstanceUID, but different pixels")) << outcome;
  }
}

TEST(Captures, AreSkippedAmongSlices) {
  const TemporaryFolder folder;
  write_slices(folder.path(), {}, heights(5), body_hu);
  CtSeries capture;
  capture.sop_class = "1.2.840.10008.5.1.4.1.1.7";
  write_slice(folder / "capture", capture, Vec3(0, 0, 10), "1.2.3.9", [](const Vec3&) { return 2000.0; });
  EXPECT_EQ(outcome_of(folder.path()), "readleft out a secondary capture among the slices: capture");
  const TemporaryFolder converted;  // a series that consists of them
  write_slices(converted.path(), capture, heights(5), body_hu);
  EXPECT_EQ(outcome_of(converted.path()), "read");
}

/// Padding outside x = 1 … 6, and one pixel of the same number within.
struct PaddedCt {
  std::string intercept = "0";
  int padding = -2000;  ///< Stored.
  std::string limit;    ///< PixelPaddingRangeLimit.

  Result<CtScan> read() const {
    const TemporaryFolder folder;
    CtSeries series;
    series.intercept = intercept;
    series.more = testing::dicom_short(0x0028, 0x0120, padding) + limit;
    write_slices(folder.path(), series, heights(3), [&](const Vec3& p_P) {
      const bool is_outside = p_P.x() < 0.5 || p_P.x() > 6.5;
      const bool is_within = std::abs(p_P.x() - 3.0) + std::abs(p_P.y() - 3.0) < 0.1;
      return is_outside || is_within ? padding : 40.0 - std::stod(intercept);
    });
    return read_ct_scan(folder.path());
  }
};

TEST(Padding, IsAirWithAWarningIfItWouldBeTissue) {
  const auto voxels = [](const PaddedCt& padded) {
    const auto scan = padded.read();
    EXPECT_TRUE(scan) << scan.error().text();
    if (!scan) return std::string();
    const auto at = [&](std::int64_t i, std::int64_t j) {
      return scan->grid.voxels[scan->grid.geometry.offset({i, j, 1})];
    };
    return fmt::format("{} {} {} {} {}", at(0, 0), at(3, 3), at(4, 4), at(7, 5), fmt::join(scan->warnings, "; "));
  };
  EXPECT_EQ(voxels({"0", -2000, {}}), "-2000 -2000 40 -2000 ");
  EXPECT_EQ(
      voxels({"0", 0, {}}),
      "-1024 0 40 -1024 padding of the CT (PixelPaddingValue, 0 HU) is taken as air: 25 % of the pixels; 3 pixels "
      "of it within the image are taken as tissue of 0 HU");
  EXPECT_EQ(voxels({"0", 20000, {}}),
            "-1024 -1024 40 -1024 padding of the CT (PixelPaddingValue, 20000 HU) is taken as air: 27 % of the pixels");
  EXPECT_EQ(voxels({"-1024", 32767, {}}),
            "-1024 -1024 40 -1024 padding of the CT (PixelPaddingValue, 31743 HU) is taken as air: 27 % of the pixels");
  const std::string limit = testing::dicom_short(0x0028, 0x0121, 20010);  // from 19990 on
  PaddedCt range{"0", 20000, testing::dicom_short(0x0028, 0x0121, 19990)};
  EXPECT_TRUE(voxels(range).starts_with("-1024 -1024 40 -1024 padding of the CT (PixelPaddingValue, 20000 HU)"));
  range.limit = limit;
  EXPECT_TRUE(voxels(range).starts_with("-1024 -1024 40 -1024 padding of the CT (PixelPaddingValue, 20010 HU)"));
}

}  // namespace
}  // namespace trocar::io
