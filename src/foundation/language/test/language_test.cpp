#include "language/language.h"

#include <gtest/gtest.h>

#include "config/json.h"
#include "core/files/folders.h"
#include "core/files/output_file.h"

namespace trocar::language {
namespace {

/// A small catalogue, and texts with their translations by it.
Result<config::Json> shared_cases() {
  return config::load_json(data_dir().parent_path() / "src/foundation/language/test/cases.json");
}

Result<Language> parse(const std::string& text, const char* name = "de.json") {
  const TemporaryFolder folder;
  EXPECT_TRUE(write_file_atomically(folder / name, text));
  return Language::load(folder / name);
}

class LanguageTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto cases = shared_cases();
    ASSERT_TRUE(cases) << cases.error().text();
    const auto loaded =
        parse(R"({"language": "Deutsch", "decimal_sign": ",", "texts": )" + (*cases)["texts"].dump() + "}");
    ASSERT_TRUE(loaded) << loaded.error().text();
    german = *loaded;
  }
  Language german;
};

TEST_F(LanguageTest, ReadsCodeAndNameFromItsFile) {
  EXPECT_EQ(german.code(), "de");
  EXPECT_EQ(german.name(), "Deutsch");
  EXPECT_FALSE(german.is_english());
  EXPECT_TRUE(Language().is_english());
  EXPECT_EQ(Language().translate("Hold still. 3.5 mm"), "Hold still. 3.5 mm");
}

// The page's port of the algorithm (web/src/lib/catalogue.ts) is held against the same file.
TEST_F(LanguageTest, TranslatesTheSharedCases) {
  const auto cases = shared_cases();
  ASSERT_TRUE(cases) << cases.error().text();
  for (const auto& one : (*cases)["cases"])
    EXPECT_EQ(german.translate(one[0].get<std::string>()), one[1].get<std::string>());
  EXPECT_GT((*cases)["cases"].size(), 30u);
}

TEST_F(LanguageTest, TranslatesManySentences) {
  std::string english, expected;
  for (int n = 0; n < 40; ++n) english += "Hold still. ", expected += "Halten Sie still. ";
  EXPECT_EQ(german.translate(english), expected);
}

TEST_F(LanguageTest, ReportsUntranslatedWords) {
  EXPECT_FALSE(german.find("lumbar-3"));
  EXPECT_FALSE(german.find("passed lumbar-3"));
  EXPECT_FALSE(german.find("liver, lumbar-3"));
  EXPECT_EQ(german.find("passed liver"), "durch: Leber");
  EXPECT_EQ(german.find("3.5 mm"), "3,5 mm");
}

TEST_F(LanguageTest, TerminatesOnNestedTexts) {
  for (const std::string word : {"2", "liver", "x"}) {
    std::string text = word;
    for (int n = 0; n < 2000; ++n) text += " of " + word + (n % 3 == 0 ? ", " + word : "");
    EXPECT_FALSE(german.translate(text).empty());
    EXPECT_FALSE(german.translate(text.substr(0, 480)).empty());
  }
  EXPECT_FALSE(german.translate(std::string(10'000, '.')).empty());
  std::string mixed;
  for (int n = 0; n < 150; ++n) mixed += "a, b (c of d), e; f: g passed h. ";
  EXPECT_FALSE(german.translate(mixed).empty());
}

TEST_F(LanguageTest, TranslatesThePageAndNotItsCode) {
  EXPECT_EQ(
      translate_page(german,
                     "<html lang=\"en\"><style>liver{}</style><script>\"liver\"</script><p title=\"liver\">Needle "
                     "<b>2.5</b> &lt;x&gt;</p>liver"),
      "<html lang=\"de\"><style>liver{}</style><script>\"liver\"</script><p title=\"Leber\">Nadel "
      "<b>2,5</b> &lt;x&gt;</p>Leber");
  EXPECT_EQ(translate_page(Language(), "<p>liver</p>"), "<p>liver</p>");
  EXPECT_EQ(translate_page(german, "<p>liver"), "<p>Leber");
  const std::string given = "<td><span translate=\"no\">liver</span></td>";
  EXPECT_EQ(translate_page(german, given + "<p>liver</p>"), given + "<p>Leber</p>") << "a name that somebody gave";
  EXPECT_EQ(translate_page(german, "<p"), "<p");
}

TEST(Language, RefusesMalformedFiles) {
  const std::string head = R"({"language": "D", "decimal_sign": ",", "texts": {)";
  for (const std::string& text :
       {std::string("[]"), std::string("{}"), std::string(R"({"language": "D", "texts": {}})"),
        std::string(R"({"language": "D", "decimal_sign": ";", "texts": {}})"), head + R"("a {0}": "b"}})",
        head + R"("a": "b {0}"}})", head + R"("a {1}": "b {1}"}})", head + R"("{0}": "b {0}"}})", head + R"("a": ""}})",
        head + R"("a": 3}})", head + R"("a": "b", "a": "c"}})", head})
    EXPECT_FALSE(parse(text)) << text;
  EXPECT_FALSE(load_language("xx"));
  EXPECT_FALSE(load_language("../tasks/x"));
  EXPECT_TRUE(load_language("en"));
}

}  // namespace
}  // namespace trocar::language
