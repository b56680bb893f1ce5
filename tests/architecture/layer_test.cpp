// Holds every include of the source tree against src/modules.txt, and the checker itself against made-up trees.
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

const fs::path kTop = testing::source_dir();

std::string read(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

Modules modules_of(std::string_view text) {
  std::vector<std::string> complaints;
  Modules modules = parse_modules(text, complaints);
  EXPECT_EQ(joined(complaints), "");
  return modules;
}

const Modules& small_tree() {
  static const Modules modules = modules_of(
      "# a comment\n"
      "[low]\n"
      "core :  : expected\n"
      "volume : core : highway\n"
      "[high]\n"
      "io : volume : itk vtk-io : light : scene\n"
      "scene : volume : vtk-rendering : display\n");
  return modules;
}

std::string module_verdict(const std::string& path, std::string_view source) {
  return joined(check_includes(small_tree(), path, source));
}

TEST(ModuleList, NamesUsesAndLibrariesAreRead) {
  EXPECT_EQ(small_tree().size(), 4u);
  EXPECT_EQ(small_tree().at("io").uses, (std::set<std::string>{"volume"}));
  EXPECT_EQ(small_tree().at("io").libraries, (std::set<std::string>{"itk", "vtk-io"}));
}

TEST(ModuleList, ReportsMalformedAndDuplicateLines) {
  std::vector<std::string> complaints;
  parse_modules("above : :\n[low]\ncore : :\ncore : :\nvolume core\n[low]\nio : : : lite\na : : : : : b\n", complaints);
  EXPECT_EQ(complaints.size(), 6u) << joined(complaints);
}

TEST(Arrows, AreTransitive) {
  EXPECT_EQ(reachable(small_tree(), "io"), (std::set<std::string>{"io", "volume", "core"}));
  EXPECT_EQ(reachable(small_tree(), "core"), (std::set<std::string>{"core"}));
}

TEST(Arrows, DetectACycle) {
  EXPECT_EQ(check_arrows(small_tree()).size(), 0u);
  EXPECT_EQ(check_arrows(modules_of("[one]\na : b :\nb : c :\nc : a :\n")).size(), 3u);
  EXPECT_EQ(check_arrows(modules_of("[one]\na : a :\n")).size(), 1u);
}

TEST(Arrows, DetectAnArrowToAHigherTier) {
  EXPECT_EQ(check_arrows(modules_of("[low]\na : :\n[high]\nb : a :\n")).size(), 0u);
  EXPECT_EQ(check_arrows(modules_of("[low]\na : b :\n[high]\nb : :\n")).size(), 1u);
}

TEST(Arrows, DetectAnUnlistedDependency) {
  EXPECT_EQ(check_arrows(modules_of("[one]\na : b :\n")).size(), 1u);
}

TEST(Includes, AreReadWithTheirLines) {
  const auto includes =
      parse_includes("#pragma once\n  #  include <vector>\n#include \"core/log.h\"  // why\nint include;\n");
  ASSERT_EQ(includes.size(), 2u);
  EXPECT_EQ(includes[0].header, "vector");
  EXPECT_EQ(includes[0].line, 2);
  EXPECT_FALSE(includes[0].is_quoted);
  EXPECT_EQ(includes[1].header, "core/log.h");
  EXPECT_TRUE(includes[1].is_quoted);
}

TEST(Includes, DownwardArrowIsAllowed) {
  EXPECT_EQ(
      module_verdict("src/high/io/a.cpp", "#include \"core/a.h\"\n#include \"io/detail/b.h\"\n#include <vector>\n"),
      "");
  EXPECT_EQ(module_verdict("apps/cli/a.cpp", "#include \"io/a.h\"\n#include \"output.h\"\n"), "");
  EXPECT_EQ(module_verdict("apps/arguments/a.cpp", "#include \"core/a.h\"\n#include <CLI/CLI.hpp>\n"), "");
}

TEST(Includes, UpwardOrSidewardArrowIsRefused) {
  EXPECT_NE(module_verdict("src/low/core/a.cpp", "#include \"volume/grid.h\"\n"), "");
  EXPECT_NE(module_verdict("src/high/io/a.cpp", "#include \"scene/view.h\"\n"), "");
  EXPECT_NE(module_verdict("src/high/io/a.cpp", "#include \"bench/harness.h\"\n"), "");
}

TEST(Includes, HeaderWithoutItsModuleIsForTestsOnly) {
  EXPECT_EQ(module_verdict("src/high/io/test/a_test.cpp", "#include \"make_grids.h\"\n"), "");
  EXPECT_EQ(module_verdict("src/high/io/test/a_test.cpp", "#include \"scene/view.h\"\n"), "");  // for its tests only
  EXPECT_NE(module_verdict("src/high/io/a.cpp", "#include \"make_grids.h\"\n"), "");
}

TEST(Includes, ModuleInAnotherTiersFolderIsRefused) {
  EXPECT_NE(module_verdict("src/low/io/a.cpp", ""), "");
  EXPECT_NE(module_verdict("src/io.cpp", ""), "");
}

TEST(Includes, FolderOutsideTheListIsRefused) {
  EXPECT_NE(module_verdict("src/high/other/a.cpp", ""), "");
}

TEST(Includes, PrivateHeaderOfAnotherModuleIsRefused) {
  EXPECT_NE(module_verdict("src/high/io/a.cpp", "#include \"volume/detail/rows.h\"\n"), "");
  EXPECT_NE(module_verdict("apps/cli/a.cpp", "#include \"volume/detail/rows.h\"\n"), "");
}

TEST(Includes, LibraryBelongsToTheModuleThatListsIt) {
  EXPECT_EQ(module_verdict("src/high/io/a.cpp",
                           "#include <itkImage.h>\n#include <vtkXMLPolyDataReader.h>\n#include <vtkPolyData.h>\n"),
            "");
  EXPECT_NE(module_verdict("src/low/volume/a.cpp", "#include <itkImage.h>\n"), "");
  EXPECT_NE(module_verdict("src/high/io/a.cpp", "#include <hwy/highway.h>\n"), "");
  EXPECT_NE(module_verdict("src/high/io/a.cpp", "#include <vtkRenderer.h>\n"), "");
  EXPECT_NE(module_verdict("src/high/scene/a.cpp", "#include <vtkXMLPolyDataReader.h>\n"), "");
  EXPECT_NE(module_verdict("src/low/volume/a.cpp", "#include <CLI/CLI.hpp>\n"), "");
  EXPECT_NE(module_verdict("apps/cli/a.cpp", "#include <CLI/CLI.hpp>\n"), "");
  EXPECT_NE(module_verdict("apps/cli/a.cpp", "#include <soci/soci.h>\n"), "");
}

TEST(Includes, QtIsLimitedToTheTrainer) {
  EXPECT_EQ(module_verdict("apps/trainer/views/a.cpp", "#include <QWidget>\n"), "");
  EXPECT_NE(module_verdict("apps/trainer/views/a.cpp", "#include <QVTKOpenGLNativeWidget.h>\n"), "");
  EXPECT_NE(module_verdict("apps/trainer/views/a.cpp", "#include <vtkRenderWindow.h>\n"), "");
  EXPECT_NE(module_verdict("apps/cli/a.cpp", "#include <QString>\n"), "");
  EXPECT_NE(module_verdict("src/high/scene/a.cpp", "#include <QWidget>\n"), "");
}

TEST(Includes, TrainerFoldersAreLimitedToTheTrainer) {
  EXPECT_EQ(module_verdict("apps/trainer/views/a.cpp", "#include \"shell/theme.h\"\n#include \"io/a.h\"\n"), "");
  EXPECT_NE(module_verdict("apps/cli/a.cpp", "#include \"shell/theme.h\"\n"), "");
}

TEST(Includes, UnknownLibraryIsRefused) {
  EXPECT_NE(module_verdict("src/high/io/a.cpp", "#include <boost/any.hpp>\n"), "");
}

TEST(Includes, TestFrameworkStaysInTests) {
  EXPECT_EQ(module_verdict("src/high/io/test/a_test.cpp", "#include <gtest/gtest.h>\n"), "");
  EXPECT_NE(module_verdict("src/high/io/a.cpp", "#include <gtest/gtest.h>\n"), "");
}

TEST(ModuleReadme, HasTenToFortyLines) {
  const auto text = [](int count) {
    std::string lines;
    for (int i = 0; i < count; ++i) lines += "line\n";
    return lines;
  };
  EXPECT_TRUE(check_module_readme("io", text(10)).empty());
  EXPECT_TRUE(check_module_readme("io", text(40)).empty());
  EXPECT_FALSE(check_module_readme("io", text(9)).empty());
  EXPECT_FALSE(check_module_readme("io", text(41)).empty());
}

class Repository : public ::testing::Test {
 protected:
  const Modules modules_ = modules_of(read(kTop / "src/modules.txt"));
};

TEST_F(Repository, ArrowsOnlyGoDown) {
  ASSERT_GE(modules_.size(), 14u);
  EXPECT_EQ(joined(check_arrows(modules_)), "");
}

TEST_F(Repository, EveryIncludeFollowsTheModuleList) {
  const auto files = source_files({"src", "apps", "bench", "lab", "tests"});
  ASSERT_GE(files.size(), 60u);
  std::vector<std::string> complaints;
  for (const auto& [path, text] : files) {
    const auto found = check_includes(modules_, path, text);
    complaints.insert(complaints.end(), found.begin(), found.end());
  }
  EXPECT_EQ(joined(complaints), "");
}

TEST_F(Repository, FoldersMatchTheModuleList) {
  std::set<std::string> folders;
  for (const auto& tier : fs::directory_iterator(kTop / "src")) {
    if (!tier.is_directory()) continue;
    for (const auto& entry : fs::directory_iterator(tier.path()))
      folders.insert(fs::relative(entry.path(), kTop / "src").generic_string());
  }
  std::set<std::string> listed;
  for (const auto& [name, module] : modules_) listed.insert(module.tier + "/" + name);
  EXPECT_EQ(folders, listed);
}

TEST_F(Repository, EveryModuleIsDescribed) {
  const std::string architecture = read(kTop / "ARCHITECTURE.md");
  std::vector<std::string> complaints;
  for (const auto& [name, module] : modules_) {
    const auto found = check_module_readme(name, read(kTop / "src" / module.tier / name / "README.md"));
    complaints.insert(complaints.end(), found.begin(), found.end());
    if (architecture.find("`" + name + "`") == std::string::npos) {
      complaints.push_back("ARCHITECTURE.md does not name `" + name + "`");
    }
  }
  EXPECT_EQ(joined(complaints), "");
}

// In the locale of a Turkish user the small letter of 'I' is not 'i': a structure of that name would not be found.
TEST_F(Repository, LetterAndDigitChecksIgnoreTheLocale) {
  for (const auto& [path, text] : source_files({"src", "apps", "bench", "lab", "tests"}))
    for (const char* word : {"tolower", "toupper", "isalnum", "isalpha", "isdigit", "isspace", "isupper", "islower"})
      EXPECT_EQ(text.find(std::string(word) + '('), std::string::npos) << path << ": use core/text.h for " << word;
}

TEST_F(Repository, FilesStayBelowTheLineLimit) {
  for (const auto& [path, text] : source_files({"src", "apps", "bench", "lab", "tests"}))
    EXPECT_LE(count_lines(text), kMaxLines) << path;
}

}  // namespace
}  // namespace trocar::architecture
