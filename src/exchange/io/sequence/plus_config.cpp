#include "io/sequence/plus_config.h"

#include <fmt/format.h>
#include <vtkObjectFactory.h>
#include <vtkSmartPointer.h>
#include <vtkXMLParser.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/files/input_file.h"
#include "core/result.h"
#include "io/detail/number_text.h"

namespace trocar::io::detail {

/// An element of an XML document; text between elements is ignored.
struct XmlElement {
  std::string path;  ///< Names from the root, separated by "/": "PlusConfiguration/VolumeReconstruction".
  std::map<std::string, std::string, std::less<>> attributes;
};

/// All elements in the order of the document: a flat list, so that deep nesting cannot exhaust the stack. Errors
/// (without a place): not XML, a document type, nested deeper than 32, more than 100,000 elements.
Result<std::vector<XmlElement>> parse_xml(std::string_view text);

}  // namespace trocar::io::detail

namespace trocar::io {
namespace fs = std::filesystem;
namespace {

using detail::XmlElement;

std::optional<std::string_view> find_attribute(const XmlElement& element, std::string_view name) {
  const auto found = element.attributes.find(name);
  return found == element.attributes.end() ? std::nullopt : std::optional<std::string_view>(found->second);
}

template <class Value>
struct Choice {
  std::string_view name;
  Value value;
};

/// Sets `value` from its attribute, if present.
template <class Value, std::size_t N>
Status take_choice(const XmlElement& element, std::string_view name, const std::array<Choice<Value>, N>& choices,
                   Value& value) {
  const auto text = find_attribute(element, name);
  if (!text) return {};
  for (const Choice<Value>& choice : choices) {
    if (*text != choice.name) continue;
    value = choice.value;
    return {};
  }
  std::string names;
  for (const Choice<Value>& choice : choices) names += (names.empty() ? "" : ", ") + std::string(choice.name);
  return fail(fmt::format("{} {}=\"{}\" is not known", element.path, name, *text), {}, "use one of " + names);
}

/// The numbers of the attribute, if present: exactly N.
template <std::size_t N>
Result<std::optional<std::array<double, N>>> numbers_of(const XmlElement& element, std::string_view name) {
  const auto text = find_attribute(element, name);
  if (!text) return std::nullopt;
  const auto numbers = detail::find_numbers(*text, N);
  if (!numbers || numbers->size() != N)
    return fail(fmt::format("{} {}=\"{}\" does not give {} numbers", element.path, name, *text, N), std::string(name),
                "correct the attribute");
  std::array<double, N> values{};
  std::copy(numbers->begin(), numbers->end(), values.begin());
  return values;
}

Status take_number(const XmlElement& element, std::string_view name, double& value) {
  TROCAR_TRY(const auto number, numbers_of<1>(element, name));
  if (number) value = number->front();
  return {};
}

Status take_whole_number(const XmlElement& element, std::string_view name, int& value) {
  double number = value;
  TROCAR_TRY_STATUS(take_number(element, name, number));
  if (std::abs(number) > 1e6 || number != std::floor(number))
    return fail(fmt::format("{} {}=\"{}\" is not a whole number", element.path, name, number), std::string(name),
                "correct the attribute");
  value = static_cast<int>(number);
  return {};
}

Status take_transform(const XmlElement& element, ultrasound::TrackedSequence::Transforms& transforms) {
  const auto from = find_attribute(element, "From"), to = find_attribute(element, "To");
  const auto matrix = find_attribute(element, "Matrix");
  if (!from || !to || !matrix || from->empty() || to->empty())
    return fail("a <Transform> lacks From, To or Matrix", "CoordinateDefinitions", "add the attribute");
  const std::string name = fmt::format("{}To{}", *from, *to);
  const auto parsed = detail::parse_matrix(*matrix);
  if (!parsed)
    return fail(fmt::format("the matrix of {} {}", name, parsed.error().what), "CoordinateDefinitions",
                "give 16 numbers with the last row 0 0 0 1");
  transforms.insert_or_assign(name, *parsed);
  return {};
}

Status take_rectangle(const XmlElement& element, ultrasound::FreehandOptions& options) {
  TROCAR_TRY(const auto origin, numbers_of<2>(element, "ClipRectangleOrigin"));
  TROCAR_TRY(const auto size, numbers_of<2>(element, "ClipRectangleSize"));
  if (!origin || !size || (*size)[0] <= 0.0 || (*size)[1] <= 0.0) return {};  // PLUS: 0 0 means no clipping
  const auto pixels = [](double value) { return static_cast<int>(std::clamp(std::floor(value), -1e6, 1e6)); };
  options.rectangle =
      ultrasound::ClipRectangle{pixels((*origin)[0]), pixels((*origin)[1]), pixels((*size)[0]), pixels((*size)[1])};
  return {};
}

Status take_fan(const XmlElement& element, ultrasound::FreehandOptions& options) {
  TROCAR_TRY(const auto angles_deg, numbers_of<2>(element, "FanAnglesDeg"));
  TROCAR_TRY(const auto origin_px, numbers_of<2>(element, "FanOriginPixel"));
  if (!angles_deg || !origin_px || (*angles_deg)[0] == (*angles_deg)[1]) return {};  // PLUS: 0 0 means no fan
  ultrasound::ClipFan fan;
  fan.origin_column = (*origin_px)[0];
  fan.origin_row = (*origin_px)[1];
  fan.first_angle_rad = (*angles_deg)[0] * kRadPerDeg;
  fan.last_angle_rad = (*angles_deg)[1] * kRadPerDeg;
  TROCAR_TRY_STATUS(take_number(element, "FanRadiusStartPixel", fan.first_radius_px));
  TROCAR_TRY_STATUS(take_number(element, "FanRadiusStopPixel", fan.last_radius_px));
  options.fan = fan;
  return {};
}

/// Attributes of <VolumeReconstruction> that change the result but are not supported.
void note_what_is_left_aside(const XmlElement& element, std::vector<std::string>& left_aside) {
  for (const char* name : {"OutputOrigin", "OutputExtent", "EnableFanAnglesAutoDetect", "SkipInterval", "FanAngles"})
    if (const auto text = find_attribute(element, name); text && *text != "FALSE" && *text != "1")
      left_aside.push_back(fmt::format("{}=\"{}\"", name, *text));
}

Status take_reconstruction(const XmlElement& element, PlusConfig& config, bool& is_filling) {
  constexpr std::array<Choice<ultrasound::FreehandInterpolation>, 2> kInterpolations{
      {{"NEAREST_NEIGHBOR", ultrasound::FreehandInterpolation::kNearest},
       {"LINEAR", ultrasound::FreehandInterpolation::kLinear}}};
  constexpr std::array<Choice<ultrasound::FreehandCompounding>, 3> kCompoundings{
      {{"MEAN", ultrasound::FreehandCompounding::kMean},
       {"MAXIMUM", ultrasound::FreehandCompounding::kMaximum},
       {"LATEST", ultrasound::FreehandCompounding::kLatest}}};
  constexpr std::array<Choice<bool>, 2> kSwitch{{{"ON", true}, {"OFF", false}}};
  ultrasound::FreehandOptions& options = config.reconstruction;
  config.has_reconstruction = true;
  if (const auto name = find_attribute(element, "ImageCoordinateFrame")) options.image_frame = *name;
  if (const auto name = find_attribute(element, "ReferenceCoordinateFrame")) options.reference_frame = *name;
  TROCAR_TRY(const auto spacing_mm, numbers_of<3>(element, "OutputSpacing"));
  if (spacing_mm) options.spacing_mm = Vec3((*spacing_mm)[0], (*spacing_mm)[1], (*spacing_mm)[2]);
  TROCAR_TRY_STATUS(take_choice(element, "Interpolation", kInterpolations, options.interpolation));
  TROCAR_TRY_STATUS(take_choice(element, "CompoundingMode", kCompoundings, options.compounding));
  TROCAR_TRY_STATUS(take_choice(element, "FillHoles", kSwitch, is_filling));
  TROCAR_TRY_STATUS(take_number(element, "PixelRejectionThreshold", options.least_gray));
  TROCAR_TRY_STATUS(take_rectangle(element, options));
  note_what_is_left_aside(element, config.left_aside);
  return take_fan(element, options);
}

Status take_hole_filling(const XmlElement& element, PlusConfig& config) {
  using Kind = ultrasound::HoleFilling::Kind;
  constexpr std::array<Choice<Kind>, 3> kKinds{
      {{"STICK", Kind::kStick}, {"NEAREST_NEIGHBOR", Kind::kNearest}, {"GAUSSIAN", Kind::kGaussian}}};
  ultrasound::HoleFilling way;
  TROCAR_TRY_STATUS(take_choice(element, "Type", kKinds, way.kind));
  TROCAR_TRY_STATUS(take_whole_number(element, "StickLengthLimit", way.stick_length_limit));
  TROCAR_TRY_STATUS(take_whole_number(element, "NumberOfSticksToUse", way.sticks));
  TROCAR_TRY_STATUS(take_whole_number(element, "Size", way.size));
  TROCAR_TRY_STATUS(take_number(element, "Stdev", way.sigma_voxels));
  TROCAR_TRY_STATUS(take_number(element, "MinimumKnownVoxelsRatio", way.least_share));
  config.reconstruction.holes.push_back(way);
  return {};
}

Result<PlusConfig> config_of(const std::vector<XmlElement>& elements) {
  if (elements.front().path != "PlusConfiguration")
    return fail("is not a PLUS configuration", "root element", "give a PlusDeviceSet XML file");
  PlusConfig config;
  bool is_filling = false;
  for (const XmlElement& element : elements) {
    if (element.path == "PlusConfiguration/CoordinateDefinitions/Transform")
      TROCAR_TRY_STATUS(take_transform(element, config.transforms));
    if (element.path == "PlusConfiguration/VolumeReconstruction")
      TROCAR_TRY_STATUS(take_reconstruction(element, config, is_filling));
    if (element.path == "PlusConfiguration/VolumeReconstruction/HoleFilling/HoleFillingElement")
      TROCAR_TRY_STATUS(take_hole_filling(element, config));
  }
  if (!is_filling) config.reconstruction.holes.clear();
  return config;
}

}  // namespace

Result<PlusConfig> read_plus_config(const fs::path& path) {
  constexpr const char* kNeeded = "give the PlusDeviceSet_....xml of the calibrated probe";
  TROCAR_TRY(const std::string text, read_input(path, FileKind::kXml));
  auto elements = detail::parse_xml(text);
  if (!elements) return fail(elements.error().what, path.string(), kNeeded);
  auto config = config_of(*elements);
  if (config) return config;
  return fail(config.error().what, path.string(), config.error().advice.empty() ? kNeeded : config.error().advice);
}

}  // namespace trocar::io

namespace trocar::io::detail {
namespace {

constexpr std::size_t kMaxElementDepth = 32;
constexpr std::size_t kMaxElements = 100'000;

/// Collects elements while VTK's parser (expat) reads the text.
class Collector : public vtkXMLParser {
 public:
  static Collector* New();
  vtkTypeMacro(Collector, vtkXMLParser);
  Collector(const Collector&) = delete;
  void operator=(const Collector&) = delete;

  std::vector<XmlElement> elements;
  bool is_too_much = false;
  std::optional<long long> error_byte;

 protected:
  Collector() = default;
  ~Collector() override = default;

  void StartElement(const char* name, const char** attributes) override {
    open_.emplace_back(name);
    is_too_much = is_too_much || open_.size() > kMaxElementDepth || elements.size() >= kMaxElements;
    if (is_too_much) return;
    XmlElement element;
    for (const std::string& part : open_) element.path += (element.path.empty() ? "" : "/") + part;
    for (; attributes[0] != nullptr; attributes += 2) element.attributes.insert_or_assign(attributes[0], attributes[1]);
    elements.push_back(std::move(element));
  }
  void EndElement(const char*) override { open_.pop_back(); }
  void ReportXmlParseError() override { error_byte = static_cast<long long>(GetXMLByteIndex()); }

 private:
  std::vector<std::string> open_;
};

vtkStandardNewMacro(Collector);

}  // namespace

Result<std::vector<XmlElement>> parse_xml(std::string_view text) {
  // Entities can expand a few bytes to gigabytes; configurations have none.
  if (text.find("<!DOCTYPE") != std::string_view::npos || text.find("<!ENTITY") != std::string_view::npos)
    return fail("has a document type of its own", {}, "remove the <!DOCTYPE ...>");
  vtkObject::SetGlobalWarningDisplay(0);
  const auto parser = vtkSmartPointer<Collector>::New();
  const int is_parsed = parser->Parse(text.data(), static_cast<unsigned>(text.size()));
  if (parser->is_too_much)
    return fail("is nested too deeply or has too many elements", "XML",
                "reduce the file to the elements that Trocar reads");
  if (parser->error_byte)
    return fail(fmt::format("is not well-formed XML at byte {}", *parser->error_byte), "XML", "correct the XML there");
  if (is_parsed == 0 || parser->elements.empty()) return fail("is not an XML document", "XML", "give an XML file");
  return std::move(parser->elements);
}

}  // namespace trocar::io::detail
