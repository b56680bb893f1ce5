#include "io/sequence/detail/xml_elements.h"

#include <fmt/format.h>
#include <vtkObjectFactory.h>
#include <vtkSmartPointer.h>
#include <vtkXMLParser.h>

#include <optional>

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
