// Checks the includes of the trainer against apps/trainer/folders.txt, and the checker against a made-up list.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "architecture/layers.h"
#include "architecture/source_files.h"
#include "core/testing/source_dir.h"

namespace trocar::architecture {
namespace {
namespace fs = std::filesystem;

const std::string kTrainer = "apps/trainer";

Modules folders_of(std::string_view text) {
  std::vector<std::string> complaints;
  Modules folders = parse_modules(text, complaints);
  EXPECT_EQ(joined(complaints), "");
  return folders;
}

Modules trainer_folders() {
  std::ifstream file(testing::source_dir() / kTrainer / "folders.txt", std::ios::binary);
  return folders_of(std::string{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()});
}

std::string folder_verdict(const std::string& path, std::string_view source) {
  static const Modules folders = folders_of("[trainer]\nui_kit : :\nviews : ui_kit :\nshell : views :\n");
  return joined(check_folder_includes(folders, kTrainer, path, source));
}

TEST(Folders, IncludesGoDownOnly) {
  EXPECT_EQ(folder_verdict("apps/trainer/shell/a.cpp", "#include \"ui_kit/a.h\"\n#include \"shell/b.h\"\n"), "");
  EXPECT_EQ(folder_verdict("apps/trainer/views/plots/a.cpp", "#include \"views/a.h\"\n#include \"core/a.h\"\n"), "");
  EXPECT_NE(folder_verdict("apps/trainer/views/plots/a.cpp", "#include \"shell/a.h\"\n"), "");
  EXPECT_NE(folder_verdict("apps/trainer/ui_kit/a.cpp", "#include \"views/a.h\"\n"), "");
}

TEST(Folders, MainAndTestsMayIncludeAll) {
  EXPECT_EQ(folder_verdict("apps/trainer/main.cpp", "#include \"shell/a.h\"\n"), "");
  EXPECT_EQ(folder_verdict("apps/trainer/test/a_test.cpp", "#include \"shell/a.h\"\n"), "");
  EXPECT_EQ(folder_verdict("apps/cli/a.cpp", "#include \"shell/a.h\"\n"), "");
}

TEST(Folders, OneOutsideTheListIsRefused) {
  EXPECT_NE(folder_verdict("apps/trainer/other/a.cpp", ""), "");
}

TEST(TrainerFolders, AreAllListedWithoutCycles) {
  const Modules folders = trainer_folders();
  std::set<std::string> present, listed;
  for (const auto& entry : fs::directory_iterator(testing::source_dir() / kTrainer))
    if (entry.is_directory() && entry.path().filename() != "test") present.insert(entry.path().filename().string());
  for (const auto& [name, folder] : folders) listed.insert(name);
  EXPECT_EQ(present, listed);
  EXPECT_EQ(joined(check_arrows(folders)), "");
  EXPECT_EQ(reachable(folders, "ui_kit"), (std::set<std::string>{"ui_kit"})) << "widgets know nothing of the trainer";
}

TEST(TrainerFolders, EveryIncludeFollowsTheirList) {
  const Modules folders = trainer_folders();
  const auto files = source_files({kTrainer});
  ASSERT_GE(files.size(), 60U);
  std::vector<std::string> complaints;
  for (const auto& [path, text] : files) {
    const auto found = check_folder_includes(folders, kTrainer, path, text);
    complaints.insert(complaints.end(), found.begin(), found.end());
  }
  EXPECT_EQ(joined(complaints), "");
}

}  // namespace
}  // namespace trocar::architecture
