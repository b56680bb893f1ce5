#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

/// Finds types with one qualified name and two definitions. Two such types in one program break the one-definition
/// rule: the linker keeps one of their inline functions and destructors for both.
namespace trocar::architecture {

/// Definition of a class, struct, union or enumeration outside of functions and anonymous namespaces.
struct TypeDefinition {
  std::string name;  ///< Qualified: "trocar::detail::Border".
  int line = 0;
};

/// All types that a C++ source defines. Reads text without a preprocessor: only the first branch of each #if is read.
/// Specialisations of templates are ignored.
std::vector<TypeDefinition> find_type_definitions(std::string_view source);

/// One line for each name that several files, or several places of one file, define. `sources`: path and text.
std::vector<std::string> find_repeated_types(const std::map<std::string, std::string>& sources);

}  // namespace trocar::architecture
