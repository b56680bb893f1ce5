#include "web/static_files.h"

#include <fmt/format.h>

#include "core/files/folders.h"
#include "core/files/input_file.h"
#include "signing/token.h"

namespace trocar::web {
namespace {
namespace fs = std::filesystem;

constexpr FileLimit kPageFile{FileKind::kOther, "file of the page", std::uint64_t{8} << 20};
constexpr std::string_view kIndex = "/index.html";
constexpr std::size_t kEtagDigits = 32;

/// Empty: unknown.
std::string content_type_of(const fs::path& file) {
  static const std::map<std::string, std::string> types = {
      {".html", "text/html; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".ico", "image/x-icon"},
      {".woff2", "font/woff2"},
      {".json", "application/json; charset=utf-8"},
      {".txt", "text/plain; charset=utf-8"},
      {".webmanifest", "application/manifest+json"},
  };
  const auto found = types.find(file.extension().string());
  return found == types.end() ? std::string() : found->second;
}

bool has_ending(std::string_view path) {
  return path.substr(path.rfind('/') + 1).find('.') != std::string_view::npos;
}

}  // namespace

Result<StaticFiles> StaticFiles::load(const fs::path& folder) {
  StaticFiles page;
  for (const fs::path& path : list_tree(folder).value_or(std::vector<fs::path>())) {
    std::error_code gone;
    if (!fs::is_regular_file(path, gone)) continue;
    File file;
    file.content_type = content_type_of(path);
    if (file.content_type.empty())
      return fail("a file of the page has an unknown type", path.string(), "remove it, or reinstall Trocar");
    TROCAR_TRY(const InputFile input, InputFile::open(path, kPageFile, folder));
    TROCAR_TRY(std::string bytes, input.read_all());
    file.etag = fmt::format("\"{}\"", signing::sha256(bytes).substr(0, kEtagDigits));
    file.bytes = std::make_shared<const std::string>(std::move(bytes));
    page.files_[fmt::format("/{}", path.lexically_relative(folder).generic_string())] = std::move(file);
  }
  if (!page.files_.contains(kIndex))
    return fail("the page of trocar serve is missing", (folder / "index.html").string(), "reinstall Trocar");
  return page;
}

HttpAnswer StaticFiles::answer(const HttpRequest& request) const {
  const auto found = files_.find(has_ending(request.path) ? std::string_view(request.path) : kIndex);
  if (found == files_.end()) return error_answer(404, "there is no such page", "check the address");
  const File& file = found->second;
  HttpAnswer answer;
  const bool is_hashed = found->first.starts_with("/assets/");
  answer.headers = {{"ETag", file.etag},
                    {"Cache-Control", is_hashed ? "public, max-age=31536000, immutable" : "no-cache"}};
  if (request.find_header("if-none-match") == file.etag) {
    answer.status = 304;
    return answer;
  }
  answer.content_type = file.content_type;
  answer.body = file.bytes;
  return answer;
}

}  // namespace trocar::web
