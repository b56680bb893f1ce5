#include "dicom/segmentation/detail/contours.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "core/text.h"
#include "dicom/stack/slice_stack.h"

namespace trocar::dicom::detail {
namespace {

constexpr std::uint32_t kStructures = tag(0x3006, 0x0020);
constexpr std::uint32_t kStructureNumber = tag(0x3006, 0x0022);
constexpr std::uint32_t kStructureFrame = tag(0x3006, 0x0024);
constexpr std::uint32_t kStructureName = tag(0x3006, 0x0026);
constexpr std::uint32_t kContourLists = tag(0x3006, 0x0039);
constexpr std::uint32_t kContours = tag(0x3006, 0x0040);
constexpr std::uint32_t kGeometricType = tag(0x3006, 0x0042);
constexpr std::uint32_t kContourData = tag(0x3006, 0x0050);
constexpr std::uint32_t kReferencedStructure = tag(0x3006, 0x0084);

/// Ends of a curve that was not closed: assumed, a closed outline has no edge so much longer than its others.
constexpr double kOpenEnds_mm = 10.0;
constexpr double kOpenEnds = 10.0;  ///< Of the longest other edge.
constexpr std::size_t kMostNamed = 8;
constexpr const char* kExportStructureSetAgain = "export the structure set again";

std::optional<int> integer_of(const DicomItem& item, std::uint32_t tag) {
  return parse_number<int>(item.text(tag));
}

bool has_open_ends(const Contour& contour) {
  double longest_mm = 0.0;
  for (std::size_t n = 1; n < contour.size(); ++n)
    longest_mm = std::max(longest_mm, (contour[n] - contour[n - 1]).norm());
  const double ends_mm = (contour.back() - contour.front()).norm();
  return ends_mm > kOpenEnds_mm && ends_mm > kOpenEnds * longest_mm;
}

/// Structures with contours that enclose nothing: "Isocenter" (POINT), "catheter" (OPEN_PLANAR).
struct OpenContours {
  std::vector<std::string> names;

  void add(const std::string& name, std::string_view type) {
    std::string text = fmt::format("\"{}\" ({})", name, type);
    if (std::find(names.begin(), names.end(), text) == names.end()) names.push_back(std::move(text));
  }
  Status status(const std::string& where) const {
    if (names.empty()) return {};
    std::vector<std::string> first(names.begin(),
                                   names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), kMostNamed)));
    if (names.size() > first.size()) first.push_back(fmt::format("{} more", names.size() - first.size()));
    return fail(fmt::format("structures with open contours: {}", fmt::join(first, ", ")), where,
                "close their contours, or ignore them with ignore = [\"NAME\"] in a label map (--label-map)");
  }
};

/// All structures, wanted or not, by their numbers. What two of one number, or one without, own cannot be told.
Result<std::vector<ContourStructure>> read_names(const DicomItem& root, const std::string& where) {
  const std::string character_set(root.text(kCharacterSet));
  const auto items = root.items(kStructures);
  if (!items) return fail(items.error().what, where, items.error().advice);
  if (items->empty()) return fail("the structure set has no structure", where, kExportStructureSetAgain);
  std::vector<ContourStructure> structures;
  std::map<int, std::string> names;
  for (const DicomItem& item : *items) {
    std::string name = to_utf8(item.text(kStructureName), character_set);
    const std::optional<int> number = integer_of(item, kStructureNumber);
    if (!number)
      return fail(fmt::format("the structure \"{}\" has no number (ROINumber \"{}\")", name,
                              to_utf8(item.text(kStructureNumber), "none")),
                  where, kExportStructureSetAgain);
    if (const auto [other, is_new] = names.emplace(*number, name); !is_new)
      return fail(fmt::format("the structures \"{}\" and \"{}\" have the same number {} (ROINumber)", other->second,
                              name, *number),
                  where, kExportStructureSetAgain);
    ContourStructure& structure = structures.emplace_back();
    structure.segment = {*number, std::move(name)};
    structure.frame_of_reference = to_utf8(item.text(kStructureFrame), "none");
  }
  return structures;
}

/// Contours that belong to no structure.
tl::unexpected<Error> unknown_number(const DicomItem& list, std::size_t contours, const std::string& where) {
  const std::optional<int> number = integer_of(list, kReferencedStructure);
  const std::string of =
      number ? fmt::format("of the structure number {}, which the structure set does not define", *number)
             : std::string("without the number of a structure (ReferencedROINumber)");
  return fail(fmt::format("{} {}", contours == 1 ? "1 contour" : fmt::format("{} contours", contours), of), where,
              kExportStructureSetAgain);
}

/// Adds one contour to its structure.
Status add_contour(const DicomItem& item, ContourStructure& structure, OpenContours& open, const std::string& where) {
  const std::string_view type = item.text(kGeometricType);
  const std::vector<double> numbers = item.decimals(kContourData);
  if (numbers.empty() && item.text(kContourData).empty()) return {};
  const bool is_sane =
      std::all_of(numbers.begin(), numbers.end(), [](double mm) { return std::abs(mm) <= kFarthest_mm; });
  if (numbers.empty() || numbers.size() % 3 != 0 || !is_sane)
    return fail(fmt::format("a contour of \"{}\" has damaged points", structure.segment.name), where,
                kExportStructureSetAgain);
  Contour contour;
  for (std::size_t n = 0; n < numbers.size(); n += 3) contour.emplace_back(numbers[n], numbers[n + 1], numbers[n + 2]);
  if (type != "CLOSED_PLANAR" && type != "CLOSEDPLANAR_XOR" && type != "CLOSED_PLANAR_XOR") {
    open.add(structure.segment.name, type.empty() ? "no type" : to_utf8(type, "none"));
    return {};
  }
  if (contour.size() < 3)
    ++structure.degenerate;
  else if (has_open_ends(contour))
    open.add(structure.segment.name,
             fmt::format("{}, but its ends are {:.0f} mm apart", type, (contour.back() - contour.front()).norm()));
  else
    structure.contours.push_back(std::move(contour));
  structure.is_exclusive_or = structure.is_exclusive_or || type != "CLOSED_PLANAR";
  return {};
}

}  // namespace

Result<std::vector<ContourStructure>> read_contours(const DicomFile& file, const std::string& where,
                                                    const std::function<bool(const Segment&)>& is_wanted) {
  const DicomItem root = file.root();
  TROCAR_TRY(std::vector<ContourStructure> structures, read_names(root, where));
  std::map<int, ContourStructure*> by_number;
  for (ContourStructure& structure : structures) by_number[structure.segment.number] = &structure;
  std::set<int> wanted;
  for (const ContourStructure& structure : structures)
    if (is_wanted(structure.segment)) wanted.insert(structure.segment.number);
  const auto lists = root.items(kContourLists);
  if (!lists) return fail(lists.error().what, where, lists.error().advice);
  OpenContours open;
  for (const DicomItem& list : *lists) {
    const auto contours = list.items(kContours);
    if (!contours) return fail(contours.error().what, where, contours.error().advice);
    const std::optional<int> number = integer_of(list, kReferencedStructure);
    const auto found = number ? by_number.find(*number) : by_number.end();
    if (found == by_number.end()) {
      if (contours->empty()) continue;
      return unknown_number(list, contours->size(), where);
    }
    if (!wanted.contains(*number)) continue;
    for (const DicomItem& contour : *contours) TROCAR_TRY_STATUS(add_contour(contour, *found->second, open, where));
  }
  std::erase_if(structures, [&](const auto& structure) { return !wanted.contains(structure.segment.number); });
  TROCAR_TRY_STATUS(open.status(where));
  return structures;
}

}  // namespace trocar::dicom::detail
