// What the values of a label file mean: its name, its own table, the map, and what is refused.

#include <algorithm>

#include "config/toml.h"
#include "core/files/folders.h"
#include "io/image/image_file.h"
#include "io/image/testing/hand_made_nifti.h"
#include "io/patient/detail/number_schemes.h"
#include "io/patient/label_map.h"
#include "io/patient/label_sources.h"
#include "io/test/test_support.h"

namespace trocar::io {
namespace {

using testing::HandMadeNifti;
using testing::oblique_geometry;
using testing::write_bytes;

using NumberNames = std::vector<std::pair<int, std::string>>;

struct LabelsRead {
  Result<std::vector<patient_builder::LabelSource>> sources;
  std::vector<std::string> warnings;

  std::string text() const { return sources ? "read" : sources.error().text(); }
  bool refuses(const std::string& words) const { return text().find(words) != std::string::npos; }
  bool warns_of(const std::string& words) const {
    return std::ranges::any_of(warnings, [&](const auto& w) { return w.find(words) != std::string::npos; });
  }
  NumberNames names() const { return sources && !sources->empty() ? sources->front().names : NumberNames(); }
};

LabelsRead read_labels_of(const std::filesystem::path& path, const std::string& map = "totalsegmentator") {
  LabelsRead read;
  read.sources = read_label_sources({path}, map, {}, read.warnings);
  return read;
}

/// Writes a volume with these values in the middle of its first slice, 0 elsewhere.
void write_values(const std::filesystem::path& path, const std::vector<std::uint8_t>& values) {
  volume::LabelGrid labels(oblique_geometry());
  std::copy(values.begin(), values.end(), labels.voxels.begin() + 8);
  ASSERT_TRUE(write_image(labels, path));
}

TEST(NumberSchemes, HaveKnownStructuresAndSources) {
  const auto map = LabelMap::load("");
  ASSERT_TRUE(map) << map.error().text();
  const auto file = config::load_toml(*checked_data_dir() / "dataset_labels.toml");
  ASSERT_TRUE(file) << file.error().text();
  EXPECT_GE(file->keys().size(), 10U);
  for (const std::string& name : file->keys()) {
    const auto scheme = detail::load_scheme(name, map->structures(), {});
    ASSERT_TRUE(scheme) << scheme.error().text();
    EXPECT_GE(scheme->names.size(), 2U) << name;
    for (const auto& [number, structure] : scheme->names) EXPECT_TRUE(map->is_known(structure)) << name << structure;
    EXPECT_GT(file->table(name)->string("source")->size(), 10U) << name;
  }
}

TEST(NumberSchemes, ADataSetIsChosenByItsName) {
  const TemporaryFolder folder;
  write_values(folder / "label0001.nii.gz", {1, 6, 11});
  EXPECT_EQ(read_labels_of(folder / "label0001.nii.gz", "btcv").names(),
            (NumberNames{{1, "spleen"}, {6, "liver"}, {11, "pancreas"}}));
  EXPECT_EQ(read_labels_of(folder / "label0001.nii.gz", "verse").names(),
            (NumberNames{{1, "vertebrae_C1"}, {6, "vertebrae_C6"}, {11, "vertebrae_T4"}}));
  write_bytes(folder / "own.toml", "base = \"flare22\"\n[labels]\n6 = \"aorta\"\n");
  EXPECT_EQ(read_labels_of(folder / "label0001.nii.gz", (folder / "own.toml").string()).names(),
            (NumberNames{{1, "liver"}, {6, "aorta"}, {11, "stomach"}}));
  const LabelsRead unknown = read_labels_of(folder / "label0001.nii.gz", "btvc");
  for (const char* name : {"btvc", "btcv", "flare22", "verse", "totalsegmentator"})
    EXPECT_TRUE(unknown.refuses(name)) << unknown.text();
}

TEST(NumberSchemes, OfferOnlyReadingsThatCoverTheFile) {
  const TemporaryFolder folder;
  const auto schemes_of = [&](const std::string& map, const NumberNames& given) {
    std::vector<std::string> names;
    for (const patient_builder::OtherReading& other : LabelMap::load(map)->other_readings(given))
      names.push_back(other.label_map);
    return names;
  };
  const std::vector<std::string> covering =
      schemes_of("totalsegmentator", {{1, "spleen"}, {2, "kidney_right"}, {4, "gallbladder"}});
  EXPECT_TRUE(std::ranges::count(covering, "chaos") == 1);
  EXPECT_TRUE(std::ranges::count(covering, "lits") == 0);  // has no 4
  EXPECT_TRUE(std::ranges::count(covering, "btcv") == 0);  // means the same
  // The base of a file is compared, too; its advice names the file.
  write_bytes(folder / "base.toml", "base = \"totalsegmentator\"\n[labels]\n2 = \"liver\"\n");
  const auto map = LabelMap::load((folder / "base.toml").string());
  ASSERT_TRUE(map) << map.error().text();
  const auto others = map->other_readings({{1, "spleen"}, {2, "liver"}});
  ASSERT_FALSE(others.empty());
  for (const patient_builder::OtherReading& other : others) {
    EXPECT_NE(other.advice.find("base.toml"), std::string::npos);
    EXPECT_EQ(other.names.back().second, "liver") << other.label_map;
  }
  write_bytes(folder / "all.toml", "base = \"totalsegmentator\"\n[labels]\n1 = \"aorta\"\n2 = \"liver\"\n");
  EXPECT_TRUE(schemes_of((folder / "all.toml").string(), {{1, "aorta"}, {2, "liver"}}).empty());
}

TEST(NumberSchemes, OfferNoOtherReadingsForUserDefinedNumbers) {
  const TemporaryFolder folder;
  write_values(folder / "seg.nii.gz", {1, 2});
  const auto readings = [&](const std::string& toml) {
    write_bytes(folder / "own.toml", toml);
    const LabelsRead read = read_labels_of(folder / "seg.nii.gz", (folder / "own.toml").string());
    return read.sources ? read.sources->front().other_readings.size() : std::size_t{99};
  };
  EXPECT_EQ(readings("[labels]\n1 = \"aorta\"\n2 = \"liver\"\n"), 0U);
  EXPECT_EQ(readings("[labels]\n\"*\" = \"liver\"\n"), 0U);
  EXPECT_EQ(readings("base = \"totalsegmentator\"\n[labels]\n1 = \"aorta\"\n2 = \"liver\"\n"), 0U);
  EXPECT_GT(readings("base = \"totalsegmentator\"\n"), 3U);
}

TEST(NamedLabels, RefuseSeveralValuesInAFileNamedAfterOneStructure) {
  for (const char* name : {"liver.nii.gz", "vertebrae.nii.gz", "kidney_left.nrrd", "pancreas_001.nii.gz"}) {
    const TemporaryFolder folder;
    write_values(folder / name, {1, 2});
    for (const std::filesystem::path& path : {folder / name, folder.path()}) {
      const LabelsRead read = read_labels_of(path);
      EXPECT_TRUE(read.refuses("one structure")) << name << read.text();
      EXPECT_TRUE(read.refuses("1, 2")) << read.text();
    }
  }
  // Chosen, or written by the user.
  const TemporaryFolder folder;
  write_values(folder / "liver_12.nii.gz", {1, 2});
  EXPECT_EQ(read_labels_of(folder / "liver_12.nii.gz", "lits").names(),
            (NumberNames{{1, "liver"}, {2, "liver_tumor"}}));
  write_bytes(folder / "own.toml", "[labels]\n1 = \"liver\"\n2 = \"liver_tumor\"\n");
  EXPECT_EQ(read_labels_of(folder / "liver_12.nii.gz", (folder / "own.toml").string()).names(),
            (NumberNames{{1, "liver"}, {2, "liver_tumor"}}));
  write_bytes(folder / "half.toml", "base = \"totalsegmentator\"\n[labels]\n1 = \"liver\"\n");
  EXPECT_TRUE(read_labels_of(folder / "liver_12.nii.gz", (folder / "half.toml").string()).refuses("one structure"));
  // A name of no structure: numbers of the map.
  write_values(folder / "case_7.nii.gz", {1, 5});
  EXPECT_EQ(read_labels_of(folder / "case_7.nii.gz").names(), (NumberNames{{1, "spleen"}, {5, "liver"}}));
}

TEST(NamedLabels, RefuseANameForTheBackground) {
  const TemporaryFolder folder;
  volume::LabelGrid raised(oblique_geometry(), 1);  // every number raised by one: the background is 1
  raised.voxels[40] = 6;
  ASSERT_TRUE(write_image(raised, folder / "seg.nii.gz"));
  EXPECT_TRUE(read_labels_of(folder / "seg.nii.gz").refuses("no background"));
  raised.voxels[41] = 0;
  ASSERT_TRUE(write_image(raised, folder / "seg.nii.gz"));
  EXPECT_TRUE(read_labels_of(folder / "seg.nii.gz").refuses("background has the label 1, which is \"spleen\""));
  // An inverted mask; the skin's mask may fill its volume.
  raised.voxels[40] = 1;
  ASSERT_TRUE(write_image(raised, folder / "liver.nii.gz"));
  EXPECT_TRUE(read_labels_of(folder / "liver.nii.gz").refuses("background"));
  ASSERT_TRUE(write_image(raised, folder / "body.nii.gz"));
  EXPECT_EQ(read_labels_of(folder / "body.nii.gz").text(), "read");
}

TEST(NamedLabels, RefuseKeysThatCannotMatch) {
  const TemporaryFolder folder;
  write_values(folder / "seg.nii.gz", {1, 5});
  for (const char* text : {"[labels]\n\" 5\" = \"liver\"\n", "[labels]\n\"5.0\" = \"liver\"\n",
                           "[labels]\n\"+5\" = \"liver\"\n", "[labels]\nliver = \"5\"\n", "ignore = [\"5.0\"]\n"}) {
    write_bytes(folder / "map.toml", text);
    const LabelsRead read = read_labels_of(folder / "seg.nii.gz", (folder / "map.toml").string());
    EXPECT_TRUE(read.refuses("map.toml")) << text << read.text();
  }
  write_bytes(folder / "map.toml", "[labels]\n1 = \"spleen\"\n5 = \"liver\"\nmy_roi_5 = \"liver_tumor\"\n");
  EXPECT_EQ(read_labels_of(folder / "seg.nii.gz", (folder / "map.toml").string()).text(), "read");
}

/// A label file with an extension, as TotalSegmentator writes it.
std::string with_label_table(const std::vector<std::uint8_t>& voxels, std::string xml, std::int32_t kind = 0) {
  xml.resize((xml.size() + 8 + 15) / 16 * 16 - 8, '\0');
  HandMadeNifti nifti;
  nifti.put_sizes({4, 3, 2});
  nifti.put_type(2, 8);
  nifti.put_spacing(2, 3, 4);
  nifti.put_sform({2, 0, 0, 10, 0, 3, 0, 20, 0, 0, 4, 30});
  nifti.put<std::uint8_t>(348, 1);
  nifti.put<float>(108, static_cast<float>(352 + 8 + xml.size()));
  const auto size = static_cast<std::int32_t>(xml.size() + 8);
  nifti.bytes.append(reinterpret_cast<const char*>(&size), 4).append(reinterpret_cast<const char*>(&kind), 4) += xml;
  nifti.add_voxels(voxels);
  return nifti.bytes;
}

std::string table_of(const NumberNames& names) {
  std::string xml = "<?xml version=\"1.0\"?> <CaretExtension><VolumeInformation Index=\"0\"><LabelTable>";
  for (const auto& [number, name] : names)
    xml += "<Label Key=\"" + std::to_string(number) + "\" Red=\"1\" Alpha=\"1\"><![CDATA[" + name + "]]></Label>";
  return xml + "</LabelTable></VolumeInformation></CaretExtension>";
}

std::vector<std::uint8_t> few_values(const std::vector<std::uint8_t>& values) {
  std::vector<std::uint8_t> voxels(24, 0);
  std::copy(values.begin(), values.end(), voxels.begin() + 5);
  return voxels;
}

TEST(LabelTable, InTheHeaderNamesTheNumbers) {
  const TemporaryFolder folder;
  const auto path = folder / "seg.nii";
  for (const std::int32_t kind : {0, 30}) {
    write_bytes(path, with_label_table(few_values({1, 4}),
                                       table_of({{0, "background"}, {1, "liver"}, {4, "spleen"}, {9, "colon"}}), kind));
    EXPECT_EQ(read_labels_of(path).names(), (NumberNames{{1, "liver"}, {4, "spleen"}}));
    EXPECT_EQ(read_labels_of(path, "").names(), (NumberNames{{1, "liver"}, {4, "spleen"}}));
  }
  // The user's entries win, also for a name; a chosen scheme wins with a warning.
  write_bytes(folder / "own.toml", "[labels]\n4 = \"aorta\"\nliver = \"liver_tumor\"\n");
  EXPECT_EQ(read_labels_of(path, (folder / "own.toml").string()).names(),
            (NumberNames{{1, "liver_tumor"}, {4, "aorta"}}));
  const LabelsRead chosen = read_labels_of(path, "word");
  EXPECT_EQ(chosen.names(), (NumberNames{{1, "liver"}, {4, "kidney_right"}}));
  EXPECT_TRUE(chosen.warns_of("4 = spleen"));
  // It is compared with the CT as other names are: a program that renumbers may keep the header.
  const LabelsRead read = read_labels_of(path);
  ASSERT_TRUE(read.sources);
  EXPECT_FALSE(read.sources->front().other_readings.empty());
  // A mask of one structure keeps the name of its file.
  write_bytes(folder / "liver.nii", with_label_table(few_values({1, 1}), table_of({{1, "spleen"}})));
  const LabelsRead mask = read_labels_of(folder / "liver.nii");
  EXPECT_EQ(mask.names(), (NumberNames{{1, "liver"}}));
  EXPECT_TRUE(mask.warns_of("\"spleen\""));
}

TEST(LabelTable, RefusesOrIgnoresDamagedTables) {
  const auto error = [](const std::string& xml) {
    const auto names = detail::read_label_table(xml, "seg.nii");
    return names ? std::string("read") : names.error().text();
  };
  EXPECT_EQ(error(""), "read");
  EXPECT_EQ(error("<LabelTable></LabelTable>"), "read");
  EXPECT_EQ(detail::read_label_table(
                "<Label Green=\"2\" Key = '7'> a &lt; b &amp;lt; </Label><Label Key=\"300\">x</Label>", "")
                .value(),
            (std::map<int, std::string>{{7, "a < b &lt;"}}));
  EXPECT_NE(error("<Label Key=\"1\">liver").find("no end"), std::string::npos);
  EXPECT_NE(error("<Label Key=\"1\"><![CDATA[liver</Label>").find("no end"), std::string::npos);
  EXPECT_NE(error("<Label Red=\"1\">liver</Label>").find("Key"), std::string::npos);
  EXPECT_NE(error("<Label Key=\"one\">liver</Label>").find("Key"), std::string::npos);
  EXPECT_NE(error("<Label Key=\"1\">liver</Label><Label Key=\"1\">spleen</Label>").find("two names"),
            std::string::npos);
  // An extension that does not fit before the voxels is none.
  const TemporaryFolder folder;
  std::string bytes = with_label_table(few_values({1, 4}), table_of({{1, "liver"}, {4, "spleen"}}));
  for (const std::int32_t size : {0, -16, 8, 1 << 30}) {
    std::memcpy(bytes.data() + 352, &size, 4);
    write_bytes(folder / "seg.nii", bytes);
    EXPECT_EQ(read_labels_of(folder / "seg.nii").names(), (NumberNames{{1, "spleen"}, {4, "gallbladder"}})) << size;
  }
}

TEST(NamedLabels, WarnOfUnreadFilesInTheFolder) {
  const TemporaryFolder folder;
  write_values(folder / "liver.nii.gz", {1});
  EXPECT_FALSE(read_labels_of(folder.path()).warns_of("not read"));
  for (const char* name : {"statistics.json", "preview.png", ".hidden"}) write_bytes(folder / name, "x");
  EXPECT_FALSE(read_labels_of(folder.path()).warns_of("not read"));
  write_bytes(folder / "spleen.hdr", "x");
  write_bytes(folder / "spleen.img", "x");
  std::filesystem::create_directory(folder / "more");
  write_values(folder / "more" / "aorta.nii.gz", {1});
  const LabelsRead read = read_labels_of(folder.path());
  EXPECT_EQ(read.text(), "read");
  for (const char* name : {"spleen.hdr", "spleen.img", "more"}) EXPECT_TRUE(read.warns_of(name)) << name;
}

TEST(NamedLabels, RefuseRepeatedOrMisspeltSegNrrdFields) {
  const TemporaryFolder folder;
  const auto read_with = [&](const std::string& pairs) {
    write_bytes(
        folder / "a.seg.nrrd",
        "NRRD0004\ntype: unsigned char\ndimension: 3\nspace: left-posterior-superior\nsizes: 2 2 2\nspace directions: "
        "(1,0,0) (0,1,0) (0,0,1)\nencoding: raw\nspace origin: (0,0,0)\n" +
            pairs + "\n" + std::string("\3\3\1\0\0\0\0\0", 8));
    return read_labels_of(folder / "a.seg.nrrd");
  };
  const std::string right =
      "Segment0_LabelValue:=3\nSegment0_Name:=liver\nSegment1_LabelValue:=1\nSegment1_Name:=spleen\n";
  EXPECT_EQ(read_with(right).names(), (NumberNames{{3, "liver"}, {1, "spleen"}}));
  EXPECT_TRUE(read_with(right + "Segment0_LabelValue:=1\nSegment1_LabelValue:=3\n").refuses("twice"));
  EXPECT_TRUE(read_with(right + "Segment0_Name:=liver\n").refuses("twice"));
  EXPECT_TRUE(read_with("segment0_LabelValue:=3\nsegment0_Name:=liver\n").refuses("misspells"));
  EXPECT_TRUE(read_with(right + "Segment2_labelValue:=2\n").refuses("misspells"));
}

TEST(NamedLabels, RecogniseMaskFileNames) {
  const TemporaryFolder folder;
  for (const char* name : {"spleen_seg.nii", "spleen-mask.nii.gz", "spleen_Segmentation.nrrd", "spleen label.nii"}) {
    write_values(folder / name, {1, 1});
    EXPECT_EQ(read_labels_of(folder / name).names(), (NumberNames{{1, "spleen"}})) << name;
  }
  write_values(folder / "liver_seg.nii", {1, 1});
  const LabelsRead liver = read_labels_of(folder / "liver_seg.nii");
  EXPECT_EQ(liver.names(), (NumberNames{{1, "liver"}}));
  EXPECT_TRUE(liver.warnings.empty());
  write_values(folder / "liver_mask.nii", {1, 2});
  EXPECT_TRUE(read_labels_of(folder / "liver_mask.nii").refuses("named after one structure"));
}

}  // namespace
}  // namespace trocar::io
