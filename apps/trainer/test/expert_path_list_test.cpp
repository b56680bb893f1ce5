#include "panels/expert_path_list.h"

#include <gtest/gtest.h>

#include <QCheckBox>
#include <QLabel>

namespace trocar::trainer {
namespace {

QStringList texts_of(const ExpertPathList& list) {
  QStringList texts;
  for (const QLabel* label : list.findChildren<QLabel*>()) texts << label->text();
  return texts;
}

TEST(ExpertPathList, NamesEachPathWithItsDistancesAndMarksTheNearest) {
  ExpertPathList list;
  EXPECT_TRUE(list.isHidden()) << "without an attempt";
  list.show_rows({{"Midline L3/L4", 12.34, 8.0, false}, {"Midline L4/L5", 3.21, 2.0, true}});
  EXPECT_FALSE(list.isHidden());
  const QStringList texts = texts_of(list);
  for (const char* text : {"Midline L3/L4", "Midline L4/L5 (nearest)", "12.3", "8.0", "3.2", "2.0"})
    EXPECT_TRUE(texts.contains(QString::fromUtf8(text))) << text;
  list.show_rows({});
  EXPECT_TRUE(list.isHidden());
}

TEST(ExpertPathList, TheOtherPathsCanBeHidden) {
  ExpertPathList list;
  auto* others = list.findChild<QCheckBox*>(QStringLiteral("show-expert-paths"));
  ASSERT_NE(others, nullptr);
  list.show_rows({{"Planned path", 1.0, 1.0, true}});
  EXPECT_TRUE(others->isHidden()) << "there are none";
  list.show_rows({{"Planned path", 1.0, 1.0, true}, {"Path 2", 5.0, 5.0, false}});
  EXPECT_FALSE(others->isHidden());
  EXPECT_TRUE(list.are_others_shown());
  int toggled = 0;
  QObject::connect(&list, &ExpertPathList::others_toggled, [&](bool are_shown) { toggled += are_shown ? 0 : 1; });
  others->click();
  EXPECT_EQ(toggled, 1);
  EXPECT_FALSE(list.are_others_shown());
}

}  // namespace
}  // namespace trocar::trainer
