// Stored numbers come back with their sign, and without what lies in unused bits, from every transfer syntax.
#include "io/ct_series/detail/pixel_unpacking.h"

#include <gdcmImage.h>
#include <gdcmImageChangeTransferSyntax.h>
#include <gdcmSequenceOfFragments.h>
#include <gtest/gtest.h>

#include <cstring>

#include "core/text.h"

namespace trocar::io::detail {
namespace {

constexpr int kColumns = 16, kRows = 8;
constexpr std::size_t kCount = kColumns * kRows;

constexpr const char* kRleSyntax = "1.2.840.10008.1.2.5";
constexpr const char* kJpegLsSyntax = "1.2.840.10008.1.2.4.80";
constexpr const char* kJpeg2000Syntax = "1.2.840.10008.1.2.4.90";
constexpr const char* kJpegLosslessSyntax = "1.2.840.10008.1.2.4.70";

PixelLayout layout_of_bits(int stored, bool is_signed) {
  PixelLayout layout;
  layout.bits_stored = stored;
  layout.high_bit = stored - 1;
  layout.is_signed = is_signed;
  layout.count = kCount;
  return layout;
}

/// Numbers from the lowest to the highest that fit.
std::vector<std::int16_t> all_of(int bits, bool is_signed) {
  std::vector<std::int16_t> numbers(kCount);
  const int lowest = is_signed ? -(1 << (bits - 1)) : 0;
  const int span = (1 << bits) - 1;
  for (std::size_t n = 0; n < kCount; ++n)
    numbers[n] = static_cast<std::int16_t>(lowest + static_cast<int>(n) * span / static_cast<int>(kCount - 1));
  return numbers;
}

std::string bytes_of(const std::vector<std::int16_t>& numbers, std::uint16_t mask = 0xffff, std::uint16_t junk = 0) {
  std::string bytes;
  for (const std::int16_t number : numbers) {
    const auto word = static_cast<std::uint16_t>((static_cast<std::uint16_t>(number) & mask) | junk);
    bytes += static_cast<char>(word & 0xff);
    bytes += static_cast<char>(word >> 8);
  }
  return bytes;
}

/// Packs words with GDCM, as `stored` bits with or without sign.
std::vector<std::string> pack(const std::string& words, int stored, bool is_signed, const char* syntax) {
  gdcm::SmartPointer<gdcm::Image> image = new gdcm::Image;
  image->SetNumberOfDimensions(2);
  image->SetDimension(0, kColumns);
  image->SetDimension(1, kRows);
  image->SetPixelFormat(gdcm::PixelFormat(1, 16, static_cast<unsigned short>(stored),
                                          static_cast<unsigned short>(stored - 1), is_signed ? 1 : 0));
  image->SetPhotometricInterpretation(gdcm::PhotometricInterpretation::MONOCHROME2);
  image->SetTransferSyntax(gdcm::TransferSyntax::ExplicitVRLittleEndian);
  gdcm::DataElement pixels(gdcm::Tag(0x7fe0, 0x0010));
  pixels.SetByteValue(words.data(), gdcm::VL(static_cast<std::uint32_t>(words.size())));
  image->SetDataElement(pixels);
  gdcm::ImageChangeTransferSyntax change;
  change.SetTransferSyntax(gdcm::TransferSyntax::GetTSType(syntax));
  change.SetInput(*image);
  if (!change.Change()) return {};
  const gdcm::SequenceOfFragments* fragments = change.GetOutput().GetDataElement().GetSequenceOfFragments();
  std::vector<std::string> pieces;
  for (std::size_t n = 0; fragments != nullptr && n < fragments->GetNumberOfFragments(); ++n) {
    const gdcm::ByteValue* value = fragments->GetFragment(n).GetByteValue();
    pieces.emplace_back(value->GetPointer(), value->GetLength());
  }
  return pieces;
}

Result<std::vector<std::int16_t>> unpack(const std::vector<std::string>& pieces, const PixelLayout& layout,
                                         const char* syntax) {
  std::vector<std::int16_t> numbers(kCount);
  CompressedImage image{{}, syntax, kColumns, kRows};
  for (const std::string& piece : pieces) image.pieces.emplace_back(piece);
  TROCAR_TRY_STATUS(unpack_compressed(image, layout, std::as_writable_bytes(std::span(numbers))));
  return numbers;
}

struct Case {
  const char* syntax;
  int bits;
  bool is_signed;
};

class PixelUnpacking : public ::testing::TestWithParam<Case> {};

TEST_P(PixelUnpacking, RoundTripsNumbers) {
  const auto [syntax, bits, is_signed] = GetParam();
  const auto numbers = all_of(bits, is_signed);
  const PixelLayout layout = layout_of_bits(bits, is_signed);
  // As a scanner stores them: only the stored bits.
  const auto mask = static_cast<std::uint16_t>((1 << bits) - 1);
  for (const bool is_packed_signed : {false, is_signed}) {
    const auto pieces = pack(bytes_of(numbers, is_packed_signed ? 0xffff : mask), bits, is_packed_signed, syntax);
    ASSERT_FALSE(pieces.empty());
    const auto unpacked = unpack(pieces, layout, syntax);
    ASSERT_TRUE(unpacked) << unpacked.error().text() << " packed " << (is_packed_signed ? "signed" : "unsigned");
    EXPECT_EQ(*unpacked, numbers) << "packed " << (is_packed_signed ? "signed" : "unsigned");
  }
}

INSTANTIATE_TEST_SUITE_P(Syntaxes, PixelUnpacking,
                         ::testing::Values(Case{kRleSyntax, 12, true}, Case{kRleSyntax, 12, false},
                                           Case{kRleSyntax, 16, true}, Case{kJpegLsSyntax, 12, true},
                                           Case{kJpegLsSyntax, 12, false}, Case{kJpegLsSyntax, 16, true},
                                           Case{kJpegLsSyntax, 10, true}, Case{kJpeg2000Syntax, 12, true},
                                           Case{kJpeg2000Syntax, 12, false}, Case{kJpeg2000Syntax, 16, true},
                                           Case{kJpeg2000Syntax, 13, true}, Case{kJpegLosslessSyntax, 12, true},
                                           Case{kJpegLosslessSyntax, 12, false}, Case{kJpegLosslessSyntax, 16, true}));

TEST(PixelUnpackingOf, UncompressedNumbersIgnoresUnusedBits) {
  for (const bool is_signed : {false, true})
    for (const bool is_big_endian : {false, true}) {
      const auto numbers = all_of(12, is_signed);
      std::string bytes = bytes_of(numbers, 0x0fff, 0xa000);
      for (std::size_t n = 0; is_big_endian && n < bytes.size(); n += 2) std::swap(bytes[n], bytes[n + 1]);
      std::vector<std::int16_t> unpacked(kCount);
      unpack_plain(bytes, is_big_endian, layout_of_bits(12, is_signed), std::as_writable_bytes(std::span(unpacked)));
      EXPECT_EQ(unpacked, numbers) << is_signed << is_big_endian;
    }
}

TEST(PixelUnpackingOf, RunLengthsIgnoresUnusedBits) {
  const auto numbers = all_of(12, true);
  const auto pieces = pack(bytes_of(numbers, 0x0fff, 0x5000), 16, false, kRleSyntax);
  const auto unpacked = unpack(pieces, layout_of_bits(12, true), kRleSyntax);
  ASSERT_TRUE(unpacked) << unpacked.error().text();
  EXPECT_EQ(*unpacked, numbers);
}

TEST(PixelUnpackingOf, BitsBelowTheStoredOnesAreDropped) {
  PixelLayout layout = layout_of_bits(12, true);
  layout.high_bit = 15;
  const auto numbers = all_of(12, true);
  std::vector<std::int16_t> raised(kCount);
  for (std::size_t n = 0; n < kCount; ++n) raised[n] = static_cast<std::int16_t>(numbers[n] * 16 + 7);
  const auto unpacked = unpack(pack(bytes_of(raised), 16, false, kRleSyntax), layout, kRleSyntax);
  ASSERT_TRUE(unpacked) << unpacked.error().text();
  EXPECT_EQ(*unpacked, numbers);
}

TEST(PixelUnpackingOf, RefusesSignedJpeg2000InAnUnsignedImage) {
  const auto pieces = pack(bytes_of(all_of(12, true)), 12, true, kJpeg2000Syntax);
  const auto unpacked = unpack(pieces, layout_of_bits(12, false), kJpeg2000Syntax);
  ASSERT_FALSE(unpacked);
  EXPECT_NE(unpacked.error().what.find("PixelRepresentation"), std::string::npos) << unpacked.error().text();
}

TEST(PixelUnpackingOf, RefusesAStreamWithMoreBitsThanTheImage) {
  for (const char* syntax : {kJpegLosslessSyntax, kJpegLsSyntax, kJpeg2000Syntax}) {
    auto pieces = pack(bytes_of(all_of(16, false)), 16, false, syntax);
    ASSERT_FALSE(pieces.empty());
    const bool is_2000 = syntax == std::string_view(kJpeg2000Syntax);
    const std::size_t at =
        is_2000 ? 42 : pieces[0].find(syntax == std::string_view(kJpegLsSyntax) ? "\xff\xf7" : "\xff\xc3") + 4;
    ASSERT_EQ(pieces[0][at], is_2000 ? 15 : 16) << syntax;
    for (const char bits : {'\xff', '\x20', '\x11', '\x00'}) {
      pieces[0][at] = bits;
      if (!(is_2000 && bits == 0)) {  // 0 is one bit there
        EXPECT_FALSE(unpack(pieces, layout_of_bits(16, false), syntax)) << syntax << static_cast<int>(bits);
      }
    }
  }
}

TEST(PixelUnpackingOf, RefusesASignThatTheStreamCannotHold) {
  // The frame header of JPEG-LS: 12 bits, 8 rows, 16 columns, one component.
  const std::string stream("\xff\xd8\xff\xf7\x00\x0b\x0c\x00\x08\x00\x10\x01\x01\x11\x00", 15);
  const auto unpacked = unpack({stream}, layout_of_bits(16, true), kJpegLsSyntax);
  ASSERT_FALSE(unpacked);
  EXPECT_NE(unpacked.error().what.find("sign"), std::string::npos) << unpacked.error().text();
}

}  // namespace
}  // namespace trocar::io::detail
