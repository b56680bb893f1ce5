#include "architecture/source_files.h"

#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/testing/source_dir.h"
#include "core/text.h"

namespace trocar::architecture {

std::map<std::string, std::string> source_files(const std::vector<std::string>& folders) {
  namespace fs = std::filesystem;
  const fs::path top = testing::source_dir();
  std::map<std::string, std::string> files;
  for (const std::string& folder : folders) {
    for (const auto& entry : fs::recursive_directory_iterator(top / folder)) {
      const fs::path& path = entry.path();
      if (path.extension() != ".h" && path.extension() != ".cpp") continue;
      std::ifstream file(path, std::ios::binary);
      files[fs::relative(path, top).generic_string()] = {std::istreambuf_iterator<char>(file),
                                                         std::istreambuf_iterator<char>()};
    }
  }
  return files;
}

bool is_word(char c) {
  return ascii::is_letter_or_digit(c) || c == '_';
}

std::string joined(const std::vector<std::string>& complaints) {
  std::string text;
  for (const std::string& complaint : complaints) text += complaint + "\n";
  return text;
}

}  // namespace trocar::architecture
