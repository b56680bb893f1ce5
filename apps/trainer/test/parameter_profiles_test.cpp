#include "parameters/parameter_profiles.h"

#include <gtest/gtest.h>

#include <QComboBox>
#include <QLabel>
#include <QToolButton>
#include <algorithm>
#include <fstream>

#include "script/widget_events.h"
#include "test/parameter_lab.h"

namespace trocar::trainer {
namespace {

class ParameterProfilesTest : public ParameterLab {
 protected:
  std::filesystem::path place() const { return folder / "profiles"; }
  QComboBox& choice() { return *part<QComboBox>("parameter-profile"); }
  QLabel& problem() { return *part<QLabel>("parameter-profile-problem"); }
  void click(const char* name) { part<QAbstractButton>(name)->click(); }

  void save_as(const char* name) {
    click("parameter-profile-save-as");
    type("parameter-profile-name", name);
  }

  void write(const char* file, const char* text) {
    std::filesystem::create_directories(place());
    std::ofstream(place() / file) << text;
    panel.set_profile_folder(place());
  }

  bool is_marked() { return !choice().itemIcon(choice().currentIndex()).isNull(); }
};

TEST_F(ParameterProfilesTest, ChoosingAProfileRestoresItsSettings) {
  EXPECT_EQ(choice().count(), 1) << "the case's own";
  EXPECT_FALSE(part<QToolButton>("parameter-profile-delete")->isEnabled());
  ASSERT_TRUE(panel.apply_settings({QStringLiteral("liver.k=0.3"), QStringLiteral("transfer.tn_factor=1.2")}));
  ASSERT_TRUE(choose_entry(*part<QComboBox>("parameter-model"), QStringLiteral("Combined")));
  EXPECT_TRUE(is_marked());
  save_as("Soft liver");
  EXPECT_FALSE(part<QLineEdit>("parameter-profile-name")->isVisible());
  EXPECT_EQ(choice().currentText(), QStringLiteral("Soft liver"));
  EXPECT_FALSE(is_marked());
  const auto saved = cases::load_profile(cases::profile_file(place(), "Soft liver"));
  ASSERT_TRUE(saved) << saved.error().text();
  EXPECT_EQ(saved->name, "Soft liver");
  EXPECT_EQ(saved->force_model, "combined");
  EXPECT_EQ(saved->overrides, (std::vector<std::string>{"liver.k=0.3", "transfer.tn_factor=1.2"}));
  settle();
  keep_picture("profiles_saved.png");

  const QStringList settings = panel.settings();
  models.clear();
  ASSERT_TRUE(choose_entry(choice(), QStringLiteral("As in the case")));
  EXPECT_TRUE(panel.settings().isEmpty());
  EXPECT_EQ(panel.preview().model(), QStringLiteral("insertion"));
  ASSERT_TRUE(choose_entry(choice(), QStringLiteral("Soft liver")));
  EXPECT_EQ(panel.settings(), settings);
  EXPECT_EQ(panel.preview().model(), QStringLiteral("combined"));
  EXPECT_EQ(models, (std::vector<QString>{QStringLiteral("insertion"), QStringLiteral("combined")}));
  settle();
  EXPECT_EQ(sent.back(), settings);
}

TEST_F(ParameterProfilesTest, ChoosingAProfileIsOneUndoStep) {
  write("stiff.toml",
        "name = \"Stiff\"\nforce_model = \"proxy\"\noverrides = [\"liver_capsule.stiffness_n_per_mm=0.9\", "
        "\"skin.fp=4\"]\n");
  open_tissue("parameter-tissue-liver");
  type("parameter-liver-mu", "0.3");
  ASSERT_TRUE(choose_entry(choice(), QStringLiteral("Stiff")));
  EXPECT_EQ(panel.settings(), (QStringList{QStringLiteral("skin.fp=4"), QStringLiteral("liver.k=0.9")}));
  EXPECT_FALSE(is_marked());
  type("parameter-liver-mu", "0.4");
  EXPECT_TRUE(is_marked());
  EXPECT_EQ(choice().currentText(), QStringLiteral("Stiff"));
  keep_picture("profiles_marked.png");
  click("parameter-undo");
  EXPECT_FALSE(is_marked());
  click("parameter-undo");
  EXPECT_EQ(panel.settings(), QStringList{QStringLiteral("liver.mu=0.3")});
  EXPECT_EQ(panel.preview().model(), QStringLiteral("insertion"));
  EXPECT_EQ(choice().currentIndex(), 0);
  EXPECT_TRUE(is_marked());
  click("parameter-redo");
  EXPECT_EQ(panel.preview().model(), QStringLiteral("proxy"));
  EXPECT_EQ(choice().currentText(), QStringLiteral("Stiff"));
}

TEST_F(ParameterProfilesTest, ReplacingAsksFirstAndKeepsTheNote) {
  write("mine.toml", "name = \"Mine\"\nnote = \"by hand\"\noverrides = [\"skin.fp=4\"]\n");
  ASSERT_TRUE(panel.apply_settings({QStringLiteral("liver.k=0.3")}));
  save_as("Mine");
  auto* question = part<QLabel>("parameter-profile-question");
  ASSERT_TRUE(question->isVisible());
  EXPECT_TRUE(question->text().contains(QStringLiteral("Replace “Mine”"))) << question->text().toStdString();
  EXPECT_EQ(cases::load_profile(place() / "mine.toml")->overrides, std::vector<std::string>{"skin.fp=4"});
  keep_picture("profiles_replace.png");
  click("parameter-profile-no");
  EXPECT_TRUE(part<QLineEdit>("parameter-profile-name")->isVisible()) << "for another name";
  key(*part<QLineEdit>("parameter-profile-name"), Qt::Key_Return);
  click("parameter-profile-yes");
  const cases::ProfileList list = cases::list_profiles(place());
  ASSERT_EQ(list.profiles.size(), 1u) << "not two of one name";
  EXPECT_EQ(list.profiles[0].overrides, std::vector<std::string>{"liver.k=0.3"});
  EXPECT_EQ(list.profiles[0].note, "by hand");
  EXPECT_EQ(choice().currentText(), QStringLiteral("Mine"));
  EXPECT_EQ(choice().count(), 2);
}

TEST_F(ParameterProfilesTest, DeletingAsksFirstAndKeepsTheSettings) {
  ASSERT_TRUE(panel.apply_settings({QStringLiteral("liver.k=0.3")}));
  save_as("Soft");
  click("parameter-profile-delete");
  EXPECT_TRUE(part<QLabel>("parameter-profile-question")->text().contains(QStringLiteral("Delete “Soft”")));
  EXPECT_TRUE(press_keys(panel, QStringLiteral("Escape")));
  EXPECT_FALSE(part<QLabel>("parameter-profile-question")->isVisible());
  EXPECT_EQ(cases::list_profiles(place()).profiles.size(), 1u);
  click("parameter-profile-delete");
  keep_picture("profiles_delete.png");
  click("parameter-profile-yes");
  EXPECT_TRUE(cases::list_profiles(place()).profiles.empty());
  EXPECT_EQ(panel.settings(), QStringList{QStringLiteral("liver.k=0.3")}) << "can be saved again";
  EXPECT_EQ(choice().currentIndex(), 0);
  EXPECT_TRUE(is_marked());
  EXPECT_FALSE(part<QToolButton>("parameter-profile-delete")->isEnabled());
  EXPECT_TRUE(problem().text().contains(QStringLiteral("Soft")));
  keep_picture("profiles_deleted.png");
}

TEST_F(ParameterProfilesTest, InvalidProfileShowsTheProblemAndChangesNothing) {
  write("far.toml", "name = \"Far\"\noverrides = [\"liver.mu=0.3\", \"liver.k=700\"]\n");
  ASSERT_TRUE(choose_entry(choice(), QStringLiteral("Far")));
  EXPECT_TRUE(problem().isVisible());
  EXPECT_TRUE(problem().text().contains(QStringLiteral("700"))) << problem().text().toStdString();
  EXPECT_TRUE(panel.settings().isEmpty());
  EXPECT_EQ(choice().currentIndex(), 0);
  keep_picture("profiles_problem.png");
  write("far.toml", "name = \"Far\"\nforce_model = \"magic\"\noverrides = [\"liver.mu=0.3\"]\n");
  ASSERT_TRUE(choose_entry(choice(), QStringLiteral("Far")));
  EXPECT_TRUE(problem().text().contains(QStringLiteral("magic")));
  EXPECT_TRUE(panel.settings().isEmpty());
  write("far.toml", "name = \"Far\"\noverides = []\n");
  EXPECT_EQ(choice().count(), 1);
  EXPECT_TRUE(problem().text().contains(QStringLiteral("overides"))) << problem().text().toStdString();
  keep_picture("profiles_unreadable.png");
  save_as("   ");
  EXPECT_TRUE(problem().text().contains(QStringLiteral("1 to 80"))) << problem().text().toStdString();
  EXPECT_TRUE(part<QLineEdit>("parameter-profile-name")->isVisible());
  EXPECT_EQ(panel.width(), 340);
}

TEST_F(ParameterProfilesTest, ReportsAFolderThatCannotBeCreated) {
  std::ofstream(folder / "file") << "no folder";
  panel.set_profile_folder(folder / "file" / "profiles");
  save_as("Soft");
  EXPECT_TRUE(problem().isVisible());
  EXPECT_TRUE(problem().text().contains(QStringLiteral("folder"))) << problem().text().toStdString();
  EXPECT_EQ(choice().count(), 1);
}

TEST_F(ParameterProfilesTest, FitsIn340PixelsWithALongProfileName) {
  save_as(std::string(80, 'W').c_str());
  click("parameter-profile-delete");
  QCoreApplication::processEvents();
  keep_picture("profiles_long.png");
  EXPECT_EQ(panel.width(), 340);
  EXPECT_LE(panel.minimumSizeHint().width(), 340);
  EXPECT_EQ(part<QLabel>("parameter-profile-question")->toolTip().size(), 80);
  click("parameter-profile-no");
  click("parameter-profile-save-as");
  QCoreApplication::processEvents();
  keep_picture("profiles_name.png");
  for (auto* button : panel.findChildren<QAbstractButton*>())
    if (button->isVisible()) {
      EXPECT_GE(button->width(), button->minimumSizeHint().width()) << button->objectName().toStdString();
      const int right = button->mapTo(&panel, QPoint(button->width(), 0)).x();
      EXPECT_LE(right, panel.width()) << button->objectName().toStdString();
    }
}

}  // namespace
}  // namespace trocar::trainer
