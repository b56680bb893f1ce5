// Anonymised objects: what is removed, what stays, and what damaged objects do.
#include "dicom/pacs/detail/rewrite_object.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>

#include "core/files/folders.h"
#include "dicom/elements/dicom_file.h"
#include "dicom/pacs/testing/made_object.h"

namespace trocar::dicom::detail {
namespace {

using testing::MadeObject;

constexpr Encoding kExplicit{false, false};
constexpr Encoding kImplicit{false, true};
constexpr Encoding kBig{true, false};
constexpr const char* kExplicitUid = "1.2.840.10008.1.2.1";

class Rewriting : public ::testing::Test {
 protected:
  /// The file with the anonymised object.
  Result<std::string> anonymised(const std::string& object, const std::string& transfer_syntax = {}) {
    TROCAR_TRY(const DataSet data_set, find_data_set(object, transfer_syntax));
    TROCAR_TRY(const ObjectSummary summary, summarize(data_set));
    path_ = folder_ / (std::to_string(++count_) + ".dcm");
    TROCAR_TRY_STATUS(write_anonymised(data_set, summary, rules_, path_));
    return bytes_of(path_);
  }

  DicomFile read_back() {
    auto file = DicomFile::read(path_);
    EXPECT_TRUE(file && *file) << path_;
    return **std::move(file);
  }

  static std::string bytes_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }

  static void expect_no_identity(const std::string& bytes) {
    for (const std::string& text : testing::identifying_texts())
      EXPECT_EQ(bytes.find(text), std::string::npos) << text << " remains";
  }

  TemporaryFolder folder_;
  std::filesystem::path path_;
  Anonymisation rules_{Pseudonyms(Pseudonyms::Salt{7}), *HarmlessWords::load(data_dir()), {}};
  int count_ = 0;
};

/// A small object with what every encoding has.
MadeObject small_object(Encoding encoding) {
  MadeObject object(encoding), image(encoding);
  image.add(0x00081150, "UI", testing::kCtClass).add(0x00081155, "UI", "1.3.6.1.4.1.99999.5");
  image.add(0x00400007, "LO", "Mustermann");
  object.add(0x00080016, "UI", testing::kCtClass).add(0x00080018, "UI", "1.3.6.1.4.1.99999.6");
  object.add(0x00080060, "CS", "CT").add_items(0x00081140, {image}).add(0x00100010, "PN", "Mustermann^Erika");
  object.add(0x0020000d, "UI", testing::kStudyUid).add(0x0020000e, "UI", testing::kCtSeriesUid);
  return object.add_number(0x00280010, 258).add(0x7fe00010, "OW", std::string("\x01\x02\x03\x04", 4));
}

TEST_F(Rewriting, RemovesTheIdentityOfImagesSegmentationsAndStructures) {
  for (const MadeObject& object : {testing::made_ct(0), testing::made_segmentation(), testing::made_structures()}) {
    bool is_there = false;
    for (const std::string& text : testing::identifying_texts())
      is_there |= object.bytes().find(text) != std::string::npos;
    EXPECT_TRUE(is_there) << "the test needs an identity to remove";
    const auto bytes = anonymised(object.file());
    ASSERT_TRUE(bytes) << bytes.error().text();
    expect_no_identity(*bytes);
  }
}

TEST_F(Rewriting, KeepsGeometryPixelsAndMeaning) {
  ASSERT_TRUE(anonymised(testing::made_ct(2).file()));
  const DicomFile file = read_back();
  const DicomItem root = file.root();
  EXPECT_EQ(root.text(0x00080060), "CT");
  EXPECT_EQ(root.text(0x00200032), "-4\\-8\\105");
  EXPECT_EQ(root.text(0x00280030), "0.5\\0.5");
  EXPECT_EQ(root.text(0x00281052), "-1000");
  EXPECT_EQ(root.text(0x0008103e), "series-01") << "the description has a name";
  EXPECT_EQ(root.number(0x00280010), testing::kColumns);
  ASSERT_EQ(file.pixels().size(), 1U);
  const std::string original = testing::made_ct(2).bytes();
  const auto pixels = file.pixels().front();
  EXPECT_TRUE(original.ends_with(std::string_view(pixels.data(), pixels.size())));
}

TEST_F(Rewriting, StatesTheAnonymisation) {
  ASSERT_TRUE(anonymised(testing::made_ct(0).file()));
  const DicomFile file = read_back();
  EXPECT_EQ(file.root().text(0x00120062), "YES");
  EXPECT_EQ(file.root().text(0x00280303), "REMOVED");
  EXPECT_EQ(file.root().text(0x00100020), rules_.pseudonyms.patient("PAT-778123"));
  EXPECT_EQ(file.root().text(0x00100010), file.root().text(0x00100020));
  EXPECT_TRUE(file.root().find(0x00080020)) << "may be empty, must not be missing";
}

TEST_F(Rewriting, KeepsReferencesConsistent) {
  ASSERT_TRUE(anonymised(testing::made_ct(1).file()));
  const DicomFile ct = read_back();
  ASSERT_TRUE(anonymised(testing::made_structures().file()));
  const DicomFile structures = read_back();
  const auto contour = structures.root().first_item(0x30060039)->first_item(0x30060040);
  ASSERT_TRUE(contour);
  EXPECT_EQ(contour->first_item(0x30060016)->text(0x00081155), ct.root().text(0x00080018));
  EXPECT_EQ(structures.root().first_item(0x30060020)->text(0x30060024), ct.root().text(0x00200052));
  EXPECT_EQ(structures.root().text(0x0020000d), ct.root().text(0x0020000d));
  EXPECT_EQ(structures.root().first_item(0x30060020)->text(0x30060026), "structure-02");
  EXPECT_EQ(structures.root().text(0x30060002), "structure-01") << "a label must not become empty";
}

TEST_F(Rewriting, ReadsEveryEncoding) {
  const std::vector<std::pair<Encoding, std::string>> encodings = {
      {kExplicit, kExplicitUid}, {kImplicit, "1.2.840.10008.1.2"}, {kBig, "1.2.840.10008.1.2.2"}};
  for (const auto& [encoding, uid] : encodings) {
    const auto bytes = anonymised(small_object(encoding).file(uid));
    ASSERT_TRUE(bytes) << uid << " " << bytes.error().text();
    expect_no_identity(*bytes);
    const DicomFile file = read_back();
    EXPECT_EQ(file.transfer_syntax(), uid);
    EXPECT_EQ(file.root().number(0x00280010), 258) << uid;
    const auto image = file.root().first_item(0x00081140);
    ASSERT_TRUE(image) << uid;
    EXPECT_EQ(image->text(0x00081155), rules_.pseudonyms.uid("1.3.6.1.4.1.99999.5")) << uid;
    EXPECT_EQ(image->text(0x00081150), testing::kCtClass) << uid;
  }
}

TEST_F(Rewriting, ReadsADataSetWithoutMetaInformation) {
  const auto whole = anonymised(small_object(kExplicit).file());
  const auto bare = anonymised(small_object(kExplicit).bytes(), kExplicitUid);
  ASSERT_TRUE(whole && bare);
  EXPECT_EQ(*whole, *bare) << "both protocols give the same file";
}

TEST_F(Rewriting, TreatsSequencesOfUnknownRepresentation) {
  MadeObject object = small_object(kExplicit), image(kImplicit);
  image.add(0x00081155, "UI", "1.3.6.1.4.1.99999.5").add(0x00100010, "PN", "Mustermann");
  object.add_items(0x00081140, {image}, "UN");
  const auto bytes = anonymised(object.file());
  ASSERT_TRUE(bytes) << bytes.error().text();
  expect_no_identity(*bytes);
  EXPECT_EQ(read_back().root().first_item(0x00081140)->text(0x00081155), rules_.pseudonyms.uid("1.3.6.1.4.1.99999.5"));
}

TEST_F(Rewriting, CompressedPixelsStay) {
  MadeObject object = small_object(kExplicit);
  const std::string begin("\xe0\x7f\x10\x00OB\0\0\xff\xff\xff\xff", 12);
  const std::string table("\xfe\xff\x00\xe0\0\0\0\0", 8), fragment("\xfe\xff\x00\xe0\4\0\0\0JPEG", 12);
  const std::string end("\xfe\xff\xdd\xe0\0\0\0\0", 8);
  object.add_raw(0x7fe00010, begin + table + fragment + end);
  const auto bytes = anonymised(object.file("1.2.840.10008.1.2.4.90"));
  ASSERT_TRUE(bytes) << bytes.error().text();
  EXPECT_TRUE(bytes->ends_with(begin + table + fragment + end));
}

/// The same text in several character sets: no byte of a name stays in any of them.
TEST_F(Rewriting, NamesAreRemovedInEveryCharacterSet) {
  const std::vector<std::pair<std::string, std::string>> names = {{"", "MUELLER"},
                                                                  {"ISO_IR 100", "M\xdcLLER"},
                                                                  {"ISO_IR 101", "M\xdcLLER"},
                                                                  {"ISO_IR 109", "M\xdcLLER"},
                                                                  {"ISO_IR 110", "M\xdcLLER"},
                                                                  {"ISO_IR 126", "\xd0\xc1\xd0\xc1\xc4"},
                                                                  {"ISO_IR 127", "\xe2\xc8\xc7\xe6\xea"},
                                                                  {"ISO_IR 138", "\xf9\xf8\xe5\xef"},
                                                                  {"ISO_IR 144", "\xb8\xb2\xb0\xbd\xbe\xb2"},
                                                                  {"ISO_IR 148",
                                                                   "\xc7"
                                                                   "ELIK"},
                                                                  {"ISO_IR 166", "\xca\xc1\xaa\xd2\xc2"},
                                                                  {"ISO_IR 192", "\xd0\x98\xd0\x92\xd0\x90\xd0\x9d"},
                                                                  {"GB18030", "\xcd\xf5\xd0\xa1\xb6\xab"},
                                                                  {"\\ISO 2022 IR 87", "\x1b$B;3ED\x1b(B"},
                                                                  {"\\ISO 2022 IR 149", "\x1b$)C\xfb\xf3\xd1\xce"},
                                                                  {"UNKNOWN", "M\xdcLLER"}};
  for (const auto& [character_set, name] : names) {
    MadeObject object = small_object(kExplicit), segment, code;
    code.add(0x00080100, "SH", name).add(0x00080102, "SH", "99" + name.substr(0, 2)).add(0x00080104, "LO", name);
    segment.add(0x00620005, "LO", "liver " + name).add_items(0x0062000f, {code}).add(0x00620009, "LO", name);
    object.add(0x00080005, "CS", character_set)
        .add(0x0008103e, "LO", "CT " + name + " 5mm")
        .add(0x00100010, "PN", name);
    object.add(0x00080070, "LO", name)
        .add(0x00180015, "CS", name)
        .add(0x00181210, "SH", name)
        .add(0x00180050, "DS", name);
    object.add(0x00209056, "SH", name).add(0x00700080, "CS", name).add_items(0x00620002, {segment});
    const auto bytes = anonymised(object.file());
    ASSERT_TRUE(bytes) << bytes.error().text();
    EXPECT_EQ(bytes->find(name), std::string::npos) << character_set;
    const DicomFile file = read_back();
    EXPECT_TRUE(file.root().text(0x0008103e).starts_with("series-")) << character_set;
    EXPECT_TRUE(file.root().first_item(0x00620002)->text(0x00620005).starts_with("structure-")) << character_set;
    EXPECT_EQ(file.root().text(0x00180015), "OTHER");
  }
}

TEST_F(Rewriting, ReadsTextsInTheCharacterSetOfTheirItem) {
  MadeObject object = small_object(kExplicit), segment, other;
  segment.add(0x00620005, "LO", "ven\xf6s");
  other.add(0x00080005, "CS", "ISO_IR 192").add(0x00620005, "LO", "ven\xc3\xb6s");
  object.add(0x00080005, "CS", "ISO_IR 100").add_items(0x00620002, {segment, other});
  ASSERT_TRUE(anonymised(object.file()));
  const DicomFile file = read_back();
  const auto segments = file.root().items(0x00620002);
  ASSERT_EQ(segments->size(), 2U);
  EXPECT_EQ((*segments)[0].text(0x00620005), "ven\xf6s");
  EXPECT_EQ((*segments)[1].text(0x00620005), "ven\xc3\xb6s");
}

TEST_F(Rewriting, RemovesTextFromNumericElements) {
  MadeObject object = small_object(kExplicit);
  object.add(0x00280106, "LO", "MUELLER");
  const auto bytes = anonymised(object.file());
  ASSERT_TRUE(bytes);
  EXPECT_EQ(bytes->find("MUELLER"), std::string::npos);
  EXPECT_FALSE(read_back().root().find(0x00280106));
}

TEST_F(Rewriting, RemovesTextOfUnknownRepresentation) {
  const std::vector<std::pair<Encoding, std::string>> encodings = {{kExplicit, kExplicitUid},
                                                                   {kImplicit, "1.2.840.10008.1.2"}};
  for (const auto& [encoding, uid] : encodings) {
    MadeObject named(encoding);
    named.add(0x00080016, "UI", testing::kCtClass).add(0x00080018, "UI", "1.3.6.1.4.1.99999.6");
    named.add(0x00189305, "UN", std::string("\0\0\0\0\0\0\xe0\x3f", 8)).add(0x00189306, "UN", "Mustermann");
    named.add(0x0020000d, "UI", testing::kStudyUid).add(0x0020000e, "UI", testing::kCtSeriesUid);
    named.add(0x00200011, "IS", "17031945").add_number(0x00280010, 258);
    named.add(0x7fe00010, "OW", std::string("\x01\x02\x03\x04", 4));
    const auto bytes = anonymised(named.file(uid));
    ASSERT_TRUE(bytes) << bytes.error().text();
    EXPECT_EQ(bytes->find("Mustermann"), std::string::npos);
    EXPECT_EQ(bytes->find("17031945"), std::string::npos);
    EXPECT_NE(bytes->find(std::string("\0\0\0\0\0\0\xe0\x3f", 8)), std::string::npos) << "RevolutionTime of 0.5 s";
  }
}

TEST_F(Rewriting, ElementsBehindThePixelsAreRemoved) {
  MadeObject object = testing::made_ct(0);
  object.add(0xfffcfffc, "OB", "Mustermann");
  const auto bytes = anonymised(object.file());
  ASSERT_TRUE(bytes);
  expect_no_identity(*bytes);
}

TEST_F(Rewriting, RefusesOrAnonymisesEveryTruncation) {
  const std::string whole = testing::made_structures().file();
  int refused = 0;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto bytes = anonymised(whole.substr(0, size));
    if (bytes) {
      expect_no_identity(*bytes);
    } else {
      EXPECT_FALSE(bytes.error().what.empty());
      ++refused;
    }
  }
  EXPECT_GT(refused, static_cast<int>(whole.size() / 2));
}

TEST_F(Rewriting, ChangedBytesNeverCrash) {
  const std::string whole = small_object(kExplicit).file();
  for (std::size_t at = 128; at < whole.size(); ++at) {
    for (const int value : {0x00, 0xff, 0x80}) {
      std::string changed = whole;
      changed[at] = static_cast<char>(value);
      const auto bytes = anonymised(changed);
      EXPECT_TRUE(bytes || !bytes.error().what.empty());
    }
  }
}

TEST_F(Rewriting, DeepNestingIsRefused) {
  MadeObject inner;
  inner.add(0x00081155, "UI", "1.2.3");
  for (int depth = 0; depth < 40; ++depth) {
    MadeObject outer;
    outer.add_items(0x00081140, {inner});
    inner = outer;
  }
  MadeObject object = small_object(kExplicit);
  object.add_raw(0x00081140, inner.bytes());
  const auto bytes = anonymised(object.file());
  ASSERT_FALSE(bytes);
  EXPECT_NE(bytes.error().what.find("damaged sequence"), std::string::npos) << bytes.error().text();
}

TEST(DataSet, RejectsNonDicomBytes) {
  for (const std::string& bytes : {std::string(), std::string("<html>"), std::string(4096, 'x')}) {
    const auto found = find_data_set(bytes, {});
    ASSERT_FALSE(found);
    EXPECT_NE(found.error().what.find("not DICOM"), std::string::npos) << found.error().text();
  }
  EXPECT_FALSE(find_data_set(testing::made_ct(0).file("1.2.840.10008.1.2.1.99"), {})) << "deflated";
}

TEST(DataSet, DetectsImagesThatMayShowText) {
  const auto may_show = [](MadeObject object) {
    return summarize(*find_data_set(object.bytes(), kExplicitUid))->may_show_text;
  };
  EXPECT_FALSE(may_show(small_object(kExplicit)));
  EXPECT_TRUE(may_show(small_object(kExplicit).add(0x00280301, "CS", "YES")));
  EXPECT_TRUE(may_show(small_object(kExplicit).add(0x00080060, "CS", "US")));
  EXPECT_FALSE(may_show(small_object(kExplicit).add(0x00080060, "CS", "US").add(0x00280301, "CS", "NO")));
}

}  // namespace
}  // namespace trocar::dicom::detail
