#include <gtest/gtest.h>

#include "dicom/pacs/detail/anonymisation.h"

namespace trocar::dicom::detail {
namespace {

constexpr Pseudonyms::Salt kSalt{1, 2, 3};
constexpr Pseudonyms::Salt kOtherSalt{1, 2, 4};

TEST(Pseudonyms, AreEqualForEqualIds) {
  const Pseudonyms pseudonyms(kSalt);
  EXPECT_EQ(pseudonyms.uid("1.2.3"), pseudonyms.uid("1.2.3"));
  EXPECT_NE(pseudonyms.uid("1.2.3"), pseudonyms.uid("1.2.4"));
  EXPECT_EQ(pseudonyms.patient("A1"), pseudonyms.patient("A1"));
  EXPECT_NE(pseudonyms.patient("A1"), pseudonyms.patient("A2"));
}

TEST(Pseudonyms, DependOnTheSalt) {
  EXPECT_NE(Pseudonyms(kSalt).uid("1.2.3"), Pseudonyms(kOtherSalt).uid("1.2.3"));
  EXPECT_NE(Pseudonyms::with_random_salt().uid("1.2.3"), Pseudonyms::with_random_salt().uid("1.2.3"));
}

TEST(Pseudonyms, AreUids) {
  const Pseudonyms pseudonyms(kSalt);
  for (int n = 0; n < 200; ++n) {
    const std::string uid = pseudonyms.uid("1.2." + std::to_string(n));
    EXPECT_TRUE(is_uid(uid)) << uid;
    EXPECT_TRUE(uid.starts_with("2.25.")) << uid;
    EXPECT_NE(uid[5], '0') << "a component must not begin with zero: " << uid;
    EXPECT_GE(uid.size(), 40U) << "128 bits have 38 or 39 digits almost always";
  }
}

TEST(Pseudonyms, KeepStandardDicomUids) {
  const Pseudonyms pseudonyms(kSalt);
  EXPECT_EQ(pseudonyms.uid("1.2.840.10008.5.1.4.1.1.2"), "1.2.840.10008.5.1.4.1.1.2");
  EXPECT_NE(pseudonyms.uid("1.2.840.10008.MUSTERMANN"), "1.2.840.10008.MUSTERMANN") << "no UID at all";
  EXPECT_NE(pseudonyms.uid("1.2.840.100081.1"), "1.2.840.100081.1");
}

TEST(Uid, HasUpTo64DigitsAndDots) {
  EXPECT_TRUE(is_uid("1.2.840"));
  EXPECT_FALSE(is_uid(""));
  EXPECT_FALSE(is_uid("1.2/../3"));
  EXPECT_FALSE(is_uid(std::string(65, '1')));
}

}  // namespace
}  // namespace trocar::dicom::detail
