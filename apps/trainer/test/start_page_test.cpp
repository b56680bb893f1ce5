#include "pages/start_page.h"

#include <gtest/gtest.h>

#include <QAbstractButton>
#include <QListWidget>
#include <QPushButton>
#include <QSettings>
#include <QTemporaryDir>

#include "shell/parts.h"

namespace trocar::trainer {
namespace {

/// Settings of the test's own, so that a person's stay as they are.
struct StartPageTest : testing::Test {
  StartPageTest() {
    QSettings::setDefaultFormat(QSettings::IniFormat);
    QSettings::setPath(QSettings::IniFormat, QSettings::UserScope, folder.path());
  }
  QTemporaryDir folder;
};

TEST_F(StartPageTest, BeginsWithTheLiverBiopsyOfTheEmbeddedPatient) {
  const StartPage page;
  EXPECT_EQ(page.choice().task, "liver-biopsy");
  EXPECT_EQ(page.choice().patient, "abdomen");
  EXPECT_EQ(page.choice().difficulty, Difficulty::kGuided);
  EXPECT_TRUE(page.findChild<QPushButton*>(QStringLiteral("start"))->isEnabled());
}

TEST_F(StartPageTest, RemembersWhatWasStarted) {
  SeatChoice wanted;
  wanted.difficulty = Difficulty::kAssisted;
  wanted.force_model = "proxy";
  wanted.needle_device = "gamepad";
  {
    StartPage page;
    page.choose(wanted);
    page.findChild<QPushButton*>(QStringLiteral("start"))->click();
  }
  const StartPage again;
  EXPECT_EQ(again.choice().difficulty, Difficulty::kAssisted);
  EXPECT_EQ(again.choice().force_model, "proxy");
  EXPECT_EQ(again.choice().needle_device, "gamepad");
}

TEST_F(StartPageTest, AnExamTakesTheTasksOwnNeedleAndForces) {
  SeatChoice wanted;
  wanted.needle = "biopsy-16g";
  wanted.force_model = "proxy";
  StartPage page;
  page.choose(wanted);
  page.findChild<QAbstractButton*>(QStringLiteral("difficulty-exam"))->click();
  EXPECT_FALSE(page.findChild<QWidget*>(QStringLiteral("needle"))->isEnabled());
  EXPECT_FALSE(page.findChild<QWidget*>(QStringLiteral("force-model"))->isEnabled());
  EXPECT_EQ(page.choice().needle, "");
  EXPECT_EQ(page.choice().force_model, "");
  page.findChild<QAbstractButton*>(QStringLiteral("difficulty-guided"))->click();
  EXPECT_TRUE(page.findChild<QWidget*>(QStringLiteral("force-model"))->isEnabled());
}

TEST_F(StartPageTest, OpenedFoldersStayInTheList) {
  {
    StartPage page;
    page.add_patient(QStringLiteral("/somewhere/patient-7"));
    EXPECT_EQ(page.choice().patient, "/somewhere/patient-7");
  }
  const StartPage again;
  EXPECT_EQ(again.findChild<QListWidget*>(QStringLiteral("patients"))
                ->findItems(QStringLiteral("patient-7"), Qt::MatchContains)
                .size(),
            1);
}

TEST_F(StartPageTest, OffersWhatACrashHasCutOff) {
  StartPage page;
  page.resize(1280, 700);
  page.offer_recovery(QStringLiteral("An attempt of 10:31 was cut off."));
  page.show();
  EXPECT_TRUE(page.findChild<QPushButton*>(QStringLiteral("recover"))->isVisible());
  page.offer_recovery({});
  EXPECT_FALSE(page.findChild<QPushButton*>(QStringLiteral("recover"))->isVisible());
}

}  // namespace
}  // namespace trocar::trainer
