#include "pages/patient_cards.h"

#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QImage>
#include <QScrollBar>
#include <QTemporaryDir>
#include <fstream>
#include <set>

#include "core/files/folders.h"
#include "io/patient/patient_extras.h"
#include "io/patient/patient_folder.h"
#include "phantom/phantom.h"
#include "test/widget_actions.h"
#include "ui_kit/parts.h"
#include "ui_kit/theme.h"

namespace trocar::trainer {
namespace {

/// Made-up patients: name, difficulty and picture file differ.
std::vector<PatientEntry> made_up(int count, const QString& picture = {}) {
  std::vector<PatientEntry> entries;
  for (int n = 1; n <= count; ++n) {
    PatientEntry entry;
    entry.source = entry.name = QStringLiteral("lumbar-%1").arg(n);
    entry.task = QStringLiteral("Lumbar puncture");
    entry.description =
        QStringLiteral("Made up for a test, with a description that is too long for one line of a card");
    entry.thumbnail = n % 2 == 0 ? picture : QString();
    entry.difficulty = 1 + (n - 1) % 5;
    entries.push_back(entry);
  }
  return entries;
}

struct PatientCardsTest : ::testing::Test {
  QString write_picture(const QColor& color, QSize size = {320, 200}) {
    QImage image(size, QImage::Format_RGB32);
    image.fill(color);
    const QString file = folder.filePath(QStringLiteral("picture.png"));
    image.save(file);
    return file;
  }
  QRgb middle_of_picture(PatientCards& cards, int row) {
    const QRect rect = cards.visualItemRect(cards.item(row));
    return cards.viewport()->grab().toImage().pixel(rect.center().x(), rect.top() + rect.height() / 3);
  }
  QTemporaryDir folder;
};

TEST_F(PatientCardsTest, SelectedCardIsFullyVisibleAtEverySize) {
  PatientCards cards;
  cards.resize(640, 480);
  cards.show_patients(made_up(9));
  cards.show();
  ASSERT_TRUE(cards.choose(QStringLiteral("lumbar-7")));
  for (const QSize size : {QSize(760, 420), QSize(640, 300), QSize(900, 380)}) {
    cards.resize(size);
    QCoreApplication::processEvents();
    const QRect card = cards.visualItemRect(cards.currentItem());
    EXPECT_TRUE(cards.viewport()->rect().contains(card))
        << size.width() << "x" << size.height() << ": card from " << card.top() << " to " << card.bottom();
  }
}

TEST_F(PatientCardsTest, ShowTheThumbnailOrAPlaceholder) {
  PatientCards cards;
  cards.resize(640, 480);
  cards.show_patients(made_up(2, write_picture(Qt::magenta)));
  cards.show();
  EXPECT_EQ(QColor(middle_of_picture(cards, 1)), QColor(Qt::magenta));
  const QRect rect = cards.visualItemRect(cards.item(0));
  const QImage drawn = cards.viewport()->grab(rect).toImage();
  std::set<QRgb> colors;
  for (int y = 20; y < rect.height() / 2; ++y) colors.insert(drawn.pixel(rect.width() / 2, y));
  EXPECT_GT(colors.size(), 1u) << "head and shoulders, not an empty box";
  save(cards, "cards.png");
}

TEST_F(PatientCardsTest, IgnoresAnOversizedThumbnail) {
  PatientCards cards;
  cards.resize(640, 480);
  cards.show_patients(made_up(2, write_picture(Qt::magenta, {4000, 10})));
  cards.show();
  EXPECT_NE(QColor(middle_of_picture(cards, 1)), QColor(Qt::magenta));
}

TEST_F(PatientCardsTest, DamagedThumbnailGivesAPlaceholder) {
  const QString file = folder.filePath(QStringLiteral("picture.png"));
  std::ofstream(to_std(file)) << "\x89PNG damaged";
  PatientCards cards;
  cards.show_patients(made_up(2, file));
  EXPECT_TRUE(cards.item(1)->data(Qt::DecorationRole).value<QPixmap>().isNull());
}

TEST_F(PatientCardsTest, DotsShowTheDifficulty) {
  PatientCards cards;
  cards.resize(1300, 600);
  cards.show_patients(made_up(5));
  cards.show();
  // The filled dots have the colour of the accent; the frame of the selected card has it, too.
  cards.setCurrentRow(-1);
  const auto accents = [&](int row) {
    const QImage drawn = cards.viewport()->grab(cards.visualItemRect(cards.item(row))).toImage();
    int pixels = 0;
    for (int y = drawn.height() / 2; y < drawn.height(); ++y)
      for (int x = 0; x < drawn.width(); ++x) pixels += QColor(drawn.pixel(x, y)) == theme().accent ? 1 : 0;
    return pixels;
  };
  const int one = accents(0);
  EXPECT_GT(one, 4);
  for (int row = 1; row < 5; ++row) EXPECT_NEAR(accents(row), (row + 1) * one, one) << row;
}

TEST_F(PatientCardsTest, FitTheWidthAndScroll) {
  PatientCards cards;
  cards.show_patients(made_up(25));
  cards.resize(420, 400);
  cards.show();
  QCoreApplication::processEvents();
  const auto columns = [&] {
    int found = 0;
    while (found < cards.count() &&
           cards.visualItemRect(cards.item(found)).top() == cards.visualItemRect(cards.item(0)).top())
      ++found;
    return found;
  };
  EXPECT_EQ(columns(), 2);
  EXPECT_GT(cards.verticalScrollBar()->maximum(), 0);
  EXPECT_EQ(cards.horizontalScrollBar()->maximum(), 0);
  cards.resize(1000, 400);
  QCoreApplication::processEvents();
  EXPECT_GE(columns(), 4);
  save(cards, "many_cards.png");
  for (int row = 0; row < cards.count(); ++row)
    EXPECT_LE(cards.visualItemRect(cards.item(row)).right(), cards.viewport()->width());
}

TEST_F(PatientCardsTest, ArrowKeysSelectInTheGrid) {
  PatientCards cards;
  cards.resize(640, 480);
  cards.show_patients(made_up(9));
  cards.show();
  QCoreApplication::processEvents();
  EXPECT_EQ(cards.chosen()->source, QStringLiteral("lumbar-1"));
  press_key(cards, Qt::Key_Right);
  EXPECT_EQ(cards.chosen()->source, QStringLiteral("lumbar-2"));
  press_key(cards, Qt::Key_Down);
  EXPECT_EQ(cards.chosen()->source, QStringLiteral("lumbar-5")) << "three columns";
  press_key(cards, Qt::Key_End);
  EXPECT_EQ(cards.chosen()->source, QStringLiteral("lumbar-9"));
}

TEST_F(PatientCardsTest, KeepTheSelectionAndDescribeCardsInSentences) {
  PatientCards cards;
  cards.show_patients(made_up(5));
  ASSERT_TRUE(cards.choose(QStringLiteral("lumbar-3")));
  cards.show_patients(made_up(4));
  EXPECT_EQ(cards.chosen()->source, QStringLiteral("lumbar-3"));
  cards.show_patients(made_up(2));
  EXPECT_EQ(cards.chosen()->source, QStringLiteral("lumbar-1"));
  EXPECT_FALSE(cards.choose(QStringLiteral("nobody")));
  EXPECT_EQ(cards.item(1)->data(Qt::AccessibleTextRole).toString().section(',', 0, 2),
            QStringLiteral("lumbar-2, Lumbar puncture, difficulty 2 of 5"));
  cards.show_patients({});
  EXPECT_EQ(cards.chosen(), nullptr);
}

TEST(PatientEntry, ListsEmbeddedPatientsByDifficulty) {
  const auto entries = embedded_entries(QStringLiteral("liver-biopsy"), QStringLiteral("Biopsy of a liver lesion"));
  ASSERT_FALSE(entries.empty());
  for (std::size_t n = 0; n < entries.size(); ++n) {
    EXPECT_EQ(entries[n].task, QStringLiteral("Biopsy of a liver lesion"));
    EXPECT_FALSE(entries[n].description.isEmpty());
    if (n > 0) {
      EXPECT_GE(entries[n].difficulty, entries[n - 1].difficulty);
    }
  }
  EXPECT_TRUE(embedded_entries(QStringLiteral("no-such-task"), {}).empty());
}

TEST(PatientEntry, FolderEntryHasItsThumbnail) {
  const trocar::TemporaryFolder cases;
  auto patient = phantom::generate_phantom("layers-liver", 1);
  ASSERT_TRUE(patient) << patient.error().text();
  const auto at = cases / "case-7";
  ASSERT_TRUE(io::save_patient(*patient, {}, at, {}, {{io::kThumbnailFile, "bytes"}}));
  const PatientEntry entry = folder_entry(to_qt(at.string()));
  EXPECT_EQ(to_std(entry.thumbnail), (at / io::kThumbnailFile).string());
  EXPECT_EQ(entry.difficulty, 0);
  EXPECT_EQ(spoken_text(entry), entry.name + QStringLiteral(", ") + entry.description);
  const PatientEntry none = folder_entry(QStringLiteral("/somewhere/patient-7"));
  EXPECT_EQ(none.name, QStringLiteral("patient-7"));
  EXPECT_FALSE(none.description.isEmpty());
}

}  // namespace
}  // namespace trocar::trainer
