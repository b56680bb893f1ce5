// Who practises: the bar on the start page, and the history beside it.
#include <gtest/gtest.h>

#include <QComboBox>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>

#include "pages/history_card.h"
#include "pages/person_bar.h"

namespace trocar::trainer {
namespace {

struct PersonBarTest : ::testing::Test {
  PersonBarTest() { bar.show_people({{"a", "Anna", "Course 1", false}, {"b", "Ben", {}, true}}, "b", false); }
  template <class Widget>
  Widget& find(const char* name) {
    return *bar.findChild<Widget*>(QString::fromLatin1(name));
  }
  bool is_listing() { return !find<QComboBox>("person").isHidden() && find<QLineEdit>("person-pin").isHidden(); }

  PersonBar bar;
};

TEST_F(PersonBarTest, ListsPeopleWithTheirCourses) {
  const auto& people = find<QComboBox>("person");
  ASSERT_EQ(people.count(), 3);
  EXPECT_EQ(people.itemText(1), "Anna (Course 1)");
  EXPECT_EQ(people.currentText(), "Ben");
  EXPECT_TRUE(is_listing());
}

TEST_F(PersonBarTest, CancelledPinRestoresTheCurrentPerson) {
  QStringList requested;
  QObject::connect(&bar, &PersonBar::person_requested, [&](const QString& id) { requested << id; });
  auto& people = find<QComboBox>("person");
  people.setCurrentIndex(1);
  Q_EMIT people.activated(1);
  EXPECT_EQ(requested, QStringList{"a"});
  bar.ask_for_pin({"a", "Anna", {}, true}, false);
  EXPECT_FALSE(is_listing());
  find<QPushButton>("person-cancel").click();
  EXPECT_TRUE(is_listing());
  EXPECT_EQ(people.currentText(), "Ben");
}

TEST_F(PersonBarTest, AcceptsNameAndPinOfANewPerson) {
  QStringList entered;
  QObject::connect(&bar, &PersonBar::new_person_entered,
                   [&](const QString& name, const QString& pin_text) { entered << name << pin_text; });
  find<QPushButton>("new-person").click();
  find<QLineEdit>("person-name").setText("Chiara");
  auto& pin = find<QLineEdit>("person-pin");
  pin.insert("12x");  // digits only
  EXPECT_EQ(pin.text(), "");
  pin.insert("1234");
  EXPECT_EQ(pin.echoMode(), QLineEdit::Password);
  find<QPushButton>("person-ok").click();
  EXPECT_EQ(entered, (QStringList{"Chiara", "1234"}));
  bar.close_entry();
  find<QPushButton>("new-person").click();
  EXPECT_EQ(pin.text(), "");  // not kept for the next one
}

results::CurveAttempt attempt(std::optional<double> score, std::optional<double> mean) {
  results::CurveAttempt one;
  one.attempt.score = score;
  one.attempt.is_passed = score && *score >= 60.0;
  one.moving_mean = mean;
  return one;
}

TEST(History, ComparesWithPeersAndExperts) {
  results::LearningCurve curve;
  EXPECT_EQ(history_text(curve), "No attempt that counts yet.");
  EXPECT_EQ(comparison_text(curve), "");
  curve.attempts = {attempt(50.0, 50.0), attempt({}, 50.0), attempt(70.4, 60.2)};
  curve.counts = {2, 1, 1, 1, 0, 0, 0};
  curve.peer_curve = {cohort::CurvePoint{8, 55.0}, cohort::CurvePoint{7, 61.6}, cohort::CurvePoint{1, 90.0}};
  curve.experts = results::ExpertLevel{2, false, 97.0, 96.0, 98.0};
  EXPECT_EQ(history_text(curve),
            "1 of 3 attempts passed. Mean of the last 2: 60. 3 attempts counted (1 ended without a result), 1 left "
            "out: 1 never "
            "began. Others at attempt 3: 90 (1 person). Experts: 96 to 98.");
  EXPECT_EQ(comparison_text(curve),
            "Your attempt 3: 70 points. Others at attempt 3: 90 (1 person). Experts: 96 to 98.");
  curve.experts->is_simulated = true;
  EXPECT_NE(history_text(curve).indexOf("Simulated experts"), -1);
  curve.attempts.push_back(attempt({}, 60.2));  // the last one has no score
  EXPECT_EQ(comparison_text(curve), "");
}

}  // namespace
}  // namespace trocar::trainer
