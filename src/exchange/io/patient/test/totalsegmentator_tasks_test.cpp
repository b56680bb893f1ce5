// Every published class of TotalSegmentator's tasks (data/totalsegmentator.toml, data/totalsegmentator_tasks.toml).

#include <set>

#include "config/toml.h"
#include "core/files/folders.h"
#include "io/image/image_file.h"
#include "io/patient/label_map.h"
#include "io/patient/label_sources.h"
#include "io/test/test_support.h"

namespace trocar::io {
namespace {

config::TomlTable tasks() {
  const auto folder = checked_data_dir();
  EXPECT_TRUE(folder);
  const auto file = config::load_toml(*folder / "totalsegmentator_tasks.toml");
  EXPECT_TRUE(file) << file.error().text();
  const auto table = file->table("tasks");
  EXPECT_TRUE(table) << table.error().text();
  return *table;
}

TEST(TotalSegmentatorTasks, EveryClassIsAStructureOrARegion) {
  const auto map = LabelMap::load("");
  ASSERT_TRUE(map) << map.error().text();
  std::set<std::string> names;
  const config::TomlTable table = tasks();
  for (const std::string& task : table.keys()) {
    const auto classes = table.table(task);
    ASSERT_TRUE(classes) << task;
    for (const std::string& number : classes->keys()) {
      const auto name = classes->string(number);
      ASSERT_TRUE(name) << task << number;
      names.insert(*name);
      EXPECT_TRUE(map->is_known(*name) || map->structures().is_region(*name)) << task << ": " << *name;
    }
  }
  for (const std::string& name : map->structures().totalsegmentator_names()) {
    names.insert(name);
    EXPECT_TRUE(map->is_known(name)) << name;
  }
  EXPECT_GT(names.size(), 250U);
}

TEST(TotalSegmentatorTasks, MapClassesToTissues) {
  const auto map = LabelMap::load("");
  ASSERT_TRUE(map) << map.error().text();
  const auto tissue = [&](const char* name) -> std::string {
    const auto* structure = map->structures().find(name);
    return structure == nullptr ? "none" : structure->tissue;
  };
  EXPECT_EQ(tissue("liver_vessels"), "vessel");
  EXPECT_EQ(tissue("lung_vessels"), "vessel");
  EXPECT_EQ(tissue("liver_segment_4"), "liver");
  EXPECT_EQ(tissue("liver_lesions"), "liver_lesion");
  EXPECT_EQ(tissue("hip_implant"), "bone");
  EXPECT_EQ(tissue("body_extremities"), "skin");
  EXPECT_EQ(tissue("vertebrae_body"), "bone");
  EXPECT_EQ(tissue("skeletal_muscle"), "muscle");
  EXPECT_EQ(tissue("intermuscular_fat"), "adipose");
  EXPECT_EQ(tissue("pericardial_effusion"), "fluid");
  EXPECT_EQ(tissue("heart_ventricle_left"), "organ");
  EXPECT_EQ(tissue("ventricle_body_left"), "csf");
  EXPECT_EQ(tissue("external_oblique_right"), "muscle");
  EXPECT_EQ(tissue("phalanges_hand"), "bone");
  EXPECT_EQ(tissue("left_coronary_cusp"), "vessel");
  EXPECT_EQ(tissue("lung_nodules"), "soft_tissue");
}

TEST(TotalSegmentatorTasks, SelectANumberSchemeByTask) {
  const TemporaryFolder folder;
  volume::LabelGrid labels(testing::oblique_geometry());
  labels.voxels[0] = 1;
  labels.voxels[1] = 2;
  ASSERT_TRUE(write_image(labels, folder / "seg.nii.gz"));
  const auto names = [&](const std::string& map) -> std::vector<std::pair<int, std::string>> {
    const auto sources = read_label_sources({folder / "seg.nii.gz"}, map);
    if (!sources) return {{0, sources.error().text()}};
    return sources->front().names;
  };
  using Names = std::vector<std::pair<int, std::string>>;
  EXPECT_EQ(names("totalsegmentator:liver_vessels"), (Names{{1, "liver_vessels"}, {2, "liver_tumor"}}));
  EXPECT_EQ(names("totalsegmentator:liver_segments"), (Names{{1, "liver_segment_1"}, {2, "liver_segment_2"}}));
  testing::write_bytes(folder / "map.toml", "base = \"totalsegmentator:tissue_types\"\n[labels]\n1 = \"ignore\"\n");
  EXPECT_EQ(names((folder / "map.toml").string()), (Names{{1, "ignore"}, {2, "torso_fat"}}));
  const std::string unknown = names("totalsegmentator:livers").front().second;
  EXPECT_NE(unknown.find("no task \"livers\""), std::string::npos) << unknown;
  EXPECT_NE(unknown.find("liver_vessels"), std::string::npos) << unknown;
}

TEST(StructureCodes, NameKnownStructures) {
  const auto map = LabelMap::load("");  // loading checks every name
  ASSERT_TRUE(map) << map.error().text();
  const auto name_of = [&](const std::vector<std::string>& codes, const std::vector<std::string>& meanings,
                           const std::string& type_in_region = {}) {
    return map->name_of(DescribedSegment{"Segment_1", 1, type_in_region, codes, meanings});
  };
  EXPECT_EQ(name_of({"SCT:10200004"}, {"Leber"}), "liver");
  EXPECT_EQ(name_of({"SCT:64033007 left"}, {"Rein left"}), "kidney_left");
  EXPECT_EQ(name_of({"SCT:49668003"}, {"Vertebra"}), "vertebrae_L5");
  EXPECT_EQ(name_of({"SCT:1"}, {"Right Lung"}), "right_lung");
  EXPECT_EQ(name_of({"SCT:367643001"}, {"Cyst"}, "Kidney Cyst"), "kidney_cyst");
  EXPECT_EQ(name_of({"SCT:1"}, {}), "Segment_1");
}

}  // namespace
}  // namespace trocar::io
