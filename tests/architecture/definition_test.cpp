// Holds the names of all types against each other, and the checker itself against made-up sources.
#include <gtest/gtest.h>

#include "architecture/definitions.h"
#include "architecture/source_files.h"

namespace trocar::architecture {
namespace {

std::string names_of(std::string_view source) {
  std::string names;
  for (const TypeDefinition& type : find_type_definitions(source)) names += type.name + " ";
  return names;
}

std::string repeated(const std::string& a, const std::string& b) {
  return joined(find_repeated_types({{"a.h", a}, {"b.h", b}}));
}

TEST(TypeDefinitions, AreFoundWithTheirNamespacesAndEnclosingTypes) {
  EXPECT_EQ(names_of("namespace a::b { struct S { enum class E : int { kOne }; int n = 0; }; }"),
            "a::b::S a::b::S::E ");
  EXPECT_EQ(names_of("namespace a { inline namespace v1 { union U { int i; }; } }"), "a::v1::U ");
  EXPECT_EQ(names_of("template <class T, typename U> class alignas(64) C final : public B<T> {};"), "C ");
  EXPECT_EQ(names_of("struct Outer::Inner {};\nextern \"C\" { struct Plain {}; }"), "Outer::Inner Plain ");
  EXPECT_EQ(names_of("struct [[nodiscard]] S {};"), "S ");
}

TEST(TypeDefinitions, HaveLineNumbers) {
  const auto types = find_type_definitions("// struct A {};\n/* struct\nB {}; */\nstruct C\n{};\n");
  ASSERT_EQ(types.size(), 1u);
  EXPECT_EQ(types[0].name, "C");
  EXPECT_EQ(types[0].line, 5);
}

TEST(TypeDefinitions, ExcludeFileLocalTypes) {
  EXPECT_EQ(names_of("namespace { struct S {}; }\nnamespace a { namespace { class C {}; } }"), "");
  EXPECT_EQ(names_of("void f() { struct Local { int i; }; if (x) { enum E { k }; } }"), "");
  EXPECT_EQ(names_of("auto f = [](int) { struct Local {}; };"), "");
}

TEST(TypeDefinitions, ExcludeNonDefinitions) {
  EXPECT_EQ(names_of("struct S;\nenum class E : int;\nclass C *p = {};\nusing T = S;"), "");
  EXPECT_EQ(names_of("struct S f() { return {}; }\nvoid g(struct S* s) {}\ntemplate <class T> void h() {}"), "");
  EXPECT_EQ(names_of("template <> struct hash<S> { };\nstruct { int i; } nameless;"), "");
  EXPECT_EQ(names_of("const char* t = \"struct S {\"; char c = '{'; int n = 1'000; auto r = R\"x(struct R {)x\";"), "");
}

TEST(TypeDefinitions, UseTheFirstBranchOfAConditional) {
  EXPECT_EQ(
      names_of("#ifdef A\nstruct S {\n#else\nstruct S { int i;\n#endif\n};\n#define M \\\n  struct T {\nstruct U {};"),
      "S U ");
}

TEST(RepeatedTypes, AreReportedWithinOneNamespaceOnly) {
  EXPECT_EQ(repeated("namespace a { struct S {}; }", "namespace b { struct S {}; }"), "");
  EXPECT_EQ(repeated("namespace a { struct S {}; }", "namespace a { namespace { struct S {}; } }"), "");
  EXPECT_EQ(repeated("namespace a { struct S {}; }", "\nnamespace a { class S {}; }"),
            "a::S is defined at a.h:1 b.h:2\n");
}

TEST(RepeatedTypes, AreNowhereInTheRepository) {
  const auto files = source_files({"src", "apps", "bench", "lab"});
  std::size_t types = 0;
  for (const auto& [path, text] : files) types += find_type_definitions(text).size();
  EXPECT_GE(types, 500u) << "the search must see the sources";
  EXPECT_EQ(joined(find_repeated_types(files)), "");
}

}  // namespace
}  // namespace trocar::architecture
