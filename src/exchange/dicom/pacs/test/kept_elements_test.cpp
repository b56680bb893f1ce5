// Holds the list of kept elements against DCMTK's dictionary of DICOM.
#include "dicom/pacs/detail/kept_elements.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdicent.h>
#include <dcmtk/dcmdata/dcdict.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>

#include "dicom/pacs/detail/value_treatment.h"

namespace trocar::dicom::detail {
namespace {

/// Value representation of the dictionary; empty: unknown element.
std::string dictionary_vr(std::uint32_t tag) {
  const DcmDataDictionary& dictionary = dcmDataDict.rdlock();
  const DcmDictEntry* entry =
      dictionary.findEntry(DcmTagKey(static_cast<Uint16>(tag >> 16), static_cast<Uint16>(tag & 0xffff)), nullptr);
  const std::string vr = entry == nullptr ? "" : entry->getVR().getVRName();
  dcmDataDict.rdunlock();
  return vr;
}

TEST(KeptElements, AreSortedAndPublic) {
  const auto elements = kept_elements();
  ASSERT_GT(elements.size(), 200U);
  for (std::size_t n = 1; n < elements.size(); ++n) EXPECT_LT(elements[n - 1].tag, elements[n].tag);
  for (const KeptElement& element : elements) EXPECT_EQ((element.tag >> 16) % 2, 0U) << "a private element is kept";
}

TEST(KeptElements, AreFoundByTag) {
  for (const KeptElement& element : kept_elements()) EXPECT_EQ(find_kept(element.tag), &element);
  EXPECT_EQ(find_kept(0x00100010), nullptr);
  EXPECT_EQ(find_kept(0), nullptr);
  EXPECT_EQ(find_kept(0xffffffff), nullptr);
}

TEST(KeptElements, HaveTheTreatmentOfTheirRepresentation) {
  if (!dcmDataDict.isDictionaryLoaded()) GTEST_SKIP() << "DCMTK's dictionary is not installed";
  for (const KeptElement& element : kept_elements()) {
    const std::string vr = dictionary_vr(element.tag);
    const std::string name = std::to_string(element.tag >> 16) + "," + std::to_string(element.tag & 0xffff);
    EXPECT_EQ(vr == "SQ", element.treatment == Treatment::kSequence) << name;
    EXPECT_EQ(vr == "UI", element.treatment == Treatment::kUid) << name;
    const std::array<std::string, 10> personal = {"PN", "DA", "TM", "DT", "AS", "UN", "UT", "LT", "ST", ""};
    const bool is_personal = std::ranges::find(personal, vr) != personal.end();
    EXPECT_FALSE(is_personal && element.treatment == Treatment::kKeep) << name << " " << vr;
  }
}

TEST(KeptElements, KeepNoCharactersUnchanged) {
  if (!dcmDataDict.isDictionaryLoaded()) GTEST_SKIP() << "DCMTK's dictionary is not installed";
  for (const KeptElement& element : kept_elements()) {
    const std::string vr = dictionary_vr(element.tag);
    const bool has_digits = vr == "DS" || vr == "IS";
    EXPECT_EQ(has_digits, element.treatment == Treatment::kNumber) << element.tag << " " << vr;
    EXPECT_FALSE(has_characters(vr) && element.treatment == Treatment::kKeep) << element.tag << " " << vr;
  }
}

}  // namespace
}  // namespace trocar::dicom::detail
