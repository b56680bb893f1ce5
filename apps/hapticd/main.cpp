// trocar-hapticd: the haptic server, one process per device.
#include <fmt/format.h>
#include <signal.h>

#include <condition_variable>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <thread>

#include "cases/scene_request.h"
#include "command.h"
#include "core/files/folders.h"
#include "core/log.h"
#include "core/start_thread.h"
#include "core/version.h"
#include "devices/device_spec.h"
#include "io/patient/patient_folder.h"
#include "program_end.h"
#include "replayed_motion.h"
#include "server/haptic_server.h"
#include "test_mode.h"

namespace {

using namespace trocar;

struct Arguments {
  std::string device = "virtual", preset, tool = "needle", endpoint, replay_file;
  std::vector<std::string> faults;
  io::PatientSource patient;
  cases::CaseOptions the_case;
  std::string force_model;
  double rate_hz = 1000.0;
  int priority = 80;
  std::string key_file, allow_file, flight_folder = ".";
  bool is_verbose = false, is_test = false, is_calibrating = false;
};

/// Loads patients for the server; a patient that is already open is not loaded again.
class Patients {
 public:
  Result<std::shared_ptr<const anatomy::VirtualPatient>> open(const std::string& name, std::uint64_t seed,
                                                              const Progress& progress) {
    if (patient_ != nullptr && name == source_.folder_or_name && seed == source_.seed)
      return std::exchange(patient_, {});
    TROCAR_TRY(anatomy::VirtualPatient patient, io::load_source({name, seed}, progress));
    return std::make_shared<const anatomy::VirtualPatient>(std::move(patient));
  }
  void keep(const io::PatientSource& source, std::shared_ptr<const anatomy::VirtualPatient> patient) {
    source_ = source;
    patient_ = std::move(patient);
  }

 private:
  io::PatientSource source_;
  std::shared_ptr<const anatomy::VirtualPatient> patient_;
};

std::filesystem::path stylus_folder() {
  return user_config_folder() / "styluses";
}

Result<std::unique_ptr<devices::HapticDevice>> open_named_device(const Arguments& arguments) {
  TROCAR_TRY(const devices::DeviceSpec spec, devices::parse_device_spec(arguments.device));
  devices::DeviceOptions options;
  options.devices_file = data_dir() / "devices.toml";
  options.preset = arguments.preset;
  options.is_calibrating = arguments.is_calibrating;
  // A test weighs anew, also if the saved weight is broken.
  if (!arguments.is_test) options.stylus_folder = stylus_folder();
  for (const std::string& text : arguments.faults) {
    TROCAR_TRY(const devices::ScheduledFault fault, devices::parse_fault(text));
    options.faults.push_back(fault);
  }
  if (spec.kind == "replay") {
    TROCAR_TRY(options.motion, load_motion(spec.argument));
  }
  return devices::open_device(spec, options);
}

Result<std::optional<link::ServerSecurity>> load_security(const Arguments& arguments) {
  if (arguments.key_file.empty() && arguments.allow_file.empty()) return std::nullopt;
  if (arguments.key_file.empty() || arguments.allow_file.empty())
    return fail_usage("--keys and --allow must be given together", "--keys, --allow", "see trocar link keygen");
  link::ServerSecurity security;
  TROCAR_TRY(security.keys, link::load_curve_keys(arguments.key_file));
  TROCAR_TRY(security.allowed, link::load_allow_list(arguments.allow_file));
  return security;
}

/// Scene of the command line: the path is planned as in `trocar run`, so that the room is placed at the entry.
Result<link::LoadScene> first_scene(const Arguments& arguments, Patients& patients) {
  TROCAR_TRY(anatomy::VirtualPatient opened, io::load_source(arguments.patient));
  const auto patient = std::make_shared<const anatomy::VirtualPatient>(std::move(opened));
  TROCAR_TRY(const cases::Case the_case, cases::prepare_case(patient, arguments.the_case));
  patients.keep(arguments.patient, patient);
  cases::SceneChoice choice;
  choice.tool = arguments.tool;
  choice.force_model = arguments.force_model;
  choice.patient_source = arguments.patient.folder_or_name;
  choice.patient_seed = arguments.patient.seed;
  return cases::scene_request(the_case, choice);
}

/// Waits for the signals that end the server, on a separate thread. While no device is open, the program ends at once:
/// loading the first patient takes seconds.
class EndSignal {
 public:
  /// Errors: the thread does not start.
  static Result<EndSignal> watch() {
    EndSignal end;
    TROCAR_TRY(std::thread thread, start_thread("signal", [state = end.state_] {
                 sigset_t signals;
                 sigemptyset(&signals);
                 sigaddset(&signals, SIGINT);
                 sigaddset(&signals, SIGTERM);
                 int signal = 0;
                 sigwait(&signals, &signal);
                 const std::lock_guard lock(state->mutex);
                 if (!state->holds_device) {
                   fmt::print(stderr, "error: stopped before the server was ready\n");
                   std::fflush(nullptr);
                   std::_Exit(1);
                 }
                 state->has_come = true;
                 state->wake.notify_all();
               }));
    thread.detach();
    return end;
  }
  /// After this call, wait() ends the program.
  void hold_device() {
    const std::lock_guard lock(state_->mutex);
    state_->holds_device = true;
  }
  void wait() {
    std::unique_lock lock(state_->mutex);
    state_->wake.wait(lock, [&] { return state_->has_come; });
  }

 private:
  struct State {
    std::mutex mutex;
    std::condition_variable wake;
    bool holds_device = false;
    bool has_come = false;
  };
  std::shared_ptr<State> state_ = std::make_shared<State>();
};

void print_report(const server::ServerReport& report) {
  const realtime::LoopSummary& loop = report.loop;
  fmt::print("{} ticks at {:.1f} of {:.0f} Hz, {:.4f} % of periods served ({} missed, {} of them skipped)\n",
             report.ticks, loop.achieved_hz, loop.wanted_hz, 100.0 * loop.served(), loop.missed, loop.skipped);
  const auto line = [](const char* name, const realtime::LatencySummary& s) {
    fmt::print("{:<9} p50 {:.1f}  p99 {:.1f}  p99.9 {:.1f}  max {:.0f} us\n", name, s.p50_us, s.p99_us, s.p999_us,
               s.max_us);
  };
  line("lateness", loop.lateness);
  line("tick", loop.tick);
  fmt::print("{}\n", report.grant.text());
  if (report.ticks_dropped + report.refused.total() + report.batches_not_taken > 0)
    fmt::print("{} ticks dropped, {} messages refused, {} batches dropped for slow clients\n", report.ticks_dropped,
               report.refused.total(), report.batches_not_taken);
}

Status serve(Arguments& arguments) {
  TROCAR_TRY(const std::filesystem::path data, checked_data_dir());
  if (arguments.is_test) {
    TROCAR_TRY(const std::unique_ptr<devices::HapticDevice> device, open_named_device(arguments));
    // A device with injected faults has no weight of its own.
    return test_device(*device, arguments.rate_hz, arguments.priority,
                       arguments.faults.empty() ? stylus_folder() : std::filesystem::path());
  }
  server::ServerOptions options;
  TROCAR_TRY(options.endpoint, link::parse_endpoint(arguments.endpoint.empty() ? link::default_endpoint(arguments.tool)
                                                                               : arguments.endpoint));
  TROCAR_TRY(options.security, load_security(arguments));
  options.rate_hz = arguments.rate_hz;
  options.tool = arguments.tool;
  options.priority = arguments.priority;
  options.tissues_file = data / "tissues.toml";
  options.flight_folder = arguments.flight_folder;

  TROCAR_TRY(EndSignal end, EndSignal::watch());
  Patients patients;
  std::optional<link::LoadScene> scene;
  if (!arguments.patient.folder_or_name.empty()) {
    TROCAR_TRY(scene, first_scene(arguments, patients));
  }
  end.hold_device();
  TROCAR_TRY(std::unique_ptr<devices::HapticDevice> device, open_named_device(arguments));
  const std::string name = device->name();
  const auto opener = [&patients](const std::string& patient, std::uint64_t seed, const Progress& progress) {
    return patients.open(patient, seed, progress);
  };
  TROCAR_TRY(server::HapticServer server, server::HapticServer::start(options, std::move(device), opener));
  if (scene) server.load(*scene);
  fmt::print("{} for the {} at {}, {:.0f} Hz\n", name, arguments.tool, server.url(), arguments.rate_hz);
  std::fflush(stdout);
  end.wait();
  const server::ServerReport report = server.stop();
  print_report(report);
  if (report.is_loading) {
    std::fflush(nullptr);
    std::_Exit(0);
  }
  return {};
}

void add_options(arguments::Program& program, Arguments& a) {
  program
      .add_option("--device", a.device,
                  "Device: virtual[:PRESET], mouse, gamepad, spacemouse, replay:FILE, openhaptics[:NAME], "
                  "forcedimension or haply[:ws://HOST:PORT]")
      .show_default();
  program.add_option("--preset", a.preset, "Preset (row of data/devices.toml); default: that of the device");
  program.add_option("--tool", a.tool, "Tool of the device: needle, probe or finger").show_default();
  program.add_option("--patient", a.patient.folder_or_name,
                     "Patient to load at the start; without it, a client sends one");
  program.add_option("--patient-seed", a.patient.seed, "Seed of an embedded patient").seed().show_default();
  program.add_option("--task", a.the_case.task, "Task that defines the patient's position in the room").show_default();
  program.add_option("--needle", a.the_case.needle, "Needle of data/needles.toml; the task's own when left out");
  program.add_option("--force-model", a.force_model, "insertion, proxy or combined; the task's own when left out");
  program.add_option("--rate", a.rate_hz, "Rate of haptic ticks").number_within(250.0, 4000.0, "Hz").show_default();
  program.add_option("--endpoint", a.endpoint,
                     "ipc://PATH (for this user), or tcp://ADDRESS:PORT with --keys and --allow");
  program.add_option("--keys", a.key_file, "The server's key file (trocar link keygen)");
  program.add_option("--allow", a.allow_file, "Public keys of the clients that may connect");
  program.add_option("--priority", a.priority, "Priority under SCHED_FIFO; 0 selects ordinary scheduling")
      .whole_number_within(0, 99)
      .show_default();
  program.add_option("--flight-records", a.flight_folder, "Folder for the last 2 s before a fault").show_default();
  program
      .add_option("--fault", a.faults,
                  "Inject a device fault: KIND[:AMOUNT]@FROM_S[+FOR_S], as nan@2+0.5; kinds jitter, dropped, nan, "
                  "stuck, jump, disconnect, slow_write, slow_read")
      .one_value_each();
  program.add_flag("--test", a.is_test,
                   "Test mode without clients: print the device's pose 30 times a second; the line \"push\" on "
                   "standard input applies a small upward force, \"weigh\" weighs the stylus and saves its weight, "
                   "\"forget\" deletes the saved weight; end of input ends the test");
  program.add_flag("--calibrate", a.is_calibrating,
                   "OpenHaptics: calibrate first; hold the stylus in its inkwell, or the arm in its reset position");
  program.add_flag("-v,--verbose", a.is_verbose, "Print details to stderr");
  program.footer(
      "The server runs until it is interrupted. It keeps its device safe independent of its clients, and applies no "
      "force before a client requests it.\nExamples:\n  trocar-hapticd --device virtual --tool needle --patient "
      "abdomen\n"
      "  trocar-hapticd --device openhaptics --tool probe --endpoint ipc:///tmp/probe\n");
}

int run(int argc, char** argv) {
  arguments::Program program("trocar-hapticd",
                             "The haptic server of Trocar, one process per device. A trainer, not a medical device.");
  program.add_version_flag(std::string("trocar-hapticd ") + kVersion, "Print the version and exit");
  Arguments arguments;
  add_options(program, arguments);
  if (const std::optional<int> end = program.parse(argc, argv)) return *end;
  if (arguments.is_verbose) set_log_level(LogLevel::kInfo);
  const Status done = serve(arguments);
  return done ? 0 : arguments::report_error(done.error());
}

/// All threads inherit the blocked signals; a thread waits for them instead of a handler.
void block_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}

}  // namespace

int main(int argc, char** argv) {
  const auto program = [&] {
    block_signals();
    return run(argc, argv);
  };
  return trocar::arguments::run_program(program, "trocar-hapticd");
}
