#include "ui_kit/window_language.h"

#include <gtest/gtest.h>

#include <QApplication>
#include <QFile>
#include <QLabel>
#include <QLocale>
#include <QXmlStreamReader>

#include "case_builder/case_edits.h"
#include "case_panels/landmark_text.h"
#include "script/english_text.h"
#include "ui_kit/action_table.h"

namespace trocar::trainer {
namespace {

/// The window speaks German in these tests; those after them are in English again.
class WindowLanguage : public ::testing::Test {
 protected:
  void SetUp() override {
    const Status spoken = speak(*QCoreApplication::instance(), QStringLiteral("de"));
    ASSERT_TRUE(spoken) << spoken.error().text();
  }
  void TearDown() override { EXPECT_TRUE(speak(*QCoreApplication::instance(), QStringLiteral("en"))); }
};

TEST_F(WindowLanguage, CoversTextsTablesAndNumbers) {
  EXPECT_EQ(QCoreApplication::translate("trocar::trainer::MainWindow", "Views"), QStringLiteral("Ansichten"));
  EXPECT_EQ(QCoreApplication::translate("trocar::trainer::StartPage", "Guided"), QStringLiteral("Angeleitet"));
  EXPECT_EQ(shown("liver"), QStringLiteral("Leber"));
  EXPECT_EQ(shown("3.5 mm"), QStringLiteral("3,5 mm"));
  EXPECT_EQ(shown("lumbar-3"), QStringLiteral("lumbar-3"));
  EXPECT_EQ(QLocale().toString(2.5, 'f', 1), QStringLiteral("2,5"));
  EXPECT_EQ(QStringLiteral("%L1 N").arg(1234.5, 0, 'f', 1), QStringLiteral("1234,5 N"));
}

TEST_F(WindowLanguage, IsReplacedByAnotherLanguage) {
  EXPECT_TRUE(speak(*QCoreApplication::instance(), QStringLiteral("en")));
  EXPECT_EQ(QCoreApplication::translate("trocar::trainer::MainWindow", "Views"), QStringLiteral("Views"));
  EXPECT_EQ(shown("liver"), QStringLiteral("liver"));
  EXPECT_EQ(QStringLiteral("%L1 N").arg(1234.5, 0, 'f', 1), QStringLiteral("1234.5 N"));
  EXPECT_FALSE(speak(*QCoreApplication::instance(), QStringLiteral("xx")));
}

TEST_F(WindowLanguage, TranslatesEveryActionAndItsKeys) {
  QStringList english;
  for (const ActionRow& row : action_table())
    for (const QString& text : {does_text(row.action), keys_text(row.action)}) {
      QLabel label(text);
      QWidget window;
      label.setParent(&window);
      english << find_english(window);
      label.setParent(nullptr);
    }
  EXPECT_TRUE(english.isEmpty()) << english.join(QLatin1Char('\n')).toStdString();
}

// What is shown comes back as the name in the case's file, also a name that somebody typed and that is a word here.
TEST_F(WindowLanguage, KeepsTheNamesOfLandmarks) {
  EXPECT_EQ(landmark_text("landmark 3"), QStringLiteral("Landmarke 3"));
  EXPECT_EQ(landmark_text("liver"), QStringLiteral("liver"));
  for (const std::string_view name : case_builder::landmark_names())
    EXPECT_EQ(landmark_of(landmark_text(std::string(name))), name);
  for (const char* name : {"landmark 1", "landmark 99", "landmark 100", "liver", "Leber", "my mark, left"})
    EXPECT_EQ(landmark_of(landmark_text(name)), name);
}

TEST(EnglishText, IsDetectedInWidgetsButNotInFileNames) {
  QWidget window;
  auto* label = new QLabel(QStringLiteral("<b>Ziel</b> of the Nadel"), &window);
  label->setObjectName(QStringLiteral("goal"));
  EXPECT_EQ(find_english(window), QStringList(QStringLiteral("goal: <b>Ziel</b> of the Nadel")));
  label->setText(QStringLiteral("Datei /home/the/of.txt for.toml"));
  EXPECT_TRUE(find_english(window).isEmpty());
  label->setToolTip(QStringLiteral("Hold still"));
  EXPECT_EQ(find_english(window).size(), 1);
}

}  // namespace
}  // namespace trocar::trainer
