#include "tasks/harm.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "config/toml.h"
#include "core/files/folders.h"
#include "core/files/output_file.h"
#include "tasks/testing/shipped_task.h"

namespace trocar::tasks {
namespace {

using testing::tasks_folder;

anatomy::Label labelled(const std::string& name, const std::string& tissue) {
  return {1, name, tissue, {}};
}

/// Every name that structures.toml knows, with its tissue. A pattern gives a name that it matches.
std::vector<anatomy::Label> known_labels() {
  std::vector<anatomy::Label> labels;
  const auto document = config::load_toml(data_dir() / "structures.toml");
  EXPECT_TRUE(document);
  const std::vector<config::TomlTable> rows = document->tables("structures").value();
  for (const config::TomlTable& row : rows) {
    std::vector<std::string> names = row.strings("names").value();
    const std::vector<std::string> with_side = row.strings("with_side").value();
    for (const std::string& name : with_side) names.push_back(name + "_left");
    for (std::string name : names) {
      if (const auto end = name.find_first_of("%#*"); end != std::string::npos)
        name = name.substr(0, end) + (name[end] == '%' ? "L4" : name[end] == '#' ? "7" : "");
      labels.push_back(labelled(name, *row.string("tissue")));
    }
  }
  return labels;
}

TEST(HarmTable, GradesEveryStructureInEveryTask) {
  const auto tasks = load_tasks(tasks_folder());
  ASSERT_TRUE(tasks);
  const std::vector<anatomy::Label> labels = known_labels();
  ASSERT_GT(labels.size(), 300U);
  for (const Task& task : *tasks)
    for (const anatomy::Label& label : labels) {
      const std::string plain = anatomy::without_side(anatomy::plain_name(label.name));
      const bool is_named = std::ranges::any_of(task.harms, [&](const HarmRule& rule) {
        return rule.is_for(task.target_tissues) && rule.matches(plain, label.tissue);
      });
      EXPECT_TRUE(is_named) << task.name << ": " << label.name << " (" << label.tissue << ")";
      EXPECT_FALSE(find_harm(task, label).reason.empty() && !is_organ(task, label) && !is_target(task, label))
          << task.name << ": " << label.name;
    }
}

TEST(HarmTable, GradesByStructureTaskAndRegion) {
  struct Row {
    const char* name;
    const char* tissue;
    const char* grades;  ///< Of the tasks in the order of their names: ascites, biopsy, lumbar, ptcd.
  };
  // c: critical, M: major, m: minor, -: none.
  constexpr Row kRows[] = {
      {"heart", "organ", "cccc"},
      {"heart_atrium_left", "organ", "cccc"},
      {"aorta", "vessel", "cccc"},
      {"inferior_vena_cava", "vessel", "cccc"},
      {"lung_lower_lobe_right", "lung", "cccc"},
      {"colon", "bowel", "cccc"},
      {"stomach", "bowel", "cccc"},
      {"gas", "gas", "cccc"},
      {"gallbladder", "gallbladder", "cccc"},
      {"spleen", "spleen", "cccc"},
      {"spinal_cord", "nerve", "cccc"},
      {"cauda_equina", "nerve", "cc-c"},
      {"nerve_root_3", "nerve", "mmmm"},
      {"brain", "nerve", "cccc"},
      {"dural_sac", "csf", "MM-M"},
      {"epidural_veins", "vessel", "mmmm"},
      {"liver", "liver", "M-M-"},
      {"livertumor2", "liver_lesion", "m-mm"},
      {"hepatic_vein_2", "vessel", "mmmm"},
      {"portal_vein_and_splenic_vein", "vessel", "MMMm"},
      {"portal_vein", "vessel", "MmMm"},
      {"epigastric_vessels", "vessel", "MMMM"},
      {"neurovascular_bundle_right_9", "vessel", "MMMM"},
      {"kidney_left", "kidney", "MMMM"},
      {"pancreas", "organ", "MMMM"},
      {"urinary_bladder", "fluid", "MMMM"},
      {"liver_cyst", "fluid", "mmmm"},
      {"common_bile_duct", "bile_duct", "MmM-"},
      {"ascites", "ascites", "--m-"},
      {"rib_left_9", "bone", "mmmm"},
      {"intervertebral_discs", "cartilage", "mmmm"},
      {"muscle", "muscle", "----"},
      {"skin", "skin", "----"},
  };
  const auto tasks = load_tasks(tasks_folder());
  ASSERT_TRUE(tasks);
  ASSERT_EQ(tasks->size(), 4U);
  for (const Row& row : kRows)
    for (std::size_t n = 0; n < tasks->size(); ++n) {
      const Harm grade = find_harm((*tasks)[n], labelled(row.name, row.tissue)).grade;
      EXPECT_EQ("-mMc"[static_cast<std::size_t>(grade)], row.grades[n]) << (*tasks)[n].name << ": " << row.name;
    }
}

TEST(HarmTable, NotchAndTimeRaiseTheGradeOfAVein) {
  const Task task = testing::liver_biopsy();
  const LabelHarm vein = find_harm(task, labelled("hepatic_vein", "vessel"));
  EXPECT_EQ(vein.grade, Harm::kMinor);
  EXPECT_EQ(vein.notch, Harm::kMajor);
  EXPECT_EQ(vein.stay, Harm::kMajor);
  EXPECT_EQ(vein.stay_s, 10.0);
}

TEST(HarmTable, ATaskOverridesIt) {
  const std::string text = R"(base = "liver-biopsy"
[[risks]]
tissue = "spleen"
margin_mm = 5.0
harm = "minor"
[[risks]]
label = "liver_segment_4"
margin_mm = 5.0
critical = true
[[harms]]
names = ["kidney"]
grade = "critical"
reason = "there is only one"
)";
  const auto task = parse_task(text, "own", "own.toml", tasks_folder());
  ASSERT_TRUE(task) << task.error().text();
  EXPECT_EQ(find_harm(*task, labelled("spleen", "spleen")).grade, Harm::kMinor);
  EXPECT_EQ(find_harm(*task, labelled("liver_segment_4", "liver")).grade, Harm::kCritical) << "of an older file";
  EXPECT_EQ(find_harm(*task, labelled("kidney_left", "kidney")).grade, Harm::kCritical);
  EXPECT_EQ(find_harm(*task, labelled("lung", "lung")).grade, Harm::kCritical) << "the rest is that of the table";
  const Task base = testing::liver_biopsy();
  const auto again = parse_task(task_to_toml(*task, base), "own", "again.toml", tasks_folder());
  ASSERT_TRUE(again) << again.error().text();
  EXPECT_EQ(again->harms, task->harms);
  EXPECT_EQ(again->risks, task->risks);
}

TEST(HarmTable, RenamedTaskIsGradedAlike) {
  const auto tasks = load_tasks(tasks_folder());
  ASSERT_TRUE(tasks);
  for (const Task& task : *tasks) {
    const auto text = read_file(tasks_folder() / (task.name + ".toml"));
    ASSERT_TRUE(text);
    const auto copy = parse_task(*text, "renamed", "renamed.toml", tasks_folder());
    ASSERT_TRUE(copy) << copy.error().text();
    for (const anatomy::Label& label : known_labels()) {
      const LabelHarm wanted = find_harm(task, label);
      const LabelHarm found = find_harm(*copy, label);
      EXPECT_EQ(found.grade, wanted.grade) << task.name << ": " << label.name;
      EXPECT_EQ(found.notch, wanted.notch) << task.name << ": " << label.name;
      EXPECT_EQ(found.stay, wanted.stay) << task.name << ": " << label.name;
    }
  }
}

TEST(HarmTable, RefusesARowForTheTasksOwnOrgan) {
  const auto refused = [](const std::string& row) {
    const std::string text = "base = \"liver-biopsy\"\n[[harms]]\n" + row + "grade = \"major\"\nreason = \"blood\"\n";
    const auto task = parse_task(text, "own", "own.toml", tasks_folder());
    return !task && task.error().text().find("no harm in it") != std::string::npos;
  };
  EXPECT_TRUE(refused("names = [\"liver\"]\n"));
  EXPECT_TRUE(refused("tissues = [\"liver\", \"liver_lesion\"]\n"));
  EXPECT_FALSE(refused("names = [\"liver_cyst\"]\n"));
  EXPECT_FALSE(refused("tissues = [\"liver\", \"spleen\"]\n"));
}

TEST(HarmTable, AnUnknownStructureIsMajor) {
  EXPECT_EQ(find_harm(testing::liver_biopsy(), labelled("thing", "blubber")).grade, Harm::kMajor);
}

TEST(HarmTable, DamagedRowsAreRefused) {
  const TemporaryFolder folder;
  const auto error_of = [&](const std::string& row) {
    EXPECT_TRUE(write_file_atomically(folder / kHarmFile, "[[harms]]\n" + row));
    const auto rules = load_harm_table(folder / kHarmFile);
    return rules ? std::string("no error") : rules.error().text();
  };
  const std::string good = "tissues = [\"lung\"]\ngrade = \"major\"\nreason = \"air\"\n";
  EXPECT_EQ(error_of(good), "no error");
  EXPECT_NE(error_of("grade = \"major\"\nreason = \"air\"\n").find("for nothing"), std::string::npos);
  EXPECT_NE(error_of("tissues = [\"lung\"]\ngrade = \"bad\"\nreason = \"\"").find("no grade of harm"),
            std::string::npos);
  EXPECT_NE(error_of(good + "stay = \"critical\"\n").find("belong together"), std::string::npos);
  EXPECT_NE(error_of(good + "names = [\"left_lung\"]\n").find("no label can be named"), std::string::npos);
  EXPECT_NE(error_of(good + "tissue = \"lung\"\n").find("did you mean"), std::string::npos);
  EXPECT_NE(load_harm_table(folder / "none.toml").error().text().find("none.toml"), std::string::npos);
}

}  // namespace
}  // namespace trocar::tasks
