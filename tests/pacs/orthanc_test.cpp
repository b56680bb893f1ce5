// The command `trocar patient fetch` against Orthanc, by all protocols.
#include "pacs/orthanc.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "cli/program.h"
#include "dicom/elements/dicom_file.h"
#include "dicom/pacs/testing/made_object.h"
#include "io/image/image_file.h"

namespace trocar::pacs_test {
namespace {
namespace fs = std::filesystem;
namespace made = dicom::testing;

using cli_test::Outcome;
using cli_test::trocar;

/// Every file below a folder, sorted.
std::vector<fs::path> files_below(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

/// The elements of a file in one text, with names of UIDs and patients by their first appearance in `names`: equal for
/// files that differ only in the salt of their pseudonyms.
std::string described(const fs::path& path, std::vector<std::string>& names) {
  const auto file = dicom::DicomFile::read(path);
  if (!file || !*file) return "not DICOM: " + path.string();
  std::string text = (*file)->transfer_syntax();
  dicom::ElementWalk walk = (*file)->elements();
  dicom::Element element;
  while (walk.next(element) == dicom::ElementWalk::Step::kElement) {
    std::string value((*file)->bytes().substr(element.begin, element.size));
    text += fmt::format("\n{:08x} ", element.tag);
    for (const char* start : {"2.25.", "ANON-"}) {
      for (std::size_t at = 0; (at = value.find(start, at)) != std::string::npos;) {
        const std::string name = value.substr(at, value.find_first_not_of("0123456789.ABCDEF", at + 5) - at);
        if (std::ranges::find(names, name) == names.end()) names.push_back(name);
        const auto index = std::ranges::find(names, name) - names.begin();
        const std::string label = fmt::format("<{}>", index);
        const bool is_padded = at + name.size() < value.size() && value[at + name.size()] == '\0';
        value.replace(at, name.size() + (is_padded ? 1 : 0), label);
        at += label.size();
      }
    }
    // Lengths of nested UIDs differ with their digits.
    text += element.has_undefined_length ? fmt::format("sequence of {} names", std::ranges::count(value, '<')) : value;
  }
  return text;
}

class FromOrthanc : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!Orthanc::is_installed()) return;
    orthanc_ = std::make_unique<Orthanc>();
    ASSERT_TRUE(orthanc_->is_running());
    for (int slice = 0; slice < made::kSlices; ++slice) ASSERT_TRUE(orthanc_->store(made::made_ct(slice).file()));
    ASSERT_TRUE(orthanc_->store(made::made_segmentation().file()));
    ASSERT_TRUE(orthanc_->store(made::made_structures().file()));
  }
  static void TearDownTestSuite() { orthanc_.reset(); }
  void SetUp() override {
    if (!Orthanc::is_installed()) GTEST_SKIP() << "Orthanc with its DICOMweb plugin is not installed";
  }

  static std::vector<std::string> ways() {
    return {orthanc_->pacs(), orthanc_->pacs() + " --via get", orthanc_->dicomweb()};
  }
  std::string out(const std::string& name) const { return folder_ / name; }
  Outcome fetch(const std::string& way, const std::string& rest) const {
    return trocar("patient fetch " + way + " --study " + made::kStudyUid + " " + rest);
  }

  static std::unique_ptr<Orthanc> orthanc_;
  cli_test::TemporaryFolder folder_;
};
std::unique_ptr<Orthanc> FromOrthanc::orthanc_;

void expect_no_identity(const fs::path& folder) {
  const auto files = files_below(folder);
  EXPECT_EQ(files.size(), made::kSlices + 2U);
  for (const fs::path& file : files) {
    const std::string bytes = cli_test::read_text(file.string());
    for (const std::string& text : made::identifying_texts()) {
      EXPECT_EQ(bytes.find(text), std::string::npos) << text << " remains in " << file;
      EXPECT_EQ(file.lexically_relative(folder).string().find(text), std::string::npos) << file;
    }
  }
}

TEST_F(FromOrthanc, AllProtocolsGiveTheSameAnonymisedFiles) {
  std::vector<std::string> texts;
  for (std::size_t n = 0; n < 3; ++n) {
    const std::string folder = out(std::to_string(n));
    const Outcome fetched = fetch(ways()[n], "--out '" + folder + "'");
    ASSERT_EQ(fetched.exit_status, 0) << ways()[n] << fetched.err;
    EXPECT_NE(fetched.out.find("8 images of 3 series"), std::string::npos) << fetched.out;
    expect_no_identity(folder);
    std::vector<std::string> names;
    std::string text;
    for (const fs::path& file : files_below(folder))
      text += file.lexically_relative(folder).string() + described(file, names);
    EXPECT_GT(names.size(), made::kSlices + 5U) << "UIDs must stay different";
    texts.push_back(text);
  }
  EXPECT_EQ(texts[0], texts[1]) << "C-MOVE and C-GET";
  EXPECT_EQ(texts[0], texts[2]) << "DIMSE and DICOMweb";
}

TEST_F(FromOrthanc, SegmentationsAndStructuresStillFitTheirCt) {
  ASSERT_EQ(fetch(orthanc_->dicomweb(), "--out '" + out("a") + "'").exit_status, 0);
  std::vector<std::string> instances;
  std::string frame;
  for (const fs::path& path : files_below(folder_.path() / "a" / "series_001_CT")) {
    const auto file = dicom::DicomFile::read(path);
    instances.emplace_back((*file)->root().text(0x00080018));
    frame = (*file)->root().text(0x00200052);
  }
  ASSERT_EQ(instances.size(), static_cast<std::size_t>(made::kSlices));
  const auto segmentation = dicom::DicomFile::read(out("a") + "/series_002_SEG/00001.dcm");
  ASSERT_TRUE(segmentation && *segmentation);
  const auto references = (*segmentation)->root().first_item(0x00081115)->items(0x0008114a);
  ASSERT_EQ(references->size(), static_cast<std::size_t>(made::kSlices));
  for (const dicom::DicomItem& reference : *references)
    EXPECT_EQ(std::ranges::count(instances, reference.text(0x00081155)), 1);
  EXPECT_EQ((*segmentation)->root().text(0x00200052), frame);
  EXPECT_EQ((*segmentation)->root().first_item(0x00620002)->text(0x00620005), "liver");
  const auto structures = dicom::DicomFile::read(out("a") + "/series_003_RTSTRUCT/00001.dcm");
  ASSERT_TRUE(structures && *structures);
  EXPECT_EQ((*structures)->root().first_item(0x30060010)->text(0x00200052), frame);
}

TEST_F(FromOrthanc, CtIsReadAsAVolume) {
  ASSERT_EQ(fetch(orthanc_->pacs(), "--out '" + out("a") + "'").exit_status, 0);
  const auto ct = io::read_ct(out("a"));
  ASSERT_TRUE(ct) << ct.error().text();
  EXPECT_EQ(ct->geometry.size[2], made::kSlices);
  EXPECT_DOUBLE_EQ(ct->geometry.spacing_mm[2], made::kStep_mm);
  EXPECT_DOUBLE_EQ(ct->geometry.origin_P[2], 100.0);
  const std::size_t pixels = made::kColumns * made::kColumns;
  for (std::size_t n = 0; n < pixels * made::kSlices; ++n)
    ASSERT_EQ(ct->voxels[n], made::made_hu(static_cast<int>(n / pixels), static_cast<int>(n % pixels))) << n;
}

TEST_F(FromOrthanc, NumbersFilesInOrder) {
  ASSERT_EQ(fetch(orthanc_->pacs(), "--series 1 --out '" + out("a") + "'").exit_status, 0);
  int number = 0;
  for (const fs::path& path : files_below(out("a"))) {
    const auto file = dicom::DicomFile::read(path);
    EXPECT_EQ((*file)->root().text(0x00200013), std::to_string(++number)) << path;
    EXPECT_EQ(path.filename(), fmt::format("{:05}.dcm", number));
  }
  EXPECT_EQ(number, made::kSlices);
}

TEST_F(FromOrthanc, IdentityIsKeptOnRequestWithAWarning) {
  for (const std::string& way : ways()) {
    const std::string folder = out(way.substr(0, 8) + std::to_string(way.size()));
    const Outcome fetched =
        fetch(way, "--keep-identity --series " + std::string(made::kRtSeriesUid) + " --out '" + folder + "'");
    ASSERT_EQ(fetched.exit_status, 0) << fetched.err;
    EXPECT_NE(fetched.err.find("warning: "), std::string::npos) << fetched.err;
    const auto file = dicom::DicomFile::read(folder + "/series_003_RTSTRUCT/00001.dcm");
    ASSERT_TRUE(file && *file);
    EXPECT_EQ((*file)->root().text(0x00100010), "Mustermann^Erika");
    EXPECT_EQ((*file)->root().text(0x0020000e), made::kRtSeriesUid);
    EXPECT_TRUE((*file)->root().find(0x00091001)) << "private elements stay";
  }
}

TEST_F(FromOrthanc, ListsSeriesAlikeOverAllProtocols) {
  std::vector<std::string> lists;
  for (const std::string& way : ways()) {
    const auto list = json_of(fetch(way, "--list --json"));
    ASSERT_EQ(list["series"].size(), 3U) << way;
    EXPECT_EQ(list["series"][0]["modality"], "CT");
    EXPECT_EQ(list["series"][0]["images"], made::kSlices);
    EXPECT_EQ(list["series"][1]["uid"], made::kSegSeriesUid);
    lists.push_back(list.dump());
    EXPECT_NE(fetch(way, "--list").out.find(made::kRtSeriesUid), std::string::npos);
  }
  EXPECT_EQ(lists[0], lists[2]);
}

TEST_F(FromOrthanc, StudiesOfAPatientAreListed) {
  for (const std::string& way : ways()) {
    const auto list = json_of(trocar("patient fetch " + way + " --patient-id PAT-778123 --json"));
    ASSERT_EQ(list["studies"].size(), 1U) << way;
    EXPECT_EQ(list["studies"][0]["uid"], made::kStudyUid);
    const Outcome none = trocar("patient fetch " + way + " --patient-id nobody");
    EXPECT_EQ(none.exit_status, 1) << none.err;
  }
}

TEST_F(FromOrthanc, SummaryIsJson) {
  const auto json = json_of(fetch(orthanc_->dicomweb(), "--json --series 1 --series 3 --out '" + out("a") + "'"));
  EXPECT_EQ(json["anonymised"], true);
  ASSERT_EQ(json["series"].size(), 2U);
  EXPECT_EQ(json["series"][0]["images"], made::kSlices);
  EXPECT_TRUE(fs::is_directory(json["series"][1]["folder"].get<std::string>()));
  EXPECT_EQ(json.dump().find("99999"), std::string::npos) << "no UID of the hospital";
}

TEST_F(FromOrthanc, RefusesWrongArgumentsBeforeWriting) {
  const std::string place = " --out '" + out("a") + "'";
  struct Case {
    std::string arguments;
    int exit_status;
    std::string message;
  };
  const std::string study = std::string(" --study ") + made::kStudyUid;
  const std::vector<Case> cases = {
      {orthanc_->pacs() + study + place + " --series 9", 2, "no series \"9\""},
      {orthanc_->pacs() + " --study 1.2.3" + place, 1, "no such study"},
      {orthanc_->dicomweb() + " --study 1.2.3" + place, 1, "study"},
      {orthanc_->dicomweb() + " --study ../../1" + place, 2, "no UID"},
      {orthanc_->dicomweb() + "/elsewhere" + study + place, 1, "no DICOMweb service"},
      {orthanc_->pacs() + " " + orthanc_->dicomweb() + study + place, 2, "which PACS?"},
      {study + place, 2, "which PACS?"},
      {orthanc_->pacs() + place, 2, "which study?"},
      {orthanc_->pacs() + study, 2, "--out is missing"},
      {orthanc_->pacs() + study + " --out '" + folder_.path().string() + "'", 2, "already exists"},
      {orthanc_->pacs() + " --aet 'A TITLE THAT IS TOO LONG'" + study + place, 2, "no AE title"},
  };
  for (const Case& c : cases) {
    const Outcome outcome = trocar("patient fetch " + c.arguments);
    EXPECT_EQ(outcome.exit_status, c.exit_status) << c.arguments << outcome.err;
    EXPECT_NE(outcome.err.find(c.message), std::string::npos) << c.arguments << "\n" << outcome.err;
    EXPECT_EQ(cli_test::line_count(outcome.err), 1) << outcome.err;
    EXPECT_TRUE(folder_.is_empty()) << c.arguments;
  }
}

TEST_F(FromOrthanc, RefusalNamesTheRequiredPacsSettings) {
  std::string other = orthanc_->pacs();
  other.replace(other.find("ORTHANC"), 7, "OTHER");
  const Outcome wrong_title = fetch(other, "--out '" + out("a") + "'");
  EXPECT_EQ(wrong_title.exit_status, 1);
  EXPECT_NE(wrong_title.err.find("its AE title is not OTHER"), std::string::npos) << wrong_title.err;
  const Outcome unknown = fetch(orthanc_->pacs() + " --aet STRANGER", "--out '" + out("a") + "'");
  EXPECT_EQ(unknown.exit_status, 1);
  for (const std::string part : {"STRANGER", "127.0.0.1", std::to_string(orthanc_->move_port()).c_str()})
    EXPECT_NE(unknown.err.find(part), std::string::npos) << part << "\n" << unknown.err;
  const Outcome closed = fetch(orthanc_->pacs() + " --aet CLOSED", "--out '" + out("a") + "'");
  EXPECT_EQ(closed.exit_status, 1) << "the PACS sends to another port";
  EXPECT_EQ(cli_test::line_count(closed.err), 1) << closed.err;
  EXPECT_TRUE(folder_.is_empty());
}

TEST_F(FromOrthanc, RefusalOfAnUnknownClientNamesItsAeTitle) {
  const Orthanc strict(false);
  ASSERT_TRUE(strict.is_running());
  for (const char* via : {"", " --via get"}) {
    const Outcome unknown = fetch(strict.pacs() + " --aet STRANGER" + via, "--out '" + out("a") + "'");
    EXPECT_EQ(unknown.exit_status, 1);
    for (const char* part : {"may not know our AE title STRANGER", "--aet"})
      EXPECT_NE(unknown.err.find(part), std::string::npos) << part << "\n" << unknown.err;
    EXPECT_EQ(cli_test::line_count(unknown.err), 1) << unknown.err;
  }
  EXPECT_NE(fetch(strict.pacs(), "--list").err.find("no such study"), std::string::npos) << "TROCAR is known";
  EXPECT_TRUE(folder_.is_empty());
}

/// Names that need more than ASCII, through a real PACS.
TEST_F(FromOrthanc, NamesOutsideAsciiAreReplaced) {
  const std::vector<std::pair<std::string, std::string>> names = {{"ISO_IR 100", "M\xdcLLER"},
                                                                  {"ISO_IR 144", "\xb8\xb2\xb0\xbd\xbe\xb2"},
                                                                  {"ISO_IR 126", "\xd0\xc1\xd0\xc1\xc4"},
                                                                  {"ISO_IR 148",
                                                                   "\xc7"
                                                                   "EL\xddK"},
                                                                  {"ISO_IR 192",
                                                                   "\xc3\x87"
                                                                   "EL\xc4\xb0K"}};
  int study = 0;
  for (const auto& [character_set, name] : names) {
    made::MadeObject object = made::made_ct(0);
    const std::string uid = fmt::format("1.3.6.1.4.1.99999.2.{}", ++study);
    object.add(0x00080005, "CS", character_set).add(0x00100010, "PN", name + "^Erika");
    object.add(0x0008103e, "LO", "CT " + name + " 5mm").add(0x00080018, "UI", uid + ".3");
    object.add(0x0020000d, "UI", uid).add(0x0020000e, "UI", uid + ".1");
    ASSERT_TRUE(orthanc_->store(object.file()));
    const Outcome fetched =
        trocar("patient fetch " + orthanc_->pacs() + " --study " + uid + " --out '" + out(uid) + "'");
    ASSERT_EQ(fetched.exit_status, 0) << fetched.err;
    EXPECT_NE(fetched.err.find("1 description of a series"), std::string::npos) << fetched.err;
    const std::string bytes = cli_test::read_text(out(uid) + "/series_001_CT/00001.dcm");
    EXPECT_FALSE(bytes.empty());
    EXPECT_EQ(bytes.find(name), std::string::npos) << character_set;
    EXPECT_NE(bytes.find("series-01"), std::string::npos) << character_set;
  }
}

TEST_F(FromOrthanc, FullDiskLeavesNothing) {
  for (const std::string& way : ways()) {
    const std::string arguments = "patient fetch " + way + " --study " + made::kStudyUid + " --out '" + out("a") + "'";
    const Outcome outcome = trocar(arguments, "ulimit -f 12;");  // 6 KiB: a slice has more
    EXPECT_EQ(outcome.exit_status, 1) << outcome.err;
    EXPECT_NE(outcome.err.find("error: cannot be written: File too large — " + out("a") + " — free"), std::string::npos)
        << outcome.err;
    EXPECT_EQ(cli_test::line_count(outcome.err), 1) << outcome.err;
    EXPECT_TRUE(folder_.is_empty());
  }
}

}  // namespace
}  // namespace trocar::pacs_test
