#include "language/language.h"

#include <gtest/gtest.h>

#include "core/files/atomic_file.h"
#include "core/files/temporary_folder.h"

namespace trocar::language {
namespace {

constexpr const char* kGerman = R"({"language": "Deutsch", "decimal_sign": ",", "texts": {
  "liver": "Leber", "hepatic veins": "Lebervenen", "Needle": "Nadel", "breath held": "Atem angehalten",
  "Hold still": "Halten Sie still", "advance slowly": "schieben Sie langsam vor",
  "{0} of {1}": "{0} von {1}", "Needle {0} mm from {1}": "{1}: Nadel {0} mm entfernt",
  "passed {0}": "durch: {0}", "{0} passed {1} after {2} s": "{0}: {1} nach {2} s durchstochen"}})";

Result<Language> parse(const std::string& text, const char* name = "de.json") {
  const TemporaryFolder folder;
  EXPECT_TRUE(write_file_atomically(folder / name, text));
  return Language::load(folder / name);
}

class LanguageTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto loaded = parse(kGerman);
    ASSERT_TRUE(loaded) << loaded.error().text();
    german = *loaded;
  }
  Language german;
};

TEST_F(LanguageTest, IsWhatItsFileSays) {
  EXPECT_EQ(german.code(), "de");
  EXPECT_EQ(german.name(), "Deutsch");
  EXPECT_FALSE(german.is_english());
  EXPECT_TRUE(Language().is_english());
  EXPECT_EQ(Language().translate("Hold still. 3.5 mm"), "Hold still. 3.5 mm");
}

TEST_F(LanguageTest, TranslatesWholeTextsAndFirstLetters) {
  EXPECT_EQ(german.translate("Hold still"), "Halten Sie still");
  EXPECT_EQ(german.translate("Hepatic veins"), "Lebervenen");
  EXPECT_EQ(german.translate("Breath held"), "Atem angehalten");
  EXPECT_EQ(german.translate("Advance slowly:"), "Schieben Sie langsam vor:");
  EXPECT_EQ(german.translate("  (liver) "), "  (Leber) ");
  EXPECT_EQ(german.translate(""), "");
}

TEST_F(LanguageTest, FillsPlacesInTheOrderOfTheTranslation) {
  EXPECT_EQ(german.translate("Needle 3.5 mm from liver"), "Leber: Nadel 3,5 mm entfernt");
  EXPECT_EQ(german.translate("passed hepatic veins"), "durch: Lebervenen");
  EXPECT_EQ(german.translate("Needle passed liver after 1.25 s"), "Nadel: Leber nach 1,25 s durchstochen");
}

TEST_F(LanguageTest, TakesThePatternOfTheMostLetters) {
  EXPECT_EQ(german.translate("2 of 4"), "2 von 4");
  EXPECT_EQ(german.translate("Needle 2 of 4 mm from liver"), "Leber: Nadel 2 von 4 mm entfernt");
}

TEST_F(LanguageTest, TranslatesSentenceBySentence) {
  EXPECT_EQ(german.translate("Hold still. Advance slowly."), "Halten Sie still. Schieben Sie langsam vor.");
  EXPECT_EQ(german.translate("Hold still: Needle 1.5 mm from liver!"), "Halten Sie still: Leber: Nadel 1,5 mm entfernt!");
  std::string english, expected;
  for (int n = 0; n < 40; ++n) english += "Hold still. ", expected += "Halten Sie still. ";
  EXPECT_EQ(german.translate(english), expected);
}

TEST_F(LanguageTest, GivesNumbersItsDecimalSign) {
  EXPECT_EQ(german.translate("19.5 × 18 mm"), "19,5 × 18 mm");
  EXPECT_EQ(german.translate("−0.25 N/mm"), "−0,25 N/mm");
  EXPECT_EQ(german.translate("–"), "–");
  EXPECT_EQ(german.translate("file.7z"), "file.7z");
  EXPECT_EQ(german.translate("0.1.0"), "0.1.0");
  EXPECT_EQ(german.translate("1.5, 2.5"), "1,5, 2,5");
}

TEST_F(LanguageTest, LeavesWhatItDoesNotKnow) {
  for (const char* text : {"lumbar-3", "Müller", "Nadel {0}", "{", "}{0", "<b>", "of", "passed ", " of 3 x"})
    EXPECT_EQ(german.translate(text), text);
  EXPECT_FALSE(german.find("lumbar-3"));
  EXPECT_FALSE(german.find("passed lumbar-3"));
  EXPECT_EQ(german.translate("passed lumbar-3"), "durch: lumbar-3");
  EXPECT_TRUE(german.find("passed liver"));
  EXPECT_TRUE(german.find("3.5 mm"));
}

TEST_F(LanguageTest, TranslatesListsAndPatternsAtTheBeginningOfASentence) {
  EXPECT_EQ(german.translate("liver, hepatic veins, Needle"), "Leber, Lebervenen, Nadel");
  EXPECT_EQ(german.translate("passed liver, lumbar-3"), "durch: Leber, lumbar-3");
  EXPECT_EQ(german.translate("Passed hepatic veins."), "Durch: Lebervenen.");
  EXPECT_EQ(german.translate("liver,"), "Leber,");
}

TEST_F(LanguageTest, EndsWithTextsMadeToNest) {
  for (const std::string word : {"2", "liver", "x"}) {
    std::string text = word;
    for (int n = 0; n < 2000; ++n) text += " of " + word + (n % 3 == 0 ? ", " + word : "");
    EXPECT_FALSE(german.translate(text).empty());
    EXPECT_FALSE(german.translate(text.substr(0, 480)).empty());
  }
  EXPECT_FALSE(german.translate(std::string(10'000, '.')).empty());
}

TEST_F(LanguageTest, TranslatesThePageAndNotItsCode) {
  EXPECT_EQ(translate_page(german,
                           "<html lang=\"en\"><style>liver{}</style><script>\"liver\"</script><p title=\"liver\">Needle "
                           "<b>2.5</b> &lt;x&gt;</p>liver"),
            "<html lang=\"de\"><style>liver{}</style><script>\"liver\"</script><p title=\"Leber\">Nadel "
            "<b>2,5</b> &lt;x&gt;</p>Leber");
  EXPECT_EQ(translate_page(Language(), "<p>liver</p>"), "<p>liver</p>");
  EXPECT_EQ(translate_page(german, "<p>liver"), "<p>Leber");
  EXPECT_EQ(translate_page(german, "<p"), "<p");
}

TEST(Language, RefusesFilesThatAreNone) {
  const std::string head = R"({"language": "D", "decimal_sign": ",", "texts": {)";
  for (const std::string& text :
       {std::string("[]"), std::string("{}"), std::string(R"({"language": "D", "texts": {}})"),
        std::string(R"({"language": "D", "decimal_sign": ";", "texts": {}})"), head + R"("a {0}": "b"}})",
        head + R"("a": "b {0}"}})", head + R"("a {1}": "b {1}"}})", head + R"("{0}": "b {0}"}})",
        head + R"("a": ""}})", head + R"("a": 3}})", head + R"("a": "b", "a": "c"}})", head})
    EXPECT_FALSE(parse(text)) << text;
  EXPECT_FALSE(load_language("xx"));
  EXPECT_FALSE(load_language("../tasks/x"));
  EXPECT_TRUE(load_language("en"));
}

}  // namespace
}  // namespace trocar::language
