#include "dicom/elements/dicom_file.h"

#include <gtest/gtest.h>

#include "core/files/folders.h"
#include "dicom/testing/dicom_writer.h"

namespace trocar::dicom {
namespace {

using trocar::testing::dicom_element;
using trocar::testing::dicom_sequence;
using trocar::testing::Length;

class Elements : public ::testing::Test {
 protected:
  Result<std::optional<DicomFile>> read(const std::string& bytes) {
    std::ofstream(folder_ / "file.dcm", std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return DicomFile::read(folder_ / "file.dcm");
  }
  TemporaryFolder folder_;
};

TEST_F(Elements, AreFoundInNestedSequences) {
  for (const Length outer : {Length::kDefined, Length::kUndefined})
    for (const Length inner : {Length::kDefined, Length::kUndefined}) {
      const auto item = [&](const std::string& text) {
        return dicom_sequence(0x0040, 0xa043, {dicom_element(0x0008, 0x0104, "LO", text)}, inner);
      };
      const auto file =
          read(trocar::testing::dicom_file(dicom_sequence(0x0062, 0x0002, {item("one"), item("two "), ""}, outer) +
                                           dicom_element(0x0070, 0x0080, "CS", "AFTER")));
      ASSERT_TRUE(file && *file);
      const DicomItem root = (*file)->root();
      EXPECT_EQ(root.text(tag(0x0070, 0x0080)), "AFTER");
      const auto items = root.items(tag(0x0062, 0x0002));
      ASSERT_TRUE(items) << items.error().text();
      ASSERT_EQ(items->size(), 3U);
      EXPECT_EQ((*items)[0].first_item(tag(0x0040, 0xa043))->text(tag(0x0008, 0x0104)), "one");
      EXPECT_EQ((*items)[1].first_item(tag(0x0040, 0xa043))->text(tag(0x0008, 0x0104)), "two");
      EXPECT_FALSE((*items)[2].first_item(tag(0x0040, 0xa043)));
      EXPECT_TRUE(root.items(tag(0x0040, 0xa043))->empty());  // of the top level only
    }
}

TEST_F(Elements, AreNestedAtMostThirtyTwoDeep) {
  const auto nested = [](int depth) {
    std::string elements = dicom_element(0x0008, 0x0104, "LO", "deep");
    for (int n = 0; n < depth; ++n) elements = dicom_sequence(0x0040, 0xa730, {elements}, Length::kUndefined);
    return trocar::testing::dicom_file(elements);
  };
  EXPECT_TRUE(read(nested(30)));
  EXPECT_FALSE(read(nested(40)));
  EXPECT_FALSE(read(nested(20'000)));  // would end a program that recurses for each level
}

TEST_F(Elements, WithoutEndAreRefusedWithoutAllocating) {
  const std::string head = trocar::testing::dicom_file(dicom_element(0x0008, 0x0060, "CS", "SEG"));
  for (const std::uint32_t length : {0xfffffffeU, 0x7fffffffU, 1000U}) {
    const std::string sequence = trocar::testing::little_endian(0x0062, 2) + trocar::testing::little_endian(0x0002, 2) +
                                 "SQ" + std::string(2, '\0') + trocar::testing::little_endian(length, 4);
    EXPECT_FALSE(read(head + sequence + "few"));
  }
}

TEST_F(Elements, FailOnADamagedSequenceOfKnownLength) {
  const auto file = read(trocar::testing::dicom_file(dicom_element(0x0062, 0x0002, "SQ", "no items")));
  ASSERT_TRUE(file && *file);  // the elements around it are sound
  EXPECT_FALSE((*file)->root().items(tag(0x0062, 0x0002)));
  EXPECT_FALSE((*file)->root().first_item(tag(0x0062, 0x0002)));
}

TEST_F(Elements, DecimalsParseCompletelyOrNotAtAll) {
  const auto decimals = [&](const std::string& text) {
    const auto file = read(trocar::testing::dicom_file(dicom_element(0x0020, 0x0032, "DS", text)));
    return (*file)->root().decimals(tag(0x0020, 0x0032));
  };
  EXPECT_EQ(decimals("1\\-2.5\\+3e1 "), (std::vector<double>{1, -2.5, 30}));
  EXPECT_EQ(decimals(" 1 \\ 2"), (std::vector<double>{1, 2}));
  for (const char* text : {"1\\x", "1;2", "", "\\1", "nan", "1\\inf"}) EXPECT_TRUE(decimals(text).empty()) << text;
}

TEST(Utf8, CharactersAreConvertedOrReplaced) {
  EXPECT_EQ(to_utf8("Leber", ""), "Leber");
  EXPECT_EQ(to_utf8("L\xe9sion", "ISO_IR 100"), "L\xc3\xa9sion");
  EXPECT_EQ(to_utf8("L\xc3\xa9sion", "ISO_IR 192"), "L\xc3\xa9sion");
  EXPECT_EQ(to_utf8("L\xe9sion", "ISO_IR 192"), "L?sion");
  EXPECT_EQ(to_utf8("\xbb\xb1", "ISO_IR 144"), "??");
  EXPECT_EQ(to_utf8("a\nb", ""), "a b");
}

}  // namespace
}  // namespace trocar::dicom
