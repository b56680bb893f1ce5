// The sources that the documents name exist.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>

#include "architecture/source_files.h"
#include "core/testing/source_dir.h"

namespace trocar::architecture {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kFolders{"src",  "apps", "bench",   "lab",   "tests",
                                        "data", "docs", "scripts", "cmake", "web/src"};

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// All that a document may call a file or folder of ours: every end of its path, of a file also without its ending.
class KnownPaths {
 public:
  KnownPaths() {
    for (const std::string& folder : kFolders) {
      add(folder);
      for (const auto& entry : fs::recursive_directory_iterator(testing::source_dir() / folder)) {
        const fs::path path = fs::relative(entry.path(), testing::source_dir());
        add(path.generic_string());
        add((path.parent_path() / path.stem()).generic_string());
        if (path.extension() == ".md") documents_.push_back(entry.path());
      }
    }
    for (const char* name : {"README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "web/README.md"})
      documents_.push_back(testing::source_dir() / name);
  }
  bool has(const std::string& path) const { return ends_.contains(path); }
  const std::vector<fs::path>& documents() const { return documents_; }

 private:
  void add(std::string path) {
    ends_.insert(path);
    for (std::size_t slash = 0; (slash = path.find('/')) != std::string::npos; ends_.insert(path))
      path.erase(0, slash + 1);
  }

  std::set<std::string> ends_;
  std::vector<fs::path> documents_;
};

/// Names between backquotes that can only be a source or a folder of ours; decisions of the past may name former ones.
std::vector<std::string> named_paths(std::string text) {
  static const std::regex kQuoted("`([^`\n]+)`");
  static const std::regex kOwn(
      "[a-z0-9_./-]+/[a-z0-9_-]+\\.(h|cpp)|(src|apps|bench|lab|tests|scripts|cmake)/[a-z0-9_./-]+");
  constexpr std::string_view kFence = "```";
  for (std::size_t begin = 0; (begin = text.find(kFence, begin)) != std::string::npos;) {
    const std::size_t end = text.find(kFence, begin + kFence.size());
    text.erase(begin, end == std::string::npos ? end : end + kFence.size() - begin);
  }
  std::vector<std::string> paths;
  for (std::sregex_iterator found(text.begin(), text.end(), kQuoted), end; found != end; ++found) {
    std::string path = (*found)[1];
    if (!std::regex_match(path, kOwn)) continue;
    if (path.ends_with('/')) path.pop_back();
    paths.push_back(path);
  }
  return paths;
}

TEST(DocumentedPaths, Exist) {
  const KnownPaths known;
  EXPECT_TRUE(known.has("core/text.h") && known.has("src/foundation/core/text") && !known.has("core/no_text.h"));
  EXPECT_EQ(named_paths("`core/text.h` and `a.h`, `src/NAME` or\n```\n`core/x.h`\n```").size(), 1u);
  std::vector<std::string> complaints;
  std::size_t count = 0;
  for (const fs::path& document : known.documents()) {
    if (document.parent_path().filename() == "adr") continue;
    for (const std::string& path : named_paths(text_of(document))) {
      ++count;
      if (!known.has(path)) complaints.push_back(document.filename().string() + " names " + path);
    }
  }
  EXPECT_EQ(joined(complaints), "");
  EXPECT_GT(count, 300u);
}

}  // namespace
}  // namespace trocar::architecture
