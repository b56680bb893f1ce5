#pragma once

#include <array>
#include <map>
#include <set>
#include <string>
#include <string_view>

namespace trocar::dicom::detail {

/// Codes in place of texts: "series-01", "structure-02", "text-03". The same text has the same code as long as this
/// object exists, which is one fetch, so that a structure has one name in all its objects.
class TextCodes {
 public:
  enum class Kind { kSeries, kStructure, kOther };

  std::string code_of(Kind kind, std::string_view text);
  /// Notes a value that was removed without a code.
  void add_removed(std::string_view value);
  /// Different texts that were replaced or removed.
  std::size_t count(Kind kind) const;

 private:
  std::array<std::map<std::string, std::string, std::less<>>, 3> codes_;
  std::set<std::string, std::less<>> removed_;
};

}  // namespace trocar::dicom::detail
