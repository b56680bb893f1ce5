#include "dicom/xa/xa_file.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <memory>

#include "core/files/file_system.h"
#include "core/files/folders.h"
#include "dicom/elements/dicom_file.h"

namespace trocar::dicom {
namespace {

XaImage ramp(int frames) {
  XaImage image;
  image.columns = 31;
  image.rows = 17;
  for (int n = 0; n < frames; ++n) {
    std::vector<std::uint8_t> pixels;
    for (int i = 0; i < image.columns * image.rows; ++i) pixels.push_back(static_cast<std::uint8_t>(i + 7 * n));
    image.frames.push_back(std::move(pixels));
    image.time_s.push_back(n / 15.0);
  }
  image.shutters = {2, 3, 0, 1};
  image.geometry.primary_angle_deg = -30.0;
  image.geometry.secondary_angle_deg = 12.5;
  image.exposure.area_product_mgy_cm2 = 250.0;
  image.exposure.total_mas = 4.0;
  return image;
}

std::string output_of(const std::string& line) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen((line + " 2>&1").c_str(), "r"), pclose);
  std::string text;
  std::array<char, 512> part{};
  while (pipe && fgets(part.data(), part.size(), pipe.get()) != nullptr) text += part.data();
  return text;
}

TEST(XaFile, PassesTheValidator) {
  const auto validator = find_program("dciodvfy");
  if (!validator) GTEST_SKIP() << "the program dciodvfy (Debian dicom3tools) is missing";
  const TemporaryFolder folder;
  XaImage uneven = ramp(4);
  uneven.time_s = {0.0, 0.1, 0.15, 0.4};
  int n = 0;
  for (const XaImage& image : {ramp(1), ramp(3), uneven}) {
    const auto path = folder / ("xa" + std::to_string(n++) + ".dcm");
    ASSERT_TRUE(write_xa_file(image, path).has_value());
    const std::string text = output_of("'" + validator->string() + "' '" + path.string() + "'");
    EXPECT_NE(text.find("XAImage"), std::string::npos) << "the kind of object is recognised: " << text;
    EXPECT_EQ(text.find("Error"), std::string::npos) << text;
  }
}

TEST(XaFile, HoldsPixelsGeometryAndExposure) {
  const TemporaryFolder folder;
  const XaImage image = ramp(3);
  ASSERT_TRUE(write_xa_file(image, folder / "xa.dcm").has_value());
  const auto file = DicomFile::read(folder / "xa.dcm").value().value();
  const DicomItem root = file.root();
  EXPECT_EQ(root.number(tag(0x0028, 0x0010)), 17);
  EXPECT_EQ(root.number(tag(0x0028, 0x0011)), 31);
  EXPECT_EQ(root.text(tag(0x0028, 0x0008)), "3");
  EXPECT_NEAR(root.decimals(tag(0x0018, 0x1063)).at(0), 1000.0 / 15.0, 1e-5);
  EXPECT_EQ(root.decimals(tag(0x0018, 0x1510)).at(0), -30.0);
  EXPECT_EQ(root.decimals(tag(0x0018, 0x1511)).at(0), 12.5);
  EXPECT_EQ(root.decimals(tag(0x0018, 0x115e)).at(0), 2.5) << "dGy cm²";
  EXPECT_EQ(root.text(tag(0x0018, 0x1702)), "2");
  EXPECT_EQ(root.text(tag(0x0018, 0x1704)), "29");
  EXPECT_EQ(root.text(tag(0x0010, 0x0010)), "ANONYMOUS^");
  const auto pixels = file.pixels();
  ASSERT_EQ(pixels.size(), 1U);
  std::size_t place = 0;
  for (const auto& frame : image.frames)
    for (const std::uint8_t gray : frame) ASSERT_EQ(static_cast<std::uint8_t>(pixels[0][place++]), gray);
}

TEST(XaFile, UsesNewOrGivenInstanceUids) {
  const TemporaryFolder folder;
  XaImage image = ramp(1);
  const auto instance = [&] {
    EXPECT_TRUE(write_xa_file(image, folder / "xa.dcm").has_value());
    return std::string(DicomFile::read(folder / "xa.dcm").value().value().root().text(tag(0x0008, 0x0018)));
  };
  EXPECT_NE(instance(), instance());
  image.identity.instance_uid = "1.2.3.4";
  EXPECT_EQ(instance(), "1.2.3.4");
}

TEST(XaFile, RefusesInconsistentImages) {
  const TemporaryFolder folder;
  const auto is_refused = [&](const XaImage& image) { return !write_xa_file(image, folder / "xa.dcm").has_value(); };
  EXPECT_TRUE(is_refused(XaImage{}));
  XaImage image = ramp(2);
  image.frames[1].pop_back();
  EXPECT_TRUE(is_refused(image));
  image = ramp(2);
  image.time_s = {1.0, 1.0};
  EXPECT_TRUE(is_refused(image));
  image = ramp(2);
  image.time_s.clear();
  EXPECT_TRUE(is_refused(image));
  image = ramp(1);
  image.identity.study_uid = "name of a patient";
  EXPECT_TRUE(is_refused(image));
  EXPECT_TRUE(folder.is_empty());
}

}  // namespace
}  // namespace trocar::dicom
