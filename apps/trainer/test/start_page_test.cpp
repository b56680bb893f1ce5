#include "pages/start_page.h"

#include <gtest/gtest.h>

#include <QAbstractButton>
#include <QComboBox>
#include <QCoreApplication>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QPushButton>
#include <QSettings>
#include <QSpinBox>
#include <QTemporaryDir>
#include <filesystem>

#include "core/files/folders.h"
#include "io/patient/patient_folder.h"
#include "phantom/phantom.h"
#include "test/widget_actions.h"
#include "ui_kit/parts.h"

namespace trocar::trainer {
namespace {

/// Settings of the test's own, so that a person's stay as they are.
struct StartPageTest : ::testing::Test {
  StartPageTest() {
    QSettings::setDefaultFormat(QSettings::IniFormat);
    QSettings::setPath(QSettings::IniFormat, QSettings::UserScope, folder.path());
  }
  QTemporaryDir folder;
};

TEST_F(StartPageTest, DefaultsToLiverBiopsyOfTheEmbeddedPatient) {
  const StartPage page;
  EXPECT_EQ(page.choice().task, "liver-biopsy");
  EXPECT_EQ(page.choice().patient, "abdomen");
  EXPECT_EQ(page.choice().mode, TrainingMode::kGuided);
  EXPECT_TRUE(page.findChild<QPushButton*>(QStringLiteral("start"))->isEnabled());
}

TEST_F(StartPageTest, RemembersTheLastStartedChoice) {
  TrainerChoice wanted;
  wanted.mode = TrainingMode::kAssisted;
  wanted.force_model = "proxy";
  wanted.needle_device = "gamepad";
  {
    StartPage page;
    page.choose(wanted);
    page.findChild<QPushButton*>(QStringLiteral("start"))->click();
  }
  const StartPage again;
  EXPECT_EQ(again.choice().mode, TrainingMode::kAssisted);
  EXPECT_EQ(again.choice().force_model, "proxy");
  EXPECT_EQ(again.choice().needle_device, "gamepad");
}

TEST_F(StartPageTest, ExamUsesTheTasksNeedleAndForceModel) {
  TrainerChoice wanted;
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

TEST_F(StartPageTest, BreathingIsChosenOutsideExamsOnly) {
  StartPage page;
  EXPECT_EQ(page.choice().breathing, "");
  TrainerChoice wanted;
  for (const char* breathing : {"none", "deep", "14,rate=18"}) {
    wanted.breathing = breathing;
    page.choose(wanted);
    EXPECT_EQ(page.choice().breathing, breathing);
  }
  page.findChild<QAbstractButton*>(QStringLiteral("difficulty-exam"))->click();
  EXPECT_EQ(page.choice().breathing, "");
}

TEST_F(StartPageTest, AnExamHasADifficultyAndANumber) {
  StartPage page;
  page.resize(1280, 700);
  page.show();
  auto* number = page.findChild<QSpinBox*>(QStringLiteral("exam-number"));
  auto* difficulty = page.findChild<QComboBox*>(QStringLiteral("exam-difficulty"));
  EXPECT_FALSE(number->isVisible());
  page.findChild<QAbstractButton*>(QStringLiteral("difficulty-exam"))->click();
  EXPECT_TRUE(number->isVisible());
  EXPECT_EQ(page.choice().exam_number, 0u);  // drawn
  number->setValue(4711);
  EXPECT_EQ(page.choice().exam_number, 4711u);
  const int row = difficulty->findData(3);
  ASSERT_GE(row, 0);
  Q_EMIT difficulty->activated(row);
  EXPECT_EQ(page.choice().patient, "biopsy-3");
  TrainerChoice other = page.choice();
  other.patient = "biopsy-5";
  page.choose(other);
  EXPECT_EQ(difficulty->currentData().toInt(), 5);
  EXPECT_TRUE(needs_exam_body(page.choice()));
  page.add_patient(QStringLiteral("/somewhere/patient-7"));
  EXPECT_FALSE(number->isEnabled());
  EXPECT_EQ(page.choice().exam_number, 0u);
  EXPECT_FALSE(needs_exam_body(page.choice()));
  EXPECT_TRUE(exam_text(page.choice()).contains(QStringLiteral("known")));
  TrainerChoice nobody = page.choice();
  EXPECT_FALSE(exam_text(nobody).contains(QStringLiteral("name nobody")));
  nobody.is_person_named = false;
  EXPECT_TRUE(exam_text(nobody).contains(QStringLiteral("name nobody")));
}

TEST_F(StartPageTest, ExamIgnoresTheSeedOfTheCommandLine) {
  TrainerChoice wanted;
  wanted.patient_seed = 77;
  StartPage page;
  page.choose(wanted);
  EXPECT_EQ(page.choice().patient_seed, 77u);
  page.findChild<QAbstractButton*>(QStringLiteral("difficulty-exam"))->click();
  EXPECT_EQ(page.choice().patient_seed, 1u);
  EXPECT_EQ(page.choice().exam_number, 0u);
}

TEST_F(StartPageTest, OffersAndStartsTheNextExercise) {
  StartPage page;
  page.resize(1280, 700);
  page.show();
  auto* card = page.findChild<QWidget*>(QStringLiteral("next-exercise"));
  EXPECT_FALSE(card->isVisible());
  TrainerChoice exercise;
  exercise.task = "ptcd";
  exercise.patient = "ptcd-2";
  exercise.mode = TrainingMode::kAssisted;
  page.offer_next(QStringLiteral("Bile duct puncture, case 2, assisted"), QStringLiteral("It is due today."), exercise);
  EXPECT_FALSE(card->isVisible()) << "a new user begins with the first steps";
  page.findChild<QPushButton*>(QStringLiteral("first-steps-skip"))->click();
  EXPECT_TRUE(card->isVisible());
  EXPECT_EQ(page.findChild<QLabel*>(QStringLiteral("next-exercise-title"))->text(),
            QStringLiteral("Next exercise: Bile duct puncture, case 2, assisted"));
  EXPECT_EQ(page.findChild<QLabel*>(QStringLiteral("next-exercise-why"))->text(), QStringLiteral("It is due today."));
  TrainerChoice before = page.choice();
  before.needle_device = "gamepad";
  before.force_model = "proxy";
  page.choose(before);
  std::vector<TrainerChoice> started;
  QObject::connect(&page, &StartPage::start_requested, [&](const TrainerChoice& choice) { started.push_back(choice); });
  page.findChild<QPushButton*>(QStringLiteral("start-next"))->click();
  ASSERT_EQ(started.size(), 1u);
  EXPECT_EQ(started[0].task, "ptcd");
  EXPECT_EQ(started[0].patient, "ptcd-2");
  EXPECT_EQ(started[0].mode, TrainingMode::kAssisted);
  EXPECT_EQ(started[0].needle_device, "gamepad");  // the devices stay
  EXPECT_EQ(started[0].force_model, "");           // the task's own
  page.offer_next({}, {}, {});
  EXPECT_FALSE(card->isVisible());
}

TEST_F(StartPageTest, RemembersADeviceForEachTool) {
  TrainerChoice wanted;
  wanted.needle_device = "openhaptics:Left Device";
  wanted.probe_device = "openhaptics:Right Device";
  {
    StartPage page;
    page.choose(wanted);
    page.findChild<QPushButton*>(QStringLiteral("start"))->click();
  }
  const StartPage again;
  EXPECT_EQ(again.choice().needle_device, wanted.needle_device);
  EXPECT_EQ(again.choice().probe_device, wanted.probe_device);
}

TEST_F(StartPageTest, OffersNeedlesThatFitTheTask) {
  const StartPage page;
  const auto* box = page.findChild<QComboBox*>(QStringLiteral("needle"));
  ASSERT_EQ(box->count(), 4);
  EXPECT_TRUE(box->itemText(0).contains(QStringLiteral("defined by the task")));
  for (int row = 1; row < box->count(); ++row)
    EXPECT_TRUE(box->itemText(row).contains(QStringLiteral("biopsy"))) << box->itemText(row).toStdString();
}

TEST_F(StartPageTest, ListsAFolderByItsCaseName) {
  const trocar::TemporaryFolder cases;
  const auto patient = phantom::generate_phantom("layers-liver", 1);
  ASSERT_TRUE(patient) << patient.error().text();
  anatomy::VirtualPatient named = *patient;
  named.name = "A lesion under the ribs";
  named.description = "Seen at night.";
  const auto at = cases / "case-7";
  ASSERT_TRUE(io::save_patient(named, {}, at));
  StartPage page;
  page.add_patient(to_qt(at.string()));
  const auto* item = page.findChild<QListWidget*>(QStringLiteral("patients"))->currentItem();
  ASSERT_NE(item, nullptr);
  EXPECT_EQ(item->text(), QStringLiteral("A lesion under the ribs"));
  EXPECT_TRUE(item->toolTip().contains(QStringLiteral("Seen at night.")));
  EXPECT_EQ(page.choice().patient, at.string());
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

TEST_F(StartPageTest, OffersToRecoverACrashedAttempt) {
  StartPage page;
  page.resize(1280, 700);
  page.offer_recovery(QStringLiteral("An attempt of 10:31 was cut off."));
  page.show();
  EXPECT_TRUE(page.findChild<QPushButton*>(QStringLiteral("recover"))->isVisible());
  page.offer_recovery({});
  EXPECT_FALSE(page.findChild<QPushButton*>(QStringLiteral("recover"))->isVisible());
}

TEST_F(StartPageTest, ExamKeepsThePreviousPracticeChoice) {
  TrainerChoice wanted;
  wanted.needle = "biopsy-16g";
  wanted.force_model = "proxy";
  for (const TrainingMode difficulty : {TrainingMode::kGuided, TrainingMode::kExam}) {
    StartPage page;
    wanted.mode = difficulty;
    page.choose(wanted);
    page.findChild<QPushButton*>(QStringLiteral("start"))->click();
  }
  StartPage again;
  TrainerChoice guided = again.choice();
  EXPECT_EQ(guided.mode, TrainingMode::kExam);
  again.findChild<QAbstractButton*>(QStringLiteral("difficulty-guided"))->click();
  guided = again.choice();
  EXPECT_EQ(guided.needle, "biopsy-16g");
  EXPECT_EQ(guided.force_model, "proxy");
}

TEST_F(StartPageTest, OffersTheTutorialUntilDoneOrSkipped) {
  {
    StartPage page;
    page.show();
    std::vector<TrainerChoice> started;
    QObject::connect(&page, &StartPage::start_requested,
                     [&](const TrainerChoice& choice) { started.push_back(choice); });
    auto* card = page.findChild<QWidget*>(QStringLiteral("first-steps"));
    EXPECT_TRUE(card->isVisible());
    page.findChild<QPushButton*>(QStringLiteral("first-steps-start"))->click();
    ASSERT_EQ(started.size(), 1U);
    EXPECT_TRUE(started[0].is_tutorial);
    EXPECT_EQ(started[0].patient, "layers-liver");
    EXPECT_TRUE(std::filesystem::exists(started[0].task));
    page.note_first_steps();
    EXPECT_FALSE(card->isVisible());
  }
  StartPage again;
  again.show();
  EXPECT_FALSE(again.findChild<QWidget*>(QStringLiteral("first-steps"))->isVisible());
  int started = 0;
  QObject::connect(&again, &StartPage::start_requested, [&] { ++started; });
  again.findChild<QPushButton*>(QStringLiteral("open-first-steps"))->click();
  EXPECT_EQ(started, 1) << "they stay at hand";
}

TEST_F(StartPageTest, EnterStartsUnlessATextFieldHasFocus) {
  StartPage page;
  page.show();
  QCoreApplication::processEvents();
  int started = 0;
  QObject::connect(&page, &StartPage::start_requested, [&] { ++started; });
  auto& name = *page.findChild<QLineEdit*>(QStringLiteral("person-name"));
  page.findChild<QPushButton*>(QStringLiteral("new-person"))->click();
  name.setFocus();
  for (const int key : {Qt::Key_Return, Qt::Key_Enter}) press_key(name, key);
  EXPECT_EQ(started, 0);
  page.findChild<QPushButton*>(QStringLiteral("person-cancel"))->click();
  auto& tasks = *page.findChild<QListWidget*>(QStringLiteral("tasks"));
  tasks.setFocus();
  press_key(tasks, Qt::Key_Return);
  EXPECT_EQ(started, 1);
}

}  // namespace
}  // namespace trocar::trainer
