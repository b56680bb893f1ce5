// The program itself, in a real window, used as a person uses it: each script of test/scripts is played to its end.
#include <gtest/gtest.h>

#include <QDir>
#include <QFile>
#include <QImage>
#include <QProcess>
#include <QTemporaryDir>
#include <cstdlib>

namespace trocar::trainer {
namespace {

QString program() {
  return QString::fromUtf8(std::getenv("TROCAR_BIN_DIR")) + QStringLiteral("/trocar-trainer");
}

struct Played {
  int exit_status = -1;
  QString output;
};

/// Settings and sessions in a folder of the test's own; patients made once are kept beside the build.
struct WindowTest : testing::Test {
  Played run(const QStringList& arguments) const {
    QProcess process;
    QProcessEnvironment environment = QProcessEnvironment::systemEnvironment();
    environment.insert(QStringLiteral("XDG_CONFIG_HOME"), folder.filePath(QStringLiteral("config")));
    environment.insert(QStringLiteral("XDG_STATE_HOME"), folder.filePath(QStringLiteral("state")));
    environment.insert(
        QStringLiteral("XDG_CACHE_HOME"),
        QDir(QString::fromUtf8(std::getenv("TROCAR_BIN_DIR"))).filePath(QStringLiteral("../test-cache")));
    process.setProcessEnvironment(environment);
    process.setProcessChannelMode(QProcess::MergedChannels);
    process.start(program(), arguments);
    constexpr int kPatience_ms = 400'000;
    if (!process.waitForFinished(kPatience_ms)) process.kill();
    process.waitForFinished();
    return {process.exitStatus() == QProcess::NormalExit ? process.exitCode() : -1,
            QString::fromUtf8(process.readAll())};
  }
  Played play(const char* script) const {
    return run({QStringLiteral("--script"),
                QStringLiteral(TROCAR_SOURCE_DIR "/apps/trainer/test/scripts/") + QString::fromUtf8(script)});
  }
  QString write(const char* name, const char* text) const {
    QFile file(folder.filePath(QString::fromUtf8(name)));
    EXPECT_TRUE(file.open(QIODevice::WriteOnly));
    file.write(text);
    return file.fileName();
  }

  QTemporaryDir folder;
};

void expect_played(const Played& played) {
  EXPECT_EQ(played.exit_status, 0) << played.output.toStdString();
}

TEST_F(WindowTest, ABiopsyGoesFromTheStartPageToTheScoreAndAgain) {
  expect_played(play("biopsy.txt"));
}

TEST_F(WindowTest, AKilledServerComesBackAndThePunctureGoesOn) {
  expect_played(play("server_killed.txt"));
}

TEST_F(WindowTest, ForcesAreStoppedAndTurnedOnAgain) {
  expect_played(play("forces_stopped.txt"));
}

TEST_F(WindowTest, EveryLayoutShowsWhatItNames) {
  expect_played(play("layouts.txt"));
}

TEST_F(WindowTest, TheReplayMovesTheTransducerAsItWasMoved) {
  expect_played(play("transducer.txt"));
}

TEST_F(WindowTest, AnAttemptThatACrashCutOffCanBeSeenAgain) {
  // The window is killed in mid-puncture by its own script's host.
  const QString script = write("cut.txt",
                               "click start\nwait-for is_open is true within 300\nclick begin\n"
                               "wait-for phase is ready within 120\nwheel-until view-3d 10 depth_mm > 15 within 60\n"
                               "wait 1\nend-window\n");
  EXPECT_EQ(run({QStringLiteral("--script"), script}).exit_status, -1);
  const QString again = write("again.txt",
                              "click recover\nwait-for page is feedback within 300\nexpect was_cut_off is true\n"
                              "expect duration_s > 1\n");
  expect_played(run({QStringLiteral("--script"), again}));
}

TEST_F(WindowTest, AScriptThatFailsSaysWhere) {
  const Played played = run({QStringLiteral("--script"), write("wrong.txt", "expect page is start\nclick nowhere\n")});
  EXPECT_EQ(played.exit_status, 1);
  EXPECT_TRUE(played.output.contains(QStringLiteral("line 2"))) << played.output.toStdString();
}

TEST_F(WindowTest, WrongArgumentsAreToldInOneLine) {
  EXPECT_EQ(run({QStringLiteral("--script"), QStringLiteral("/nowhere/steps.txt")}).exit_status, 2);
  EXPECT_EQ(run({QStringLiteral("--unheard-of")}).exit_status, 2);
  for (const char* name : {"--patient", "--task"}) {
    const Played wrong = run({QString::fromUtf8(name), QStringLiteral("nobody")});
    EXPECT_EQ(wrong.exit_status, 2) << name;
    EXPECT_TRUE(wrong.output.contains(QStringLiteral("nobody"))) << wrong.output.toStdString();
  }
  const Played played = run({QStringLiteral("--script"), write("bad.txt", "dance\n")});
  EXPECT_EQ(played.exit_status, 1);
  EXPECT_TRUE(played.output.contains(QStringLiteral("dance"))) << played.output.toStdString();
}

TEST_F(WindowTest, ASavedPictureIsOfTheWholeWindow) {
  const QString picture = folder.filePath(QStringLiteral("window.png"));
  expect_played(run({QStringLiteral("--screenshot"), picture}));
  const QImage image(picture);
  EXPECT_GE(image.width(), 1280);
  EXPECT_GE(image.height(), 800);
}

}  // namespace
}  // namespace trocar::trainer
