#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

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
