#include "architecture/layers.h"

#include <algorithm>
#include <array>
#include <optional>
#include <sstream>

namespace trocar::architecture {
namespace {

constexpr int kMinReadmeLines = 10;
constexpr int kMaxReadmeLines = 40;

std::set<std::string> words(const std::string& text) {
  std::istringstream stream(text);
  std::set<std::string> result;
  for (std::string word; stream >> word;) result.insert(word);
  return result;
}

std::vector<std::string> lines(std::string_view text) {
  std::istringstream stream{std::string(text)};
  std::vector<std::string> result;
  for (std::string line; std::getline(stream, line);) result.push_back(line);
  return result;
}

/// Which libraries of modules.txt give leave to include the headers with a prefix. The first match counts.
struct HeaderRule {
  std::string_view prefix;
  std::vector<std::string_view> libraries;
};

const std::vector<HeaderRule>& header_rules() {
  static const std::vector<HeaderRule> rules = [] {
    const std::vector<std::string_view> any_vtk = {"vtk-filters", "vtk-io", "vtk-rendering"};
    std::vector<HeaderRule> r = {
        {"tl/", {"expected"}},
        {"spdlog/", {"spdlog"}},
        {"xxhash.h", {"xxhash"}},
        {"xxh3.h", {"xxhash"}},
        {"tbb/", {"tbb"}},
        {"oneapi/", {"tbb"}},
        {"toml", {"toml++"}},
        {"nlohmann/", {"json"}},
        {"hwy/", {"highway"}},
        {"itk", {"itk", "itk-registration"}},
        {"gdcm", {"itk"}},
        {"nifti1_io.h", {"itk"}},
        {"png.h", {"png"}},
        {"xraylib", {"xraylib"}},
        {"soci/", {"soci"}},
        {"sqlite3.h", {"soci"}},
        {"libpq-fe.h", {"soci"}},
        {"X11/", {"vtk-rendering"}},
        {"vtkXML", {"vtk-io"}},
        {"vtkSTL", {"vtk-io"}},
        {"zmq", {"zeromq"}},
        {"sodium", {"sodium"}},
        {"flatbuffers/", {"flatbuffers"}},
        {"SDL", {"sdl2"}},
        {"spnav.h", {"spnav"}},
        {"boost/", {"boost"}},
        {"dcmtk/", {"dcmtk"}},
        {"httplib.h", {"httplib"}},
        {"openssl/", {"httplib"}},
    };
    for (const std::string_view rendering :
         {"vtkActor", "vtkCamera", "vtkLight", "vtkOpenGL", "vtkPolyDataMapper", "vtkProp", "vtkRender", "vtkShader",
          "vtkText", "vtkVolume", "vtkWindow.", "vtkWindowToImage"}) {
      r.push_back({rendering, {"vtk-rendering"}});
    }
    for (const std::string_view data :
         {"vtkCell",       "vtkCommand",    "vtkData",         "vtkDoubleArray", "vtkErrorCode",
          "vtkFloatArray", "vtkIdList",     "vtkIdTypeArray",  "vtkImageData",   "vtkMath",
          "vtkNew",        "vtkObject",     "vtkOutputWindow", "vtkPoint",       "vtkPolyData.",
          "vtkPolyLine",   "vtkShortArray", "vtkSmartPointer", "vtkType",        "vtkUnsignedCharArray",
          "vtkVersion"}) {
      r.push_back({data, any_vtk});
    }
    r.push_back({"vtk", {"vtk-filters", "vtk-rendering"}});
    return r;
  }();
  return rules;
}

/// Vocabulary of the whole source tree, C and POSIX headers, and the test framework (in tests only).
bool is_vocabulary(std::string_view header) {
  return header.starts_with("Eigen/") || header.starts_with("fmt/");
}

bool is_system(std::string_view header) {
  static const std::set<std::string_view> posix = {"stdlib.h",    "locale.h",  "dlfcn.h",  "link.h",      "fcntl.h",
                                                   "poll.h",      "pthread.h", "malloc.h", "sched.h",     "signal.h",
                                                   "spawn.h",     "strings.h", "unistd.h", "semaphore.h", "time.h",
                                                   "immintrin.h", "termios.h", "fnmatch.h"};
  const bool is_standard = header.find_first_of("/.") == std::string_view::npos;
  return is_standard || header.starts_with("sys/") || header.starts_with("netinet/") || header.starts_with("arpa/") ||
         header.starts_with("sanitizer/") || posix.contains(header);
}

/// Qt's classes and its bridge to VTK.
bool is_qt(std::string_view header) {
  if (header.starts_with("QVTK")) return false;  // VTK's bridge: what draws it would draw the whole window by OpenGL
  return header.size() > 1 && header[0] == 'Q' && header[1] >= 'A' && header[1] <= 'Z' &&
         header.find('/') == std::string_view::npos;
}

bool is_test_framework(std::string_view header) {
  return header.starts_with("gtest/") || header.starts_with("gmock/");
}

/// Where a file belongs and what it may use.
struct Place {
  std::string module;  ///< Empty for programs, benchmarks and tests over several modules: they may use every module.
  std::set<std::string> modules;
  std::set<std::string> libraries;
  bool is_program = false;
  bool has_arguments = false;
  bool has_window = false;  ///< The trainer: the only one to use Qt.
  bool is_test = false;
  bool is_bench = false;
  bool is_lab = false;  ///< lab/MODULE: what only benchmarks and tests call.
};

std::optional<Place> find_place(const Modules& modules, const std::string& path) {
  Place place;
  place.is_test = path.starts_with("tests/") || path.find("/test/") != std::string::npos ||
                  path.find("/testing/") != std::string::npos;
  place.is_bench = path.starts_with("bench/");
  place.is_program = path.starts_with("apps/");
  place.has_arguments = path.starts_with("apps/arguments/");
  place.has_window = path.starts_with("apps/trainer/");
  if (path.starts_with("lab/")) {
    place.module = path.substr(4, path.find('/', 4) - 4);
    const auto found = modules.find(place.module);
    if (found == modules.end()) return std::nullopt;
    place.modules = reachable(modules, place.module);
    place.libraries = found->second.libraries;
    place.is_lab = true;
    return place;
  }
  if (path.starts_with("src/")) {
    const std::size_t behind_tier = path.find('/', 4);
    if (behind_tier == std::string::npos) return std::nullopt;
    const std::size_t begin = behind_tier + 1;
    place.module = path.substr(begin, path.find('/', begin) - begin);
    const auto found = modules.find(place.module);
    if (found == modules.end() || found->second.tier != path.substr(4, behind_tier - 4)) return std::nullopt;
    place.modules = reachable(modules, place.module);
    if (place.is_test)
      for (const std::string& use : found->second.test_uses) place.modules.merge(reachable(modules, use));
    place.libraries = found->second.libraries;
    return place;
  }
  for (const auto& [name, module] : modules) place.modules.insert(name);
  if (place.is_bench) place.libraries = {"vtk-filters", "vtk-rendering"};  // peers to be measured beside our kernels
  return place;
}

std::optional<std::string> complaint_about_ours(const Place& place, const std::string& header) {
  const auto slash = header.find('/');
  if (slash == std::string::npos) {
    if (place.module.empty() || place.is_test) return std::nullopt;  // a program's or a test's own header beside it
    return "write the module in front: \"" + place.module + "/" + header + "\"";
  }
  const std::string target = header.substr(0, slash);
  if ((target == "bench" || target == "cli") && (place.is_bench || place.is_program)) return std::nullopt;
  if (target == "lab") {
    const std::string lab = header.substr(slash + 1, header.find('/', slash + 1) - slash - 1);
    if (place.is_bench || (place.is_test && place.module.empty())) return std::nullopt;
    if ((place.is_lab || place.is_test) && place.modules.contains(lab)) return std::nullopt;
    return "laboratory code is for benchmarks, tests and itself";
  }
  if (place.module.empty() && (place.is_test || place.has_window) && !place.modules.contains(target))
    return std::nullopt;  // a folder beside it, of the same program
  if (!place.modules.contains(target)) return "module " + target + " is not below it in src/modules.txt";
  if (header.find("/detail/") != std::string::npos && target != place.module) return "detail/ is private to " + target;
  return std::nullopt;
}

std::optional<std::string> complaint_about_theirs(const Place& place, const std::string& header) {
  if (is_qt(header)) {
    return place.has_window ? std::nullopt : std::optional<std::string>("Qt belongs to apps/trainer alone");
  }
  if (is_system(header) || is_vocabulary(header)) return std::nullopt;
  if (is_test_framework(header)) {
    return place.is_test ? std::nullopt : std::optional<std::string>("a test framework outside of tests");
  }
  if (header.starts_with("CLI/")) {
    return place.has_arguments ? std::nullopt : std::optional<std::string>("CLI11 belongs to apps/arguments alone");
  }
  for (const HeaderRule& rule : header_rules()) {
    if (!header.starts_with(rule.prefix)) continue;
    const bool is_allowed = std::any_of(rule.libraries.begin(), rule.libraries.end(), [&](std::string_view library) {
      return place.libraries.contains(std::string(library));
    });
    if (is_allowed) return std::nullopt;
    return "library " + std::string(rule.libraries.front()) + " is not listed for it in src/modules.txt";
  }
  return "of no library that the layer test knows";
}

}  // namespace

Modules parse_modules(std::string_view text, std::vector<std::string>& complaints) {
  Modules modules;
  std::string tier;
  std::set<std::string> tiers;
  for (const std::string& line : lines(text)) {
    if (line.empty() || line.front() == '#') continue;
    if (line.front() == '[' && line.back() == ']') {
      tier = line.substr(1, line.size() - 2);
      if (!tiers.insert(tier).second) complaints.push_back("src/modules.txt: [" + tier + "] is listed twice");
      continue;
    }
    std::vector<std::string> fields;
    std::istringstream stream(line + " ");
    for (std::string field; std::getline(stream, field, ':');) fields.push_back(field);
    const std::set<std::string> names = fields.empty() ? std::set<std::string>{} : words(fields[0]);
    if (fields.size() < 3 || fields.size() > 5 || names.size() != 1 || tier.empty()) {
      complaints.push_back(
          "src/modules.txt: not \"name : uses : libraries [: traits [: uses of tests]]\" below a [tier]: " + line);
      continue;
    }
    fields.resize(5);
    const std::string& name = *names.begin();
    const int level = static_cast<int>(tiers.size());
    if (!modules.emplace(name, Module{tier, level, name, words(fields[1]), words(fields[2]), words(fields[4])})
             .second) {
      complaints.push_back("src/modules.txt: " + name + " is listed twice");
    }
    static const std::set<std::string> known_traits = {"light", "sanitized", "pointers", "display", "embedded", "long"};
    for (const std::string& trait : words(fields[3]))
      if (!known_traits.contains(trait)) complaints.push_back("src/modules.txt: " + name + " has no trait " + trait);
  }
  return modules;
}

std::set<std::string> reachable(const Modules& modules, const std::string& name) {
  std::set<std::string> seen;
  std::vector<std::string> open = {name};
  while (!open.empty()) {
    const std::string next = open.back();
    open.pop_back();
    if (!seen.insert(next).second) continue;
    if (const auto found = modules.find(next); found != modules.end()) {
      open.insert(open.end(), found->second.uses.begin(), found->second.uses.end());
    }
  }
  return seen;
}

std::vector<std::string> check_arrows(const Modules& modules) {
  std::vector<std::string> complaints;
  for (const auto& [name, module] : modules) {
    for (const std::string& use : module.uses) {
      if (!modules.contains(use)) {
        complaints.push_back(name + " uses " + use + ", which is not listed");
      } else if (reachable(modules, use).contains(name)) {
        complaints.push_back(name + " uses " + use + ", which uses " + name + ": a cycle");
      } else if (modules.at(use).level > module.level) {
        complaints.push_back(name + " in " + module.tier + " uses " + use + " of the higher tier " +
                             modules.at(use).tier);
      }
    }
  }
  return complaints;
}

std::vector<Include> parse_includes(std::string_view source) {
  std::vector<Include> includes;
  int number = 0;
  for (const std::string& line : lines(source)) {
    ++number;
    std::size_t at = line.find_first_not_of(" \t");
    if (at == std::string::npos || line[at] != '#') continue;
    at = line.find_first_not_of(" \t", at + 1);
    if (at == std::string::npos || line.compare(at, 7, "include") != 0) continue;
    const std::size_t open = line.find_first_of("<\"", at + 7);
    if (open == std::string::npos) continue;
    const std::size_t close = line.find(line[open] == '<' ? '>' : '"', open + 1);
    if (close == std::string::npos) continue;
    includes.push_back({line.substr(open + 1, close - open - 1), line[open] == '"', number});
  }
  return includes;
}

std::vector<std::string> check_includes(const Modules& modules, const std::string& path, std::string_view source) {
  const std::optional<Place> place = find_place(modules, path);
  if (!place) return {path + ": its folder is not a module of src/modules.txt"};
  std::vector<std::string> complaints;
  for (const Include& include : parse_includes(source)) {
    const auto complaint = include.is_quoted ? complaint_about_ours(*place, include.header)
                                             : complaint_about_theirs(*place, include.header);
    if (complaint) {
      complaints.push_back(path + ":" + std::to_string(include.line) + ": " + include.header + ": " + *complaint);
    }
  }
  return complaints;
}

std::vector<std::string> check_folder_includes(const Modules& folders, const std::string& top, const std::string& path,
                                               std::string_view source) {
  if (!path.starts_with(top + "/")) return {};
  const std::string below = path.substr(top.size() + 1);
  const std::size_t slash = below.find('/');
  const std::string folder = below.substr(0, slash);
  if (slash == std::string::npos || folder == "test") return {};
  if (!folders.contains(folder)) return {path + ": its folder is not in " + top + "/folders.txt"};
  const std::set<std::string> allowed = reachable(folders, folder);
  std::vector<std::string> complaints;
  for (const Include& include : parse_includes(source)) {
    const std::string target = include.header.substr(0, include.header.find('/'));
    if (!include.is_quoted || !folders.contains(target) || allowed.contains(target)) continue;
    complaints.push_back(path + ":" + std::to_string(include.line) + ": " + include.header + ": folder " + target +
                         " is not below " + folder + " in " + top + "/folders.txt");
  }
  return complaints;
}

std::vector<std::string> check_module_readme(const std::string& module, std::string_view text) {
  const int count = count_lines(text);
  if (count >= kMinReadmeLines && count <= kMaxReadmeLines) return {};
  return {"README.md of " + module + " has " + std::to_string(count) +
          " lines; 10 to 40, with an example, tell enough"};
}

int count_lines(std::string_view text) {
  return static_cast<int>(lines(text).size());
}

}  // namespace trocar::architecture
