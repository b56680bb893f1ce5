#include "png/png_file.h"

#include <gtest/gtest.h>
#include <png.h>

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "core/files/folders.h"

namespace trocar::png {
namespace {

TEST(Png, DecodesToTheSamePixels) {
  image::RgbImage image(7, 3);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 7; ++column)
      image.at(column, row) = {static_cast<std::uint8_t>(30 * column), static_cast<std::uint8_t>(80 * row), 200};
  const std::string bytes = encode_png(image);

  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()), 0);
  EXPECT_EQ(png.width, 7U);
  EXPECT_EQ(png.height, 3U);
  png.format = PNG_FORMAT_RGB;
  std::vector<image::Rgb> pixels(21);
  ASSERT_NE(png_image_finish_read(&png, nullptr, pixels.data(), 0, nullptr), 0);
  EXPECT_EQ(pixels, image.pixels);
}

TEST(Png, IsWrittenAsAFile) {
  TemporaryFolder folder;
  const image::RgbImage image(2, 2, {1, 2, 3});
  ASSERT_TRUE(write_png(image, folder / "a.png"));
  std::ifstream file(folder / "a.png", std::ios::binary);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), encode_png(image));
}

}  // namespace
}  // namespace trocar::png
