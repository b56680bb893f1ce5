#include "pages/briefing_page.h"

#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QLabel>
#include <QPushButton>
#include <QRegularExpression>
#include <algorithm>
#include <set>

#include "pages/briefing_text.h"
#include "scoring/score.h"
#include "script/cut_off.h"
#include "script/widget_events.h"
#include "test/open_abdomen.h"
#include "test/widget_actions.h"
#include "ui_kit/theme.h"
#include "views/slices/briefing_picture.h"

namespace trocar::trainer {
namespace {

TEST(BriefingPage, ShowsOpeningProgressAndDisablesBegin) {
  BriefingPage page;
  page.show_opening({});
  page.show_progress(QStringLiteral("surfaces"), 0.4);
  EXPECT_FALSE(page.findChild<QPushButton*>(QStringLiteral("begin"))->isEnabled());
  EXPECT_EQ(page.findChild<QLabel*>(QStringLiteral("opening-state"))->text(), QStringLiteral("surfaces"));
}

QString text_of(const BriefingPage& page, const char* name) {
  return page.findChild<QLabel*>(QString::fromLatin1(name))->text();
}

TEST(BriefingPage, NamesTheKeysOfTheTasksActions) {
  struct Expected {
    const char* task;
    std::vector<Action> actions, others;
  };
  using enum Action;
  const Expected all[] = {{"ptcd", {kAnaesthetic, kStylet, kAspirate, kWire, kFluoroscopy, kContrast}, {kFire, kLoad}},
                          {"liver-biopsy", {kFire, kLoad, kAnaesthetic, kBreath}, {kFluoroscopy, kContrast, kWire}},
                          {"lumbar-puncture", {kStylet, kSelectFinger}, {kFluoroscopy, kFire}}};
  for (const Expected& expected : all) {
    BriefingPage page;
    TrainerChoice choice;
    choice.task = expected.task;
    page.show_opening(choice);
    const QString controls = text_of(page, "briefing-controls");
    for (const Action action : expected.actions) {
      EXPECT_TRUE(controls.contains(does_text(action))) << expected.task << ": " << does_text(action).toStdString();
      EXPECT_TRUE(controls.contains(keys_text(action))) << expected.task << ": " << keys_text(action).toStdString();
    }
    for (const Action action : expected.others)
      EXPECT_FALSE(controls.contains(does_text(action))) << expected.task << ": " << does_text(action).toStdString();
  }
}

TEST(BriefingPage, ShowsWhyAnAttemptCannotBegin) {
  BriefingPage page;
  page.show_case(open_abdomen(), TrainingMode::kGuided);
  auto* begin = page.findChild<QPushButton*>(QStringLiteral("begin"));
  EXPECT_TRUE(begin->isEnabled());
  page.set_hindrance(QStringLiteral("The disk is full."));
  EXPECT_FALSE(begin->isEnabled());
  EXPECT_EQ(begin->toolTip(), QStringLiteral("The disk is full."));
  page.show_later(QStringLiteral("3D surfaces"));
  EXPECT_EQ(text_of(page, "opening-state"), QStringLiteral("The disk is full."));
  page.set_hindrance({});
  EXPECT_TRUE(begin->isEnabled());
  EXPECT_EQ(text_of(page, "opening-state"), QStringLiteral("Ready"));
}

TEST(BriefingPage, GivesNoButtonTheFocusWhenBeginIsDisabled) {
  BriefingPage page;
  page.show();
  page.show_case(open_abdomen(), TrainingMode::kGuided);
  const auto* begin = page.findChild<QPushButton*>(QStringLiteral("begin"));
  EXPECT_EQ(page.focusWidget(), begin);
  page.set_hindrance(QStringLiteral("The disk is full."));
  EXPECT_EQ(qobject_cast<QAbstractButton*>(page.focusWidget()), nullptr);
}

TEST(BriefingPage, ShowsReferralAndTaskBeforeThePatientIsLoaded) {
  struct Expected {
    const char* task;
    const char* patient;
    std::vector<const char*> referral, procedure, scoring;
  };
  const Expected all[] = {
      {"lumbar-puncture",
       "lumbar-3",
       {"lumbar-3", "male", "72 years", "174 cm", "encephalitis", "heparin", "penicillin", "sitting"},
       {"spinal fluid", "palpation", "Remove the stylet", "7. "},
       {"Confirmation of position", "spinal fluid comes back", "<b>5</b>", "points at 30°", "70 of 100", "nerve",
        "whatever the points: the needle went in above L2/L3"}},
      {"liver-biopsy",
       "biopsy-3",
       {"biopsy-3", "INR 1.4", "none known", "lying on the back"},
       {"ultrasound", "beyond the tip", "Fire the gun"},
       {"Target tissue in the core", "<b>20</b>", "lung"}},
      {"ptcd", "ptcd-1", {"jaundice", "INR 1.1"}, {"bile duct"}, {"Radiation dose"}},
      {"ascites-puncture", "ascites-2", {"carcinoma"}, {"free fluid"}, {"ascites comes back"}}};
  for (const Expected& expected : all) {
    BriefingPage page;
    TrainerChoice choice;
    choice.task = expected.task;
    choice.patient = expected.patient;
    page.show_opening(choice);
    const auto contains = [&](const char* label, const std::vector<const char*>& parts) {
      for (const char* part : parts)
        EXPECT_TRUE(text_of(page, label).contains(QString::fromUtf8(part)))
            << expected.patient << ": " << part << " in " << text_of(page, label).toStdString();
    };
    contains("briefing-referral", expected.referral);
    contains("briefing-procedure", expected.procedure);
    contains("briefing-scoring", expected.scoring);
    EXPECT_FALSE(page.findChild<QPushButton*>(QStringLiteral("begin"))->isEnabled());
  }
}

TEST(BriefingPage, ShownPointsAddUpTo100ForEveryNeedle) {
  for (const auto& [task, needle] :
       {std::pair("liver-biopsy", "biopsy-18g"), std::pair("lumbar-puncture", "quincke-22g-long")}) {
    TrainerChoice choice;
    choice.task = task;
    choice.needle = needle;
    const auto tables = load_briefing_tables(choice);
    ASSERT_TRUE(tables) << tables.error().text();
    const QString text = scoring_rows(*tables).front().text;
    EXPECT_EQ(text.contains(QStringLiteral("in the cores")), tables->needle.is_biopsy);
    double sum = 0.0;
    int parts = 0;
    static const QRegularExpression points(QStringLiteral("<b>([0-9]+)</b>"));
    for (auto found = points.globalMatch(text); found.hasNext(); ++parts) sum += found.next().captured(1).toDouble();
    EXPECT_NEAR(sum, 100.0, 0.5 * parts) << needle;  // each is rounded
    EXPECT_GE(parts, 6);
  }
}

TEST(BriefingPage, EveryScorePartHasAUniqueTitle) {
  std::set<std::string_view> titles;
  for (const char* part : tasks::kScoreParts) {
    EXPECT_FALSE(scoring::part_title(part).empty()) << part;
    titles.insert(scoring::part_title(part));
  }
  EXPECT_EQ(titles.size(), tasks::kScoreParts.size());
  EXPECT_TRUE(scoring::part_title("no part").empty());
}

TEST(BriefingPage, ShowsMissingReferralDataAsNotStated) {
  TrainerChoice choice;
  choice.patient = "/no/such/patient";
  BriefingPage page;
  page.show_opening(choice);
  EXPECT_TRUE(text_of(page, "briefing-referral").contains(QStringLiteral("not stated")));
}

TEST(BriefingPage, AddsLesionAndLegendWhenThePatientIsLoaded) {
  BriefingPage page;
  page.resize(1000, 640);
  page.show();
  page.show_opening({});
  EXPECT_TRUE(text_of(page, "briefing-legend").isEmpty());
  page.show_case(open_abdomen(), TrainingMode::kAssisted);
  static const QRegularExpression size(QStringLiteral("lesion of ([0-9]+) × ([0-9]+) × ([0-9]+) mm"));
  const auto found = size.match(text_of(page, "briefing-referral"));
  ASSERT_TRUE(found.hasMatch()) << text_of(page, "briefing-referral").toStdString();
  for (int n = 1; n <= 3; ++n) {
    EXPECT_GT(found.captured(n).toInt(), 5);
    EXPECT_LT(found.captured(n).toInt(), 60);
  }
  EXPECT_TRUE(text_of(page, "briefing-legend").contains(QStringLiteral("liver")));
  EXPECT_FALSE(text_of(page, "briefing-legend").contains(QStringLiteral("planned")));
  QCoreApplication::processEvents();
  int slices = 0;
  for (const QLabel* label : page.findChildren<QLabel*>()) {
    if (label->pixmap(Qt::ReturnByValue).isNull()) continue;
    ++slices;
    EXPECT_EQ(label->pixmap(Qt::ReturnByValue).size(), label->size()) << "nothing of it is cut off";
  }
  EXPECT_EQ(slices, 2);
}

/// The abdomen's case with another description.
QString finding_with(const std::string& description) {
  cases::Case the_case = open_abdomen()->the_case;
  auto patient = std::make_shared<anatomy::VirtualPatient>(*the_case.patient);
  patient->description = description;
  the_case.patient = patient;
  QString text;
  for (const BriefingRow& row : finding_rows(the_case))
    if (row.heading == QStringLiteral("Finding")) text = row.text;
  return text;
}

TEST(BriefingPage, NamesTheLiverSegmentOfTheTargetLesionOnly) {
  const cases::Case& the_case = open_abdomen()->the_case;
  const Segment& path_P = the_case.plan.line_P;
  const anatomy::Label* target =
      find_label(*the_case.patient, path_P.b + the_case.needle.notch_middle_mm() * path_P.direction());
  ASSERT_NE(target, nullptr);
  const std::string number = target->name.substr(target->name.rfind('_') + 1);
  EXPECT_FALSE(finding_with("a man").contains(QStringLiteral("segment")));
  const std::string stated = "a man; lesions of the liver: 7 of 9 mm in segment II, " + number +
                             " of 20 mm in segment VI, 8 of 9 mm in segment IV";
  EXPECT_TRUE(finding_with(stated).contains(QStringLiteral("segment VI of the liver")))
      << finding_with(stated).toStdString();
  EXPECT_FALSE(finding_with("a man; lesion of the liver: 7 of 9 mm in segment II").contains(QStringLiteral("segment")));
}

TEST(BriefingPage, FitsSmallAndLargeWindows) {
  for (const QSize& size : {QSize(1024, 640), QSize(1600, 850)}) {
    BriefingPage page;
    page.resize(size);
    page.show();
    TrainerChoice choice;
    choice.task = "lumbar-puncture";
    choice.patient = "lumbar-5";
    page.show_opening(choice);
    QCoreApplication::processEvents();
    EXPECT_TRUE(find_cut_off(page).isEmpty()) << find_cut_off(page).join(';').toStdString();
    save(page, size.width() > 1300 ? "briefing_opening_wide.png" : "briefing_opening_narrow.png");
  }
}

TEST(BriefingPage, ShowsTheCaseAndEnablesBegin) {
  BriefingPage page;
  page.resize(1280, 700);
  page.show();
  page.show_opening({});
  QCoreApplication::processEvents();
  page.show_case(open_abdomen(), TrainingMode::kGuided);
  EXPECT_TRUE(page.findChild<QPushButton*>(QStringLiteral("begin"))->isEnabled());
  save(page, "briefing_guided.png");
  page.show_case(open_abdomen(), TrainingMode::kAssisted);
  save(page, "briefing_assisted.png");
  bool says_help = false;
  for (const QLabel* label : page.findChildren<QLabel*>())
    says_help |= label->text().contains(QStringLiteral("Assisted"));
  EXPECT_TRUE(says_help);
}

TEST(BriefingPage, ShowsThePathLengthWithinTheOrgan) {
  cases::Case the_case = open_abdomen()->the_case;
  the_case.plan.length_mm = 58.0;
  the_case.plan.organ_path_mm = 21.0;
  the_case.plan.nearest_risk = "cauda_equina";
  EXPECT_EQ(path_row(the_case).text,
            QStringLiteral("58 mm long, 21 mm of it in the liver; nearest structure at risk: cauda equina"));
  the_case.plan.organ_path_mm = 0.0;  // a dural sac begins at the tip
  EXPECT_EQ(path_row(the_case).text, QStringLiteral("58 mm long; nearest structure at risk: cauda equina"));
}

TEST(BriefingPage, HidesThePlannedPathInAnExam) {
  BriefingPage page;
  page.resize(1280, 700);
  page.show();
  const auto says = [&](const char* text) {
    const auto labels = page.findChildren<QLabel*>();
    return std::any_of(labels.begin(), labels.end(),
                       [&](const QLabel* label) { return label->text().contains(QString::fromUtf8(text)); });
  };
  page.show_case(open_abdomen(), TrainingMode::kAssisted);
  EXPECT_TRUE(says("lesion of the liver") && says("Planned path"));
  page.show_case(open_abdomen(), TrainingMode::kExam);
  EXPECT_TRUE(says("lesion of the liver"));
  EXPECT_FALSE(says("Planned path"));
  save(page, "briefing_exam.png");
}

TEST(BriefingPicture, ShowsThePathOnlyInGuidedAttempts) {
  const QSize size(400, 300);
  const auto share_of_path = [&](scene::Guidance guidance) {
    return share_near(briefing_picture(*open_abdomen(), BriefingPlane::kAlongPath, size, guidance), theme().path, 12);
  };
  const double line = share_of_path(scene::Guidance::kPath), entry = share_of_path(scene::Guidance::kTarget);
  EXPECT_GT(line, 0.001);
  EXPECT_LT(entry, 0.5 * line);
  EXPECT_GT(entry, 0.0001);  // the ring at the entry
  EXPECT_EQ(share_of_path(scene::Guidance::kNone), 0.0);
}

TEST(BriefingPicture, LegendColoursMatchTheImage) {
  const QSize size(400, 300);
  for (const scene::Guidance guidance : {scene::Guidance::kTarget, scene::Guidance::kNone}) {
    const auto entries = briefing_legend(*open_abdomen(), BriefingPlane::kAxial, size, guidance);
    const QImage image = briefing_picture(*open_abdomen(), BriefingPlane::kAxial, size, guidance);
    ASSERT_GE(entries.size(), 4U);
    EXPECT_GT(entries.front().share, 0.05) << entries.front().words.toStdString();
    bool has_lesion = false;
    for (const LegendEntry& entry : entries) {
      // Outlines have the label's own colour.
      if (entry.share > 0.005) {
        EXPECT_GT(share_near(image, entry.color, 3), 0.0) << entry.words.toStdString();
      }
      has_lesion |= entry.words.contains(QStringLiteral("tumor")) || entry.words.contains(QStringLiteral("lesion"));
    }
    EXPECT_EQ(has_lesion, guidance != scene::Guidance::kNone);
  }
}

TEST(BriefingPicture, MarksTheTargetInEveryPlane) {
  for (const BriefingPlane plane : {BriefingPlane::kAxial, BriefingPlane::kSagittal, BriefingPlane::kAlongPath}) {
    const QImage image = briefing_picture(*open_abdomen(), plane, {400, 300}, scene::Guidance::kNone);
    EXPECT_GT(share_near(image, theme().target, 12), 0.0001);
  }
}

TEST(BriefingLegend, LabelsColoursOfOneTissueByStructure) {
  std::vector<LegendEntry> entries{{Qt::red, "vessel", 0.2, false, "aorta", 0.15},
                                   {Qt::blue, "vessel", 0.1, false, "portal vein", 0.1},
                                   {Qt::white, "bone", 0.1, false, "rib", 0.02}};
  tell_apart(entries);
  EXPECT_EQ(entries[0].words, QStringLiteral("aorta and others"));
  EXPECT_EQ(entries[1].words, QStringLiteral("portal vein and others"));
  EXPECT_EQ(entries[2].words, QStringLiteral("bone"));
}

}  // namespace
}  // namespace trocar::trainer
