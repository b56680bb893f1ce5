// The program itself, in a real window, used as a person uses it: each script of test/scripts is played to its end.
// Opening a patient takes longer than most scripts: those that need no window of their own share one, and return to the
// start page.
#include <gtest/gtest.h>

#include <QDir>
#include <QFile>
#include <QImage>
#include <QProcess>
#include <QRegularExpression>
#include <QSettings>
#include <QTemporaryDir>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <thread>
#include <vector>

#include "config/json.h"
#include "core/testing/source_dir.h"
#include "devices/testing/gamepad_stand_in.h"
#include "devices/testing/hd_stand_ins.h"
#include "exams/exam_result.h"
#include "results/attempts.h"
#include "results/people.h"
#include "signing/signing_key.h"

namespace trocar::trainer {
namespace {

QString program() {
  return QString::fromUtf8(std::getenv("TROCAR_BIN_DIR")) + QStringLiteral("/trocar-trainer");
}

QString script_named(const char* name) {
  return QString::fromStdString((testing::source_dir() / "apps/trainer/test/scripts" / name).string());
}

struct Played {
  int exit_status = -1;
  QString output;
};

/// Settings and sessions in a folder of the test's own; embedded patients are cached beside the build.
struct WindowTest : ::testing::Test {
  Played run(const QStringList& arguments) const {
    QProcess process;
    QProcessEnvironment environment = QProcessEnvironment::systemEnvironment();
    environment.insert(QStringLiteral("XDG_CONFIG_HOME"), folder.filePath(QStringLiteral("config")));
    environment.insert(QStringLiteral("XDG_STATE_HOME"), folder.filePath(QStringLiteral("state")));
    environment.insert(QStringLiteral("XDG_DATA_HOME"), folder.filePath(QStringLiteral("data")));
    environment.insert(
        QStringLiteral("XDG_CACHE_HOME"),
        QDir(QString::fromUtf8(std::getenv("TROCAR_BIN_DIR"))).filePath(QStringLiteral("../test-cache")));
    process.setProcessEnvironment(environment);
    process.setProcessChannelMode(QProcess::MergedChannels);
    // Windows are drawn without a graphics card: the tests beside this one need the processor, too.
    process.start(program(), arguments + QStringList{QStringLiteral("--frame-rate"), QStringLiteral("12")});
    const bool is_slow_build = qEnvironmentVariableIsSet("TROCAR_SCRIPT_TIMEOUT_FACTOR");
    if (!process.waitForFinished(is_slow_build ? 1'500'000 : 900'000)) process.kill();
    process.waitForFinished();
    return {process.exitStatus() == QProcess::NormalExit ? process.exitCode() : -1,
            QString::fromUtf8(process.readAll())};
  }
  /// Plays scripts of test/scripts in one window, one after the other.
  Played play(const std::vector<const char*>& scripts, QStringList arguments = {}) const {
    for (const char* script : scripts) arguments << QStringLiteral("--script") << script_named(script);
    return run(arguments);
  }
  Played play_lumbar(const std::vector<const char*>& scripts) const {
    return play(scripts, {QStringLiteral("--task"), QStringLiteral("lumbar-puncture"), QStringLiteral("--patient"),
                          QStringLiteral("lumbar-1")});
  }
  QString write(const char* name, const QByteArray& text) const {
    QFile file(folder.filePath(QString::fromUtf8(name)));
    EXPECT_TRUE(file.open(QIODevice::WriteOnly));
    file.write(text);
    return file.fileName();
  }

  /// The cache's folder of the embedded patient; empty: it is not there.
  static QString find_cached_patient() {
    const QDir cache(QString::fromUtf8(std::getenv("TROCAR_BIN_DIR")) +
                     QStringLiteral("/../test-cache/trocar/patients"));
    const QStringList found = cache.entryList({QStringLiteral("abdomen-1-*")}, QDir::Dirs, QDir::Time);
    return found.isEmpty() ? QString() : cache.filePath(found.first());
  }

  /// The embedded patient from the cache, as a patient folder of that name in the start page's list.
  void copy_cached_patient(const QString& name) const {
    const QString from = find_cached_patient(), to = folder.filePath(name);
    ASSERT_FALSE(from.isEmpty());
    std::filesystem::copy(from.toStdString(), to.toStdString(), std::filesystem::copy_options::recursive);
    QFile file(to + QStringLiteral("/patient.toml"));
    ASSERT_TRUE(file.open(QIODevice::ReadOnly));
    const QByteArray text = file.readAll().replace("name = \"abdomen\"", "name = \"" + name.toUtf8() + "\"");
    file.close();
    ASSERT_TRUE(file.open(QIODevice::WriteOnly));
    file.write(text);
    QSettings settings(folder.filePath(QStringLiteral("config/trocar/trocar-trainer.conf")), QSettings::IniFormat);
    const QString key = QStringLiteral("start/folders");
    settings.setValue(key, settings.value(key).toStringList() << to);
  }

  QTemporaryDir folder;
};

/// A person beside the window: performs one act after the other, each as soon as it is due.
class Person {
 public:
  struct Act {
    std::function<bool()> is_due;
    std::function<void()> act;
  };
  explicit Person(std::vector<Act> acts)
      : thread_([this, acts = std::move(acts)](const std::stop_token& stop) {
          for (const Act& act : acts) {
            while (!act.is_due()) {
              if (stop.stop_requested()) return;
              std::this_thread::sleep_for(std::chrono::milliseconds(5));
            }
            act.act();
          }
          has_done_all_ = true;
        }) {}
  bool has_done_all() const { return has_done_all_; }

 private:
  std::atomic<bool> has_done_all_{false};
  std::jthread thread_;
};

void expect_played(const Played& played) {
  EXPECT_EQ(played.exit_status, 0) << played.output.toStdString();
}

/// The sessions of a state folder have one result, which is signed with its key.
void expect_signed_exam(const std::filesystem::path& state) {
  const auto key = signing::load_station_key(state / exams::kStationKeyFile);
  ASSERT_TRUE(key) << key.error().text();
  std::vector<std::filesystem::path> results;
  for (const auto& entry : std::filesystem::directory_iterator(state / "sessions"))
    if (entry.path().string().ends_with(".result.json")) results.push_back(entry.path());
  ASSERT_EQ(results.size(), 1u);
  const auto verification = exams::verify_exam(results.front(), key->public_key());
  ASSERT_TRUE(verification) << verification.error().text();
  EXPECT_EQ(verification->verdict, exams::Verdict::kValid) << verification->text;
  EXPECT_EQ(verification->text.find("not checked"), std::string::npos) << verification->text;
  const auto json = config::load_json(results.front());
  ASSERT_TRUE(json) << json.error().text();
  EXPECT_EQ((*json)["level"], "exam");
  EXPECT_EQ((*json)["body_was_known"], false);
  EXPECT_GE((*json)["exam_number"].get<int>(), 1000);
  EXPECT_TRUE((*json)["person"].is_null()) << "nobody was chosen";
  EXPECT_TRUE((*json)["changed_settings"].empty()) << (*json)["changed_settings"].dump();
}

// By keys alone, by mouse from the start page to the score and again; the replay; the case builder beside; the help
// levels.
TEST_F(WindowTest, RunsABiopsyFromStartPageToScore) {
  expect_played(play({"keyboard.txt", "biopsy.txt", "transducer.txt", "case_builder.txt", "help_levels.txt"}));
}

// A device that is not there, a killed server, stopped forces, the question before the end.
TEST_F(WindowTest, CompletesTheTutorialByGestures) {
  expect_played(play({"tutorial.txt"}));
}

TEST_F(WindowTest, ReportsFaultsAndContinuesThePuncture) {
  const trocar::testing::GamepadStandIn unplugged(false);
  expect_played(play({"no_device.txt", "server_killed.txt", "forces_stopped.txt", "layouts.txt", "end_asked_narrow.txt",
                      "end_asked.txt"}));
}

TEST_F(WindowTest, ExamHidesGuidanceAndCannotBeAltered) {
  const Played played = play({"exam.txt"});
  expect_played(played);
  for (const char* fact : {"depth_mm: ", "distance_mm: ", "tissue: ", "picture_from_plan_mm: ", "entry_from_plan_mm: "})
    EXPECT_TRUE(played.output.contains(QString::fromLatin1(fact) + QLatin1Char('\n'))) << fact;
  expect_signed_exam(folder.filePath(QStringLiteral("state/trocar")).toStdString());
}

TEST_F(WindowTest, UnwritableStateFolderBlocksTheStart) {
  const QString script = write("unwritable.txt",
                               "expect banner has \"/dev/null/state/sessions\"\nexpect banner has \"--state\"\n"
                               "click start\nwait-for is_open is true within 300\nwait 3\nkey Return\nwait 1\n"
                               "expect page is briefing\nexpect banner has \"/dev/null/state/sessions\"\n");
  expect_played(
      run({QStringLiteral("--state"), QStringLiteral("/dev/null/state"), QStringLiteral("--script"), script}));
}

/// The script of every page, in a window of that size; pictures are not waited for.
QByteArray all_pages(int columns, int rows) {
  QFile script(script_named("all_pages.txt"));
  EXPECT_TRUE(script.open(QIODevice::ReadOnly));
  static const QRegularExpression pause(QStringLiteral("^wait [0-9.]+$"), QRegularExpression::MultilineOption);
  return QStringLiteral("resize %1 %2\n%3")
      .arg(columns)
      .arg(rows)
      .arg(QString::fromUtf8(script.readAll()).replace(pause, QStringLiteral("wait 0.2")))
      .toUtf8();
}

TEST_F(WindowTest, EveryPageFitsSmallScreensAndGermanText) {
  expect_played(run({QStringLiteral("--script"), write("small.txt", all_pages(1024, 768))}));
  expect_played(run({QStringLiteral("--language"), QStringLiteral("de"), QStringLiteral("--script"),
                     write("usual.txt", all_pages(1280, 800))}));
}

TEST_F(WindowTest, APersonsAttemptsAreRecordedAndCompared) {
  expect_played(play({"person.txt"}, {QStringLiteral("--breathing"), QStringLiteral("none")}));
  auto repository =
      results::Repository::open({folder.filePath(QStringLiteral("data/trocar/results.sqlite")).toStdString(), {}});
  ASSERT_TRUE(repository) << repository.error().text();
  const auto person = results::get_person_named(*repository, "anna meier");
  ASSERT_TRUE(person) << person.error().text();
  EXPECT_TRUE(person->has_pin);
  const auto attempts = results::list_attempts(*repository, {person->id});
  ASSERT_TRUE(attempts);
  ASSERT_EQ(attempts->size(), 1u);
  EXPECT_EQ(attempts->front().state, results::State::kFinished);
  EXPECT_EQ(attempts->front().level, "guided");
  EXPECT_TRUE(attempts->front().score.has_value());
  EXPECT_TRUE(results::load_recording(*repository, attempts->front().id)->has_value());
}

TEST_F(WindowTest, GamepadDrivesTheNeedleAndMayBeUnplugged) {
  trocar::testing::GamepadStandIn pad;
  // The script takes a picture where it is the person's turn.
  const auto at_picture = [&](const char* name) { return QFile::exists(folder.filePath(QString::fromUtf8(name))); };
  Person person({{[&] { return at_picture("ready.png"); }, [&] { pad.pull_right_trigger(0.7); }},
                 {[&] { return at_picture("inside.png"); }, [&] { pad.pull_right_trigger(0.0); }},
                 {[&] { return at_picture("rests.png"); }, [&] { pad.plug(false); }},
                 {[&] { return at_picture("gone.png"); }, [&] { pad.plug(true); }},
                 {[&] { return at_picture("again.png"); }, [&] { pad.pull_right_trigger(0.7); }}});
  QFile script(script_named("gamepad.txt"));
  ASSERT_TRUE(script.open(QIODevice::ReadOnly));
  const QString here = QString::fromUtf8(script.readAll()).replace(QStringLiteral("FOLDER"), folder.path());
  expect_played(run({QStringLiteral("--script"), write("gamepad.txt", here.toUtf8())}));
  EXPECT_TRUE(person.has_done_all());
  EXPECT_GT(pad.strongest_rumble(), 0);
}

TEST_F(WindowTest, TwoHapticDevicesAreListedTestedAndMoveTheTools) {
  trocar::testing::HdStandIns devices;
  trocar::testing::HdControls& premium = devices.add_premium("Left Device");
  trocar::testing::HdControls& omni = devices.add_omni("Right Device");
  const auto played_in = [&](const QString& pictures) {
    place(premium, {-29.0, 33.0, 80.0});  // beside the patient's right flank, at the height of the planned entry
    place(omni, {0.0, 40.0, 0.0});
    omni.is_present = 1;
    for (trocar::testing::HdControls* device : {&premium, &omni})
      device->tremor_mm = 0.03;  // no hand is as still as an encoder that is stuck
    const auto at_picture = [&](const char* name) { return QFile::exists(pictures + QString::fromUtf8(name)); };
    Person person({{[&] { return at_picture("/needle.png"); },
                    [&] {
                      glide(premium, {-9.0, 33.0, 80.0}, 40.0);
                      glide(premium, {-29.0, 33.0, 80.0}, 40.0);
                    }},
                   {[&] { return at_picture("/ready.png"); },
                    [&] {
                      glide(premium, {-29.0, 33.0, 0.0}, 15.0);
                    }},
                   {[&] { return at_picture("/inside.png"); },
                    [&] {
                      glide(omni, {0.0, 20.0, 0.0}, 20.0);
                    }},
                   {[&] { return at_picture("/unplug.png"); }, [&] { omni.is_present = 0; }},
                   {[&] { return at_picture("/plug.png"); }, [&] { omni.is_present = 1; }}});
    QFile script(script_named("two_devices.txt"));
    EXPECT_TRUE(script.open(QIODevice::ReadOnly));
    EXPECT_TRUE(QDir().mkpath(pictures));
    const QString here = QString::fromUtf8(script.readAll()).replace(QStringLiteral("FOLDER"), pictures);
    Played played = run({QStringLiteral("--script"), write("two_devices.txt", here.toUtf8())});
    EXPECT_TRUE(played.exit_status != 0 || person.has_done_all());
    return played;
  };
  // A machine too busy for a device in a real hand stops its forces until somebody requests them again, who is not
  // here. Whatever else fails is not tried again.
  const auto was_too_busy = [](const Played& played) {
    const auto says = [&](const char* part) { return played.output.contains(QString::fromLatin1(part)); };
    return played.exit_status == 1 && (says("Request it again") || (says("window message: ") && says("resume")));
  };
  Played played = played_in(folder.filePath(QStringLiteral("1")));
  for (int again = 2; again <= 3 && was_too_busy(played); ++again) {
    qWarning("this machine was too busy, tried again: %s", qPrintable(played.output.trimmed()));
    played = played_in(folder.filePath(QString::number(again)));
  }
  expect_played(played);
  EXPECT_GT(premium.strongest_n, 0.3) << "the tissue was felt";
}

/// The image in a picture of the X-ray view: the square in its middle, coarse enough that noise is averaged.
QImage xray_in(const QString& file) {
  const QImage picture(file);
  const int edge = std::min(picture.width(), picture.height());
  constexpr int kPixels = 128;
  return picture.copy((picture.width() - edge) / 2, (picture.height() - edge) / 2, edge, edge)
      .scaled(kPixels, kPixels, Qt::IgnoreAspectRatio, Qt::SmoothTransformation)
      .convertToFormat(QImage::Format_Grayscale8);
}

/// Share of the pixels that are darker in `b` than in `a` by at least some gray levels; without the texts at the edges.
double darker_share(const QImage& a, const QImage& b, int least) {
  int darker = 0, all = 0;
  for (int y = a.height() / 5; y < 4 * a.height() / 5; ++y)
    for (int x = 0; x < a.width(); ++x, ++all) darker += qGray(a.pixel(x, y)) - qGray(b.pixel(x, y)) >= least ? 1 : 0;
  return static_cast<double>(darker) / all;
}

// Step by step with the needle, compared with several expert paths, and with a finger that feels the spine.
TEST_F(WindowTest, GuidesALumbarPunctureWithPalpation) {
  expect_played(play_lumbar({"lumbar.txt", "expert_paths.txt", "palpation.txt"}));
}

TEST_F(WindowTest, AscitesIsPuncturedAfterAnUltrasoundCheck) {
  expect_played(run({QStringLiteral("--task"), QStringLiteral("ascites-puncture"), QStringLiteral("--patient"),
                     QStringLiteral("ascites-1"), QStringLiteral("--script"), script_named("ascites.txt")}));
}

TEST_F(WindowTest, ABileDuctIsPuncturedUnderFluoroscopy) {
  QFile script(script_named("fluoroscopy.txt"));
  ASSERT_TRUE(script.open(QIODevice::ReadOnly));
  const QString here = QString::fromUtf8(script.readAll()).replace(QStringLiteral("FOLDER"), folder.path());
  expect_played(run({QStringLiteral("--task"), QStringLiteral("ptcd"), QStringLiteral("--patient"),
                     QStringLiteral("ptcd-1"), QStringLiteral("--breathing"), QStringLiteral("none"),
                     QStringLiteral("--script"), write("fluoroscopy.txt", here.toUtf8())}));
  const auto image = [this](const char* name) { return xray_in(folder.filePath(QString::fromUtf8(name))); };
  const QImage live = image("live.png"), filled = image("filled.png"), empty = image("empty.png"),
               none = image("none.png"), again = image("filled_again.png");
  ASSERT_FALSE(live.isNull() || filled.isNull() || empty.isNull() || none.isNull() || again.isNull());
  constexpr int kDark = 40;  // gray levels
  EXPECT_GT(darker_share(empty, filled, kDark), 0.005) << "the ducts are filled";
  EXPECT_LT(darker_share(filled, empty, kDark), 0.001);
  // The replay shows what the trainee saw.
  EXPECT_LT(darker_share(live, filled, kDark) + darker_share(filled, live, kDark), 0.001);
  EXPECT_EQ(darker_share(again, filled, 1) + darker_share(filled, again, 1), 0.0) << "a moment has one image";
  EXPECT_GT(darker_share(empty, none, kDark), 0.5) << "black before the first pulse";
}

TEST_F(WindowTest, ReplaysAnAttemptAfterACrash) {
  // The window is killed in mid-puncture by its own script's host.
  const QString script =
      write("cut.txt",
            "click start\nwait-for is_open is true within 300\nclick begin\n"
            "wait-for phase is ready within 120\nkey A\nkey H\nwait-for entry_from_plan_mm < 1 within 60\n"
            "wheel-until view-3d 10 depth_mm > 15 within 60\n"
            "wait 1\nend-window\n");
  EXPECT_EQ(run({QStringLiteral("--script"), script}).exit_status, -1);
  // Killed while the recording opens, and left with Back: it is offered again.
  const QString killed = write("killed.txt", "click recover\nwait-for page is briefing within 60\nend-window\n");
  EXPECT_EQ(run({QStringLiteral("--script"), killed}).exit_status, -1);
  expect_played(run({QStringLiteral("--script"),
                     write("left.txt",
                           "click recover\nwait-for page is briefing within 60\nclick back\n"
                           "wait-for page is start within 20\nclick recover\nwait-for page is briefing within 60\n"
                           "click back\nwait-for page is start within 20\n")}));
  const QString again = write("again.txt",
                              "click recover\nwait-for page is feedback within 300\nexpect was_cut_off is true\n"
                              "expect duration_s > 1\n");
  expect_played(run({QStringLiteral("--script"), again}));
}

TEST_F(WindowTest, TheNamedPatientBringsItsTask) {
  const auto chosen = [&](const char* task, const char* patient) {
    return write("chosen.txt",
                 QByteArray("expect chosen_task is ") + task + "\nexpect chosen_patient is " + patient + "\n");
  };
  const QString patient = QStringLiteral("--patient"), task = QStringLiteral("--task"),
                script = QStringLiteral("--script");
  // The start page would offer a liver biopsy.
  expect_played(run({patient, QStringLiteral("lumbar-2"), script, chosen("lumbar-puncture", "lumbar-2")}));
  expect_played(run({patient, QStringLiteral("biopsy-1"), script, chosen("liver-biopsy", "biopsy-1")}));
  const Played refused = run({task, QStringLiteral("lumbar-puncture"), patient, QStringLiteral("biopsy-1")});
  EXPECT_EQ(refused.exit_status, 2);
  EXPECT_TRUE(refused.output.contains(QStringLiteral("not for this task"))) << refused.output.toStdString();
  const Played no_patient = run({patient, folder.path()});
  EXPECT_EQ(no_patient.exit_status, 2);
  EXPECT_TRUE(no_patient.output.contains(QStringLiteral("no patient.toml"))) << no_patient.output.toStdString();
}

TEST_F(WindowTest, BenchmarkDoesNotChangeSettings) {
  const QByteArray kept("[desk]\nlayout=Slices\n");
  ASSERT_TRUE(QDir(folder.path()).mkpath(QStringLiteral("config/trocar")));
  QFile settings(folder.filePath(QStringLiteral("config/trocar/trocar-trainer.conf")));
  ASSERT_TRUE(settings.open(QIODevice::WriteOnly));
  settings.write(kept);
  settings.close();
  const Played played = run({QStringLiteral("--benchmark"), QStringLiteral("--layout"), QStringLiteral("Navigation")});
  expect_played(played);
  EXPECT_TRUE(played.output.contains(QStringLiteral("layout: Navigation"))) << played.output.toStdString();
  EXPECT_TRUE(played.output.contains(QStringLiteral("frame_p99_ms: "))) << played.output.toStdString();
  EXPECT_EQ(run({QStringLiteral("--benchmark"), QStringLiteral("--layout"), QStringLiteral("none")}).exit_status, 2);
  ASSERT_TRUE(settings.open(QIODevice::ReadOnly));
  EXPECT_EQ(settings.readAll(), kept);
}

TEST_F(WindowTest, MemoryDoesNotGrowFromCaseToCase) {
  if (find_cached_patient().isEmpty())
    expect_played(
        run({QStringLiteral("--script"), write("open.txt", "click start\nwait-for is_open is true within 300\n")}));
  copy_cached_patient(QStringLiteral("case A"));
  copy_cached_patient(QStringLiteral("case B"));
  QByteArray steps;
  for (const char* name : {"A", "B", "A"})
    steps += QByteArray("choose patients \"case ") + name +
             "\"\nclick start\nwait-for is_open is true within 300\nclick begin\nwait-for phase is ready within 120\n"
             "key A\nkey H\nwait-for entry_from_plan_mm < 1 within 60\n"
             "wheel-until view-3d 10 depth_mm > 15 within 60\nkey E\nkey Return\nwait-for page is feedback within 120\n"
             "key Ctrl+N\nwait-for page is start within 20\nprint memory_mb\n";
  const Played played = run({QStringLiteral("--script"), write("cases.txt", steps)});
  expect_played(played);
  std::vector<double> memory_mb;
  for (const QString& line : played.output.split(QLatin1Char('\n')))
    if (line.startsWith(QLatin1String("memory_mb: "))) memory_mb.push_back(line.mid(11).toDouble());
  ASSERT_EQ(memory_mb.size(), 3U) << played.output.toStdString();
  constexpr double kScatter_mb = 200.0;  // a case of this patient that stays in memory takes some 400 MB
  EXPECT_LT(memory_mb[2], memory_mb[1] + kScatter_mb) << played.output.toStdString();
}

TEST_F(WindowTest, FailedScriptNamesItsLine) {
  const Played played = run({QStringLiteral("--script"), write("wrong.txt", "expect page is start\nclick nowhere\n")});
  EXPECT_EQ(played.exit_status, 1);
  EXPECT_TRUE(played.output.contains(QStringLiteral("line 2"))) << played.output.toStdString();
}

TEST_F(WindowTest, ReportsWrongArgumentsInOneLine) {
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

TEST_F(WindowTest, ScreenshotShowsTheWholeWindow) {
  const QString picture = folder.filePath(QStringLiteral("window.png"));
  expect_played(run({QStringLiteral("--screenshot"), picture}));
  const QImage image(picture);
  EXPECT_GE(image.width(), 1280);
  EXPECT_GE(image.height(), 800);
}

}  // namespace
}  // namespace trocar::trainer
