// Lossless JPEG of all predictors, packed here and unpacked by our code and by GDCM; and damaged streams.
#include "io/ct_series/detail/lossless_jpeg.h"

#include <gdcmImage.h>
#include <gdcmSequenceOfFragments.h>
#include <gtest/gtest.h>

#include <array>
#include <random>
#include <string>
#include <vector>

#include "io/ct_series/detail/jpeg_segments.h"

namespace trocar::io::detail {
namespace {

constexpr int kWide = 19, kHigh = 12;
using Numbers = std::vector<std::uint16_t>;

/// Smooth and rough numbers of these bits, with the largest steps that there are.
Numbers some_numbers(int bits) {
  std::mt19937 random(7);
  Numbers numbers(kWide * kHigh);
  for (std::size_t n = 0; n < numbers.size(); ++n) {
    const auto number = n < numbers.size() / 2 ? static_cast<std::uint32_t>(3 * n + random() % 4) : random();
    numbers[n] = static_cast<std::uint16_t>(number & ((1U << bits) - 1));
  }
  numbers[40] = 0;
  numbers[41] = static_cast<std::uint16_t>((1U << bits) - 1);
  return numbers;
}

std::string segment(std::uint8_t marker, const std::string& content) {
  const std::size_t length = content.size() + 2;
  return std::string{'\xff', static_cast<char>(marker), static_cast<char>(length >> 8),
                     static_cast<char>(length & 0xff)} +
         content;
}

/// Writes bits, a 0 after each byte FF.
class BitWriter {
 public:
  void put(std::uint32_t bits, int count) {
    for (int n = count - 1; n >= 0; --n) {
      byte_ = byte_ << 1 | (bits >> n & 1);
      if (++used_ == 8) flush_byte();
    }
  }
  void fill_up() {
    while (used_ != 0) put(1, 1);
  }
  std::string bytes;

 private:
  void flush_byte() {
    bytes += static_cast<char>(byte_ & 0xff);
    if ((byte_ & 0xff) == 0xff) bytes += '\0';
    used_ = 0;
    byte_ = 0;
  }
  std::uint32_t byte_ = 0;
  int used_ = 0;
};

int prediction_of(int predictor, int a, int b, int c) {
  const std::array<int, 8> all{0, a, b, c, a + b - c, a + ((b - c) >> 1), b + ((a - c) >> 1), (a + b) >> 1};
  return all[static_cast<std::size_t>(predictor) % all.size()];  // 8 is no predictor: written, to be refused
}

struct Packing {
  int bits = 16;
  int predictor = 1;
  int restart_rows = 0;
  std::string remark;  ///< Between the frame header and the tables.
};

/// Codes of five bits for all kinds of differences, in the order of their lengths.
std::string pack_lossless(const Numbers& numbers, const Packing& packing) {
  std::string tables(1 + 16, '\0');
  tables[5] = 17;
  for (char kind = 0; kind <= 16; ++kind) tables += kind;
  std::string stream = "\xff\xd8";
  stream += segment(0xc3, std::string{static_cast<char>(packing.bits), 0, kHigh, 0, kWide, 1, 1, '\x11', 0});
  stream += packing.remark;
  stream += segment(0xc4, tables);
  const int interval = packing.restart_rows * kWide;
  if (interval > 0)
    stream += segment(0xdd, std::string{static_cast<char>(interval >> 8), static_cast<char>(interval & 0xff)});
  stream += segment(0xda, std::string{1, 1, 0, static_cast<char>(packing.predictor), 0, 0});
  BitWriter out;
  const auto at = [&](int i, int j) { return static_cast<int>(numbers[static_cast<std::size_t>(j * kWide + i)]); };
  for (int j = 0; j < kHigh; ++j) {
    const bool is_first = j == 0 || (packing.restart_rows > 0 && j % packing.restart_rows == 0);
    if (is_first && j > 0) {
      out.fill_up();
      out.bytes += '\xff';
      out.bytes += static_cast<char>(0xd0 + (j / packing.restart_rows - 1) % 8);
    }
    for (int i = 0; i < kWide; ++i) {
      const int predicted = i == 0     ? (is_first ? 1 << (packing.bits - 1) : at(0, j - 1))
                            : is_first ? at(i - 1, j)
                                       : prediction_of(packing.predictor, at(i - 1, j), at(i, j - 1), at(i - 1, j - 1));
      int difference = (at(i, j) - predicted) & 0xffff;
      if (difference > 0x8000) difference -= 0x10000;
      int kind = 0;
      while (std::abs(difference) >> kind != 0) ++kind;
      out.put(static_cast<std::uint32_t>(kind), 5);
      if (kind < 16) out.put(static_cast<std::uint32_t>(difference > 0 ? difference : difference - 1), kind);
    }
  }
  out.fill_up();
  return stream + out.bytes + "\xff\xd9";
}

/// Empty if it cannot be unpacked.
Numbers unpack_lossless(const std::string& stream) {
  Numbers numbers(kWide * kHigh);
  if (!unpack_lossless_jpeg(stream, kWide, kHigh, 2, std::as_writable_bytes(std::span(numbers)))) numbers.clear();
  return numbers;
}

Numbers unpack_by_gdcm(const std::string& stream, int bits) {
  gdcm::Image image;
  image.SetNumberOfDimensions(2);
  image.SetDimension(0, kWide);
  image.SetDimension(1, kHigh);
  image.SetPixelFormat(
      gdcm::PixelFormat(1, 16, static_cast<unsigned short>(bits), static_cast<unsigned short>(bits - 1), 0));
  image.SetPhotometricInterpretation(gdcm::PhotometricInterpretation::MONOCHROME2);
  image.SetTransferSyntax(gdcm::TransferSyntax::JPEGLosslessProcess14);
  gdcm::SmartPointer<gdcm::SequenceOfFragments> fragments = new gdcm::SequenceOfFragments;
  gdcm::Fragment fragment;
  fragment.SetByteValue(stream.data(), gdcm::VL(static_cast<std::uint32_t>(stream.size())));
  fragments->AddFragment(fragment);
  gdcm::DataElement pixels(gdcm::Tag(0x7fe0, 0x0010));
  pixels.SetVR(gdcm::VR::OB);
  pixels.SetValue(*fragments);
  image.SetDataElement(pixels);
  Numbers numbers(kWide * kHigh);
  if (!image.GetBuffer(reinterpret_cast<char*>(numbers.data()))) numbers.clear();
  return numbers;
}

TEST(LosslessJpeg, UnpacksAllPredictorsLikeGdcm) {
  for (const int bits : {16, 12, 10})
    for (int predictor = 1; predictor <= 7; ++predictor)
      for (const int restart_rows : {0, 1, 3}) {
        const Numbers numbers = some_numbers(bits);
        const std::string stream = pack_lossless(numbers, {bits, predictor, restart_rows, {}});
        EXPECT_EQ(unpack_lossless(stream), numbers) << bits << " bits, " << predictor << ", " << restart_rows;
        EXPECT_EQ(unpack_by_gdcm(stream, bits), numbers) << bits << " bits, " << predictor << ", " << restart_rows;
      }
}

TEST(LosslessJpeg, AllowsCommentsButNoStrayBytesBetweenSegments) {
  const Numbers numbers = some_numbers(12);
  const std::string remarks = segment(0xe0, std::string("JFIF\0\1\2\0\0\1\0\1\0\0", 14)) + segment(0xfe, "a comment");
  EXPECT_EQ(unpack_lossless(pack_lossless(numbers, {12, 4, 0, remarks})), numbers);
  EXPECT_TRUE(unpack_lossless(pack_lossless(numbers, {12, 4, 0, "xyz"})).empty());  // GDCM ends the program
  const std::string again = segment(0xc3, std::string{12, 0, kHigh, 0, kWide, 1, 1, '\x11', 0});
  EXPECT_TRUE(unpack_lossless(pack_lossless(numbers, {12, 4, 0, again})).empty());
  EXPECT_TRUE(unpack_lossless(pack_lossless(numbers, {12, 0, 0, {}})).empty());
  EXPECT_TRUE(unpack_lossless(pack_lossless(numbers, {12, 8, 0, {}})).empty());
}

TEST(LosslessJpeg, RefusesATruncatedOrTooLongStream) {
  const Numbers numbers = some_numbers(12);
  for (const int restart_rows : {0, 3}) {
    const std::string whole = pack_lossless(numbers, {12, 1, restart_rows, {}});
    for (std::size_t size = 0; size + 2 < whole.size(); ++size)
      EXPECT_TRUE(unpack_lossless(whole.substr(0, size)).empty()) << size;
    EXPECT_EQ(unpack_lossless(whole.substr(0, whole.size() - 2)), numbers);  // without the end mark
    EXPECT_TRUE(unpack_lossless(whole.substr(0, whole.size() - 2) + "abcd").empty());
  }
  // Without one of its restart markers, or with another number in it.
  std::string restarts = pack_lossless(numbers, {12, 1, 3, {}});
  const std::size_t at = restarts.find("\xff\xd1");
  ASSERT_NE(at, std::string::npos);
  restarts[at + 1] = '\xd2';
  EXPECT_TRUE(unpack_lossless(restarts).empty());
  EXPECT_TRUE(unpack_lossless(restarts.erase(at, 2)).empty());
}

TEST(LosslessJpeg, RefusesACodeOutsideTheTable) {
  std::string stream = pack_lossless(some_numbers(12), {12, 1, 0, {}});
  const std::size_t coded = stream.find("\xff\xda") + 10;
  ASSERT_EQ(unpack_lossless(stream).size(), static_cast<std::size_t>(kWide * kHigh));
  stream[coded] = '\xf8';  // 11111, of seventeen codes of five bits
  EXPECT_TRUE(unpack_lossless(stream).empty());
}

/// A baseline stream of a single block.
std::string small_baseline(const std::string& remark, const std::string& between = {}) {
  std::string quantisation(1, '\0');
  quantisation += std::string(64, '\1');
  std::string codes(1 + 16, '\0');
  codes[1] = 1;
  const std::string dc = codes + '\0';
  codes[0] = '\x10';
  return "\xff\xd8" + remark + segment(0xdb, quantisation) +
         segment(0xc0, std::string{8, 0, 8, 0, 8, 1, 1, '\x11', 0}) + between + segment(0xc4, dc) +
         segment(0xc4, codes + '\0') + segment(0xda, std::string{1, 1, 0, 0, 63, 0}) + "\x3f\xff\xd9";
}

TEST(PlainJpeg, KeepsTheImageAndDropsComments) {
  const auto text_of = [](const std::string& stream) {
    const auto plain = plain_jpeg(stream);
    return plain ? std::string(plain->begin(), plain->end()) : std::string("refused");
  };
  const std::string plain = small_baseline({});
  EXPECT_EQ(text_of(plain), plain);
  EXPECT_EQ(text_of(small_baseline(segment(0xee, "Adobe") + segment(0xfe, "x") + "\xff")), plain);
  EXPECT_EQ(text_of(plain + '\0'), plain);
  EXPECT_EQ(text_of(small_baseline("x")), "refused");
  EXPECT_EQ(text_of(small_baseline({}, segment(0xc1, std::string{8, 0, 8, 0, 8, 1, 1, '\x11', 0}))), "refused");
  EXPECT_EQ(text_of(small_baseline({}, segment(0xcc, "ab"))), "refused") << "arithmetic codes";
  EXPECT_EQ(text_of(small_baseline({}, "\xff\xd9")), "refused") << "no scan";
  EXPECT_EQ(text_of(plain.substr(0, plain.size() - 2) + plain.substr(plain.find("\xff\xda"))), "refused")
      << "a second scan";
  for (std::size_t size = 0; size < plain.size(); ++size) EXPECT_EQ(text_of(plain.substr(0, size)), "refused") << size;
}

}  // namespace
}  // namespace trocar::io::detail
