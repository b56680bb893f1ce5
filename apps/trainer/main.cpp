// trocar-trainer: the trainer's window.
#include <fmt/format.h>

#include <QPixmap>
#include <QSettings>
#include <QTemporaryDir>
#include <QTimer>
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>

#include "command.h"
#include "core/files/folders.h"
#include "core/version.h"
#include "motion/breathing_choice.h"
#include "pages/start_page.h"
#include "phantom/phantom.h"
#include "program_end.h"
#include "results/repository.h"
#include "scene/render_patient.h"
#include "script/benchmark.h"
#include "script/script_player.h"
#include "shell/main_window.h"
#include "shell/trainer_flow.h"
#include "tasks/task.h"
#include "ui_kit/action_table.h"
#include "ui_kit/parts.h"
#include "ui_kit/screen_scale.h"
#include "ui_kit/theme.h"
#include "ui_kit/trainer_application.h"
#include "ui_kit/window_language.h"

namespace {

using namespace trocar;
using namespace trocar::trainer;
namespace fs = std::filesystem;

struct Arguments {
  std::optional<std::string> task, patient, breathing;
  std::optional<std::uint64_t> patient_seed;
  std::vector<std::string> scripts;
  std::string screenshot, state_folder, database;
  int frame_rate_hz = 60;
  std::string language;  ///< Empty: the one chosen in the window, else the desktop's.
  bool is_benchmark = false, prints_keys = false;
  std::vector<std::string> layouts;
};

void add_options(arguments::Program& app, Arguments& arguments) {
  app.add_option("--task", arguments.task, "Task selected at the start");
  app.add_option("--patient", arguments.patient, "Patient folder, or an embedded patient's name");
  app.add_option("--patient-seed", arguments.patient_seed, "Random seed for the anatomy of an embedded patient [1]")
      .seed();
  app.add_option("--breathing", arguments.breathing,
                 "How the patient breathes: none, quiet, deep or the liver's motion in mm, then for example "
                 ",rate=18,hold-limit=12 [as the task says]");
  app.add_option("--script", arguments.scripts,
                 "Run scripts of user actions one after the other, then exit; exit status 1 if a step fails")
      .existing_file();
  app.add_option("--screenshot", arguments.screenshot,
                 "Save the window as a PNG and exit; after the script if there is one");
  const arguments::Option benchmark =
      app.add_flag("--benchmark", arguments.is_benchmark, "Run a puncture in every layout and print frame times");
  app.add_option("--layout", arguments.layouts, "Layouts of the benchmark [all]").needs(benchmark);
  app.add_option("--frame-rate", arguments.frame_rate_hz,
                 "Frames per second, at most: fewer leave more of a slow processor to the simulation [60]")
      .whole_number_within(1, 60);
  app.add_option("--language", arguments.language,
                 "Language of the window: en, de [the one chosen in the window, else the desktop's]");
  app.add_flag("--keys", arguments.prints_keys, "Print all keys and mouse actions as a table and exit");
  app.add_option("--state", arguments.state_folder, "Folder for sessions [$XDG_STATE_HOME/trocar]");
  app.add_option("--db", arguments.database,
                 "Database of people and results: a file, or postgresql://USER:PASSWORD@HOST/NAME [$TROCAR_DB, else "
                 "results.sqlite in $XDG_DATA_HOME/trocar]");
  app.add_version_flag(fmt::format("trocar-trainer {} (Qt {})", kVersion, qVersion()),
                       "Display program version information and exit");
  app.footer(
      "Examples:\n  trocar-trainer --task liver-biopsy --patient abdomen\n"
      "  trocar-trainer --script steps.txt --screenshot window.png\n\n"
      "Steps of a script: click, drag, wheel, key, choose, set, wait-for, expect, screenshot … "
      "(docs/how_to/script_the_trainer.md)");
}

/// Applies the arguments before there is a window: an unknown name is an error.
Result<TrainerChoice> with_arguments(TrainerChoice choice, const Arguments& arguments) {
  if (arguments.task) {
    TROCAR_TRY(const tasks::Task task, tasks::load_task(data_dir() / "tasks", *arguments.task));
    choice.task = task.name;
  }
  if (arguments.breathing) {
    TROCAR_TRY_STATUS(motion::parse_breathing(*arguments.breathing));
    choice.breathing = *arguments.breathing;
  }
  if (arguments.patient_seed) choice.patient_seed = *arguments.patient_seed;
  if (!arguments.patient) return choice;
  std::error_code error;
  if (fs::is_directory(*arguments.patient, error)) {
    if (!fs::is_regular_file(fs::path(*arguments.patient) / "patient.toml", error))
      return fail_usage("not a patient folder: it has no patient.toml", *arguments.patient,
                        "name the folder that trocar patient build or generate wrote");
    choice.patient = fs::absolute(*arguments.patient).string();
  } else if (const auto embedded = phantom::find_embedded_patient(*arguments.patient)) {
    choice.patient = *arguments.patient;
    const bool is_served = std::ranges::find(embedded->tasks, choice.task) != embedded->tasks.end();
    if (!is_served && arguments.task)
      return fail_usage("the patient is not for this task", fmt::format("{}, {}", choice.patient, choice.task),
                        "leave out --task, or choose another patient (trocar patient list)");
    if (!is_served && !embedded->tasks.empty()) choice.task = embedded->tasks.front();  // not that of the last time
  } else {
    return fail_usage("no such patient", *arguments.patient,
                      "name a patient folder or an embedded patient (trocar patient list)");
  }
  return choice;
}

void save_window(MainWindow& window, const std::string& file) {
  const bool is_saved = window.grab().save(to_qt(file), "PNG");
  if (!is_saved) arguments::report_error(Error{"cannot write the image", file, "check the folder"});
  QCoreApplication::exit(is_saved ? 0 : 1);
}

/// Runs the script, then saves the screenshot, then exits.
Status play(const Arguments& arguments, MainWindow& window) {
  if (arguments.scripts.empty() && !arguments.is_benchmark) {
    constexpr int kSettled_ms = 700;
    if (!arguments.screenshot.empty())
      QTimer::singleShot(kSettled_ms, &window, [&] { save_window(window, arguments.screenshot); });
    return {};
  }
  std::vector<ScriptStep> steps;
  if (arguments.is_benchmark) {
    TROCAR_TRY(steps, benchmark_steps(arguments.layouts));
  }
  for (const std::string& script : arguments.scripts) {
    TROCAR_TRY(std::vector<ScriptStep> more, load_script(script));
    std::ranges::move(more, std::back_inserter(steps));
  }
  const Stage stage{&window, [&] { return window.facts(); },
                    [&](const QString& tool) { window.flow().end_server(tool); }, [&] { window.flow().reset_watch(); }};
  auto* player = new ScriptPlayer(std::move(steps), stage, &window);
  QObject::connect(player, &ScriptPlayer::finished, &window, [&](const QString& error) {
    if (!error.isEmpty()) {
      fmt::print(stderr, "error: {}\n", to_std(error));
      if (!arguments.screenshot.empty()) window.grab().save(to_qt(arguments.screenshot), "PNG");
      return QCoreApplication::exit(1);
    }
    arguments.screenshot.empty() ? QCoreApplication::exit(0) : save_window(window, arguments.screenshot);
  });
  player->start();
  return {};
}

Status speak_as_chosen(TrainerApplication& application, const Arguments& arguments) {
  if (!arguments.language.empty()) return speak(application, to_qt(arguments.language));
  const QString chosen = chosen_language();
  const Status status = speak(application, chosen.isEmpty() ? desktop_language() : chosen);
  // A language that was removed or is broken does not keep people from training.
  if (!status) fmt::print(stderr, "warning: the window stays English: {}\n", status.error().text());
  return {};
}

int run(int argc, char** argv) {
  arguments::Program app("trocar-trainer", "The Trocar trainer window: ultrasound, slices, 3D, forces and score.");
  Arguments arguments;
  add_options(app, arguments);
  if (const std::optional<int> end = app.parse(argc, argv)) return *end;
  if (arguments.prints_keys) {
    fmt::print("{}", to_std(actions_as_markdown()));
    return 0;
  }
  if (!scene::can_render())
    return arguments::report_error(Error{"the window needs an X server with rendering; none is available", "DISPLAY",
                                         "start it from a desktop, or under xvfb-run"});

#if QT_VERSION < QT_VERSION_CHECK(6, 0, 0)
  QCoreApplication::setAttribute(Qt::AA_UseHighDpiPixmaps);
#endif
  follow_screen(argc, argv);
  QCoreApplication::setOrganizationName(QStringLiteral("trocar"));
  QCoreApplication::setApplicationName(QStringLiteral("trocar-trainer"));
  TrainerApplication application(argc, argv);
  // A benchmark uses the built-in layouts and does not change the user's settings.
  const QTemporaryDir own_settings;
  if (arguments.is_benchmark) QSettings::setPath(QSettings::NativeFormat, QSettings::UserScope, own_settings.path());
  apply_theme(application, kept_text_percent());
  if (const Status status = speak_as_chosen(application, arguments); !status)
    return arguments::report_error(status.error());
  const Result<database::DatabaseUrl> results =
      arguments.database.empty() ? results::default_url() : database::parse_url(arguments.database);
  if (!results) return arguments::report_error(results.error());
  MainWindow window(arguments.state_folder.empty() ? user_state_folder() : fs::path(arguments.state_folder), *results);
  const Result<TrainerChoice> choice = with_arguments(window.start().choice(), arguments);
  if (!choice) return arguments::report_error(choice.error());
  window.flow().set_frame_rate(arguments.frame_rate_hz);
  window.start().choose(*choice);
  window.show();
  if (const Status status = play(arguments, window); !status) return arguments::report_error(status.error());
  return QApplication::exec();
}

}  // namespace

int main(int argc, char** argv) {
  return trocar::arguments::run_program([&] { return run(argc, argv); }, "trocar-trainer");
}
