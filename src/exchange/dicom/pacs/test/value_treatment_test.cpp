// Every treatment of a value: what stays, what is replaced, what is emptied.
#include "dicom/pacs/detail/value_treatment.h"

#include <gtest/gtest.h>

#include "core/files/folders.h"

namespace trocar::dicom::detail {
namespace {

class Treating : public ::testing::Test {
 protected:
  std::string treated(std::string_view value, Treatment treatment, const ValueContext& context = {}) {
    return std::string(treat_(value, treatment, context));
  }

  Anonymisation rules_{Pseudonyms(Pseudonyms::Salt{7}), *HarmlessWords::load(data_dir()), {}};
  ValueTreatment treat_{rules_};
};

TEST_F(Treating, GivesEqualTextsEqualCodes) {
  EXPECT_EQ(treated("CT M\xdcLLER 5mm ", Treatment::kSeries), "series-01");
  EXPECT_EQ(treated("CT Mueller 5mm", Treatment::kSeries), "series-02");
  EXPECT_EQ(treated("CT M\xdcLLER 5mm", Treatment::kSeries), "series-01");
  EXPECT_EQ(treated("CT 5mm", Treatment::kSeries), "CT 5mm");
  EXPECT_EQ(treated("Mueller", Treatment::kStructure), "structure-01");
  EXPECT_EQ(treated("Mueller", Treatment::kText), "text-01");
  EXPECT_EQ(rules_.codes.count(TextCodes::Kind::kSeries), 2U);
  EXPECT_EQ(rules_.codes.count(TextCodes::Kind::kStructure), 1U);
  EXPECT_EQ(rules_.codes.count(TextCodes::Kind::kOther), 1U);
}

TEST_F(Treating, ChecksEveryValueOfAText) {
  EXPECT_EQ(treated("BONE\\Mueller\\LUNG ", Treatment::kText), "BONE\\text-01\\LUNG");
  EXPECT_EQ(treated("", Treatment::kStructure), "");
  EXPECT_EQ(treated("  ", Treatment::kStructure), "");
}

TEST_F(Treating, KeepsOnlyDefinedTermsAsCodedValues) {
  EXPECT_EQ(treated("ORIGINAL\\PRIMARY\\AXIAL\\MUELLER", Treatment::kCode), "ORIGINAL\\PRIMARY\\AXIAL\\OTHER");
  EXPECT_EQ(treated("DERIVED\\\\X", Treatment::kCode), "DERIVED\\\\X");
  EXPECT_EQ(rules_.codes.count(TextCodes::Kind::kOther), 1U);
}

TEST_F(Treating, KeepsOnlyNumbersInNumericElements) {
  EXPECT_EQ(treated("-4\\-8.5\\1e2 ", Treatment::kNumber), "-4\\-8.5\\1e2 ");
  EXPECT_EQ(treated(std::string_view("12\0", 3), Treatment::kNumber), std::string("12\0", 3));
  EXPECT_EQ(treated("Mueller", Treatment::kNumber), "");
  EXPECT_EQ(treated("17/03/1945", Treatment::kNumber), "");
  for (const char* number : {"0.976562\\0.976562", "-1024", "1e-3", "+4.5", "4,8\\4,8", "123456.789", "120000", "",
                             " 601 ", "999999", "-123.4567890123", "0"})
    EXPECT_EQ(treated(number, Treatment::kNumber), number);
  for (const char* date : {"17031945", "19450317", "170345", "031745", "450317", "17.03.1945", "17-03-1945",
                           "1\\170345", "17031945.0", "4711001", "17 03 45", "1e", "."})
    EXPECT_EQ(treated(date, Treatment::kNumber), "") << date;
}

std::string bytes_of_doubles(const std::vector<double>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double)};
}

TEST(TextInNumbers, IsDistinguishedFromNumbers) {
  for (const char* text : {"Mueller x", "Mueller^Hans", "17031945", "17.03.45", "O'Brien "}) {
    EXPECT_TRUE(is_text(text, "UN")) << text;
    EXPECT_TRUE(is_text(text, "")) << text << ": implicit VR";
    EXPECT_TRUE(is_text(text, "FD")) << text;
  }
  EXPECT_TRUE(is_text(std::string_view("Mueller\0", 8), "UN"));
  EXPECT_TRUE(is_text("M\xfcller Hans", "UN"));
  for (double number = 1e-4; number < 65'000; number *= 1.0003) {
    EXPECT_FALSE(is_text(bytes_of_doubles({number}), "UN")) << number;
    EXPECT_FALSE(is_text(bytes_of_doubles({number, -number}), "")) << number;
  }
  EXPECT_FALSE(is_text(std::string("\0\1\0\0\0\0\0\1", 8), "US"));
  EXPECT_FALSE(is_text("AB", "US"));
  EXPECT_FALSE(is_text("", "UN"));
}

TEST_F(Treating, KeepsOnlyCodesOfPublicSchemes) {
  const auto code = [&](std::string_view value, std::string_view scheme) {
    ValueContext context;
    context.coding_scheme = scheme;
    return treated(value, Treatment::kCodeValue, context);
  };
  EXPECT_EQ(code("10200004", "SCT"), "10200004");
  EXPECT_EQ(code("T-D4034", "SRT"), "T-D4034");
  EXPECT_EQ(code("RID58 ", "RADLEX"), "RID58");
  EXPECT_EQ(code("[hnsf'U]", "UCUM"), "[hnsf'U]");
  EXPECT_EQ(code("10200004", "99LOCAL"), "text-01") << "can be the number of a patient";
  EXPECT_EQ(code("10200004", ""), "text-01");
  EXPECT_EQ(code("MUELLER", "SCT"), "text-02");
  EXPECT_EQ(treated("SCT ", Treatment::kCodingScheme), "SCT ");
  EXPECT_EQ(treated("99MUELLER", Treatment::kCodingScheme), "99REPLACED");
}

TEST_F(Treating, KeepsOnlyDicomCharacterSets) {
  for (const char* known :
       {"ISO_IR 100", "ISO_IR 101", "ISO_IR 109", "ISO_IR 110", "ISO_IR 126", "ISO_IR 127", "ISO_IR 138", "ISO_IR 144",
        "ISO_IR 148", "ISO_IR 166", "ISO_IR 192", "GB18030", "\\ISO 2022 IR 87", ""})
    EXPECT_EQ(treated(known, Treatment::kCharacters), known);
  EXPECT_EQ(treated("MUELLER", Treatment::kCharacters), "");
}

TEST_F(Treating, ReplacesDatesAndNamesByFixedValues) {
  EXPECT_EQ(treated("19450317", Treatment::kDate), "20000101");
  EXPECT_EQ(treated("101530", Treatment::kTime), "000000");
  EXPECT_EQ(treated("Mueller", Treatment::kEmpty), "");
  EXPECT_EQ(treated("1.2.840.10008.1.2\\Mueller", Treatment::kUid).find("Mueller"), std::string::npos);
}

TEST(TextCodes, AreBounded) {
  TextCodes codes;
  for (int n = 0; n < 20'000; ++n) {
    codes.code_of(TextCodes::Kind::kSeries, "text " + std::to_string(n));
    codes.add_removed(std::to_string(n));
  }
  EXPECT_LE(codes.count(TextCodes::Kind::kSeries), 10'000U);
  EXPECT_EQ(codes.code_of(TextCodes::Kind::kSeries, "text 0"), "series-01");
  EXPECT_EQ(codes.code_of(TextCodes::Kind::kSeries, "one more"), "series-more");
}

}  // namespace
}  // namespace trocar::dicom::detail
