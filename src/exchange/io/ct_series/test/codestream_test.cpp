#include <gtest/gtest.h>

#include <string>

#include "io/ct_series/detail/jpeg_segments.h"

namespace trocar::testing {
namespace {

using io::detail::codestream_size;
using namespace std::string_literals;

/// SOC and SIZ of JPEG 2000: 640 x 480 in a canvas that starts at (10, 20), three components, the first of 12 signed
/// bits.
std::string jpeg2000_start() {
  return "\xff\x4f\xff\x51\x00\x2f\x00\x00"
         "\x00\x00\x02\x8a\x00\x00\x01\xf4"
         "\x00\x00\x00\x0a\x00\x00\x00\x14"
         "\x00\x00\x02\x80\x00\x00\x01\xe0"
         "\x00\x00\x00\x00\x00\x00\x00\x00"
         "\x00\x03\x8b"s;
}

/// A comment, a table, a fill byte, then the frame header of 512 rows, 256 columns and one component.
std::string jpeg_start(char frame) {
  std::string bytes = "\xff\xd8\xff\xfe\x00\x04\x61\x62\xff\xc4\x00\x03\x00\xff\xff"s;
  bytes.push_back(frame);
  return bytes.append("\x00\x0b\x0c\x02\x00\x01\x00\x01"s);
}

TEST(Codestream, GivesTheSizeOfJpeg2000) {
  const auto size = codestream_size(jpeg2000_start());
  ASSERT_TRUE(size);
  EXPECT_EQ(size->columns, 640);
  EXPECT_EQ(size->rows, 480);
  EXPECT_EQ(size->components, 3);
  EXPECT_EQ(size->bits, 12);
  EXPECT_TRUE(size->is_signed);
}

TEST(Codestream, GivesTheSizeOfJpegAndJpegLs) {
  for (const char frame : {'\xc0', '\xc1', '\xc3', '\xf7'}) {
    const auto size = codestream_size(jpeg_start(frame));
    ASSERT_TRUE(size);
    EXPECT_EQ(size->columns, 256);
    EXPECT_EQ(size->rows, 512);
    EXPECT_EQ(size->components, 1);
    EXPECT_EQ(size->bits, 12);
    EXPECT_FALSE(size->is_signed);
  }
}

TEST(Codestream, ReturnsNothingForACutOrForeignStream) {
  for (const std::string& whole : {jpeg2000_start(), jpeg_start('\xc3')})
    for (std::size_t length = 0; length < whole.size(); ++length)
      EXPECT_FALSE(codestream_size(std::string_view(whole).substr(0, length))) << length;
  EXPECT_FALSE(codestream_size("\xff\xd8\xff\xda\x00\x08\x01\x01\x00\x00\x3f\x00"s)) << "a scan without a frame";
  EXPECT_FALSE(codestream_size("\x89PNG\r\n\x1a\n"s));
}

}  // namespace
}  // namespace trocar::testing
