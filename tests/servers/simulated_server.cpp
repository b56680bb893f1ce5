#include "servers/simulated_server.h"

#include <utility>
#include <variant>

#include "core/files/folders.h"
#include "devices/device_spec.h"
#include "haptics/option_texts.h"

namespace trocar::servers_test {
namespace {

constexpr std::int64_t kPeriod_ns = 1'000'000;
constexpr double kPeriod_s = 1e-9 * static_cast<double>(kPeriod_ns);
constexpr double kBatch_s = 0.005, kStatus_s = 0.05;  // as the server's link thread
constexpr double kNeverHeard_s = 1e6;

std::int64_t to_ns(double time_s) {
  return static_cast<std::int64_t>(1e9 * time_s);
}

std::unique_ptr<devices::HapticDevice> open(const std::string& spec) {
  devices::DeviceOptions options;
  options.devices_file = data_dir() / "devices.toml";
  const auto parsed = devices::parse_device_spec(spec);
  TROCAR_CHECK(parsed.has_value());
  auto device = devices::open_device(*parsed, options);
  TROCAR_CHECK(device.has_value());
  return *std::move(device);
}

}  // namespace

/// A device that can be unplugged.
class SimulatedServer::Device final : public devices::HapticDevice {
 public:
  Device(std::unique_ptr<devices::HapticDevice> device, const bool& is_plugged)
      : device_(std::move(device)), is_plugged_(is_plugged) {}
  const stylus::DevicePreset& preset() const noexcept override { return device_->preset(); }
  std::string name() const override { return device_->name(); }
  devices::DeviceReading read(double now_s) noexcept override {
    devices::DeviceReading reading = device_->read(now_s);
    is_open_ = is_open_ && is_plugged_;
    if (!is_open_) reading.status = devices::DeviceStatus::kDisconnected;
    return reading;
  }
  bool write(const Wrench& wrench_D) noexcept override { return is_open_ && device_->write(wrench_D); }
  void hold(const devices::DeviceHand& hand) noexcept override { device_->hold(hand); }
  bool is_in_real_hand() const noexcept override { return device_->is_in_real_hand(); }
  Status reconnect() override {
    if (!is_plugged_) return fail("no device is connected", name(), "plug one in");
    is_open_ = true;
    return {};
  }

 private:
  std::unique_ptr<devices::HapticDevice> device_;
  const bool& is_plugged_;
  bool is_open_ = true;
};

struct SimulatedServer::Process {
  Process(const std::string& device_spec, const bool& is_plugged, double ready, server::PatientOpener opener)
      : device(open(device_spec), is_plugged),
        builder(std::move(opener), data_dir() / "tissues.toml", device.preset()),
        servo(device, server::servo_params(device.preset())),
        ready_s(ready),
        period_s(ready) {}

  Device device;
  server::SceneBuilder builder;
  server::Servo servo;
  double ready_s;
  double period_s;  ///< When the last period began.
  server::ServoSwitches switches;
  server::CommandQueue commands;
  std::optional<link::HandTarget> hand;
  std::optional<server::ServoScene> scene;
  std::deque<Job> jobs;
  std::uint64_t in_control = 0;
  link::StateBatch batch;
  server::ServoRecord newest;
  realtime::LoopStatistics statistics{kPeriod_ns};
  double sent_s = 0.0, told_s = 0.0;
};

class SimulatedServer::Connection final : public attempt::ServerConnection {
 public:
  Connection(SimulatedServer& server, link::ClientOptions options)
      : server_(server), client_(server.link_, std::move(options)) {
    server_.clients_.push_back(&client_);
  }
  ~Connection() override { std::erase(server_.clients_, &client_); }
  link::ClientView view() const override { return client_.view(); }
  std::vector<link::NumberedSample> take_samples() override { return client_.take_samples(); }
  std::optional<telemetry::TickSample> newest() const override { return client_.newest(); }
  std::uint32_t send(decltype(link::Command::what) what) override { return client_.send(std::move(what)); }
  std::vector<link::Reply> take_replies() override { return client_.take_replies(); }
  Result<std::string> ask(decltype(link::Command::what) what, std::chrono::milliseconds timeout) override {
    const std::uint32_t request = client_.send(std::move(what));
    for (auto waited = std::chrono::milliseconds(0); waited < timeout; waited += std::chrono::milliseconds(1)) {
      server_.clock_.advance(std::chrono::milliseconds(1));
      for (const link::Reply& reply : client_.take_replies()) {
        if (reply.request != request) continue;
        if (reply.is_done) return reply.text;
        return fail(reply.text, server_.endpoint_);
      }
    }
    return fail("the server did not answer", server_.endpoint_);
  }
  void set_target(const link::HandTarget& target) override { client_.set_hand(target); }
  void frame_drawn() override { client_.frame_drawn(); }

 private:
  SimulatedServer& server_;
  testing::InProcessClient client_;
};

class SimulatedServer::Host final : public attempt::ServerHost {
 public:
  explicit Host(SimulatedServer& server) : server_(server) {}
  const std::string& tool() const noexcept override { return server_.options_.tool; }
  const std::string& device() const noexcept override { return server_.options_.device; }
  const std::string& endpoint() const noexcept override { return server_.endpoint_; }
  int pid() const override { return server_.pid_; }
  Status check() override {
    if (server_.process_) return {};
    return fail("the server of the " + tool() + " was killed by signal 9", "trocar-hapticd", "");
  }
  bool is_held_up() override { return server_.is_paused_; }
  Status restart() override { return server_.restart(); }
  Result<std::unique_ptr<attempt::ServerConnection>> connect(link::ClientOptions options) override {
    return std::make_unique<Connection>(server_, std::move(options));
  }

 private:
  SimulatedServer& server_;
};

SimulatedServer::SimulatedServer(testing::FakeClock& clock, std::shared_ptr<const anatomy::VirtualPatient> patient,
                                 Options options)
    : clock_(clock),
      patient_(std::move(patient)),
      options_(std::move(options)),
      endpoint_("simulated:" + options_.tool) {
  const Status started = restart();
  TROCAR_CHECK(started.has_value());
  pid_ = kFirstPid;
  participation_ = clock_.attach([this] { step(); });
}

SimulatedServer::~SimulatedServer() = default;

std::unique_ptr<attempt::ServerHost> SimulatedServer::host() {
  return std::make_unique<Host>(*this);
}

void SimulatedServer::kill() {
  process_.reset();
  link_.close();
}

Status SimulatedServer::restart() {
  kill();
  is_paused_ = is_hung_ = false;
  ++pid_;
  process_ =
      std::make_unique<Process>(options_.device, is_plugged_, now_s() + options_.start_s,
                                [patient = patient_](const std::string&, std::uint64_t, const Progress&)
                                    -> Result<std::shared_ptr<const anatomy::VirtualPatient>> { return patient; });
  return {};
}

double SimulatedServer::now_s() const {
  return std::chrono::duration<double>(clock_.now().time_since_epoch()).count();
}

void SimulatedServer::step() {
  const double now = now_s();
  if (!is_client_stalled_)
    for (testing::InProcessClient* client : clients_) client->step(now);
  if (!process_ || is_paused_ || is_hung_ || now < process_->ready_s) return;
  link_.open();
  receive(now);
  run_periods(now);
  run_jobs(now);
  if (now - process_->sent_s < kBatch_s) return;
  if (now - process_->told_s >= kStatus_s) {
    process_->batch.status = status(now);
    process_->told_s = now;
  }
  flush();
  process_->sent_s = now;
}

void SimulatedServer::receive(double now_s) {
  while (const auto received = link_.receive(welcome(), now_s)) {
    watch_control(now_s);
    if (const auto* command = std::get_if<link::Command>(&received->body)) take(*received, *command, now_s);
    if (const auto* target = std::get_if<link::HandTarget>(&received->body)) {
      const bool was_placed = process_->hand && process_->hand->is_placed;
      process_->hand = *target;
      process_->hand->is_placed |= was_placed;
    }
  }
  link_.drop_lost(now_s);
  watch_control(now_s);
}

void SimulatedServer::take(const link::Received& received, const link::Command& command, double now_s) {
  const auto* simple = std::get_if<link::ServerCommand>(&command.what);
  if (simple == nullptr || *simple == link::ServerCommand::kReconnect) {
    const bool is_scene = std::holds_alternative<link::LoadScene>(command.what);
    process_->jobs.push_back(
        {received.session, command.request, command.what, now_s + (is_scene ? options_.load_s : 0.0)});
    return;
  }
  if (*simple == link::ServerCommand::kStart && !process_->scene) {
    link_.send_reply(received.session, {command.request, false, "no scene loaded — load one first"});
    return;
  }
  const bool is_taken = process_->commands.push(*simple, to_ns(now_s));
  link_.send_reply(received.session,
                   {command.request, is_taken, is_taken ? "done" : "too many commands at once — send it again"});
}

void SimulatedServer::watch_control(double now_s) {
  if (link_.controller() == process_->in_control) return;
  process_->commands.stop(to_ns(now_s));
  process_->in_control = link_.controller();
}

void SimulatedServer::run_periods(double now_s) {
  const double dt_s = now_s - process_->period_s;
  if (dt_s < 0.5 * kPeriod_s) return;
  run_period(now_s, dt_s);
  process_->period_s = now_s;
}

void SimulatedServer::run_period(double now_s, double dt_s) {
  Process& process = *process_;
  process.switches.begin_period();
  process.commands.apply_stops(process.switches);
  process.commands.apply_commands(process.switches);
  process.commands.confirm(process.switches);
  server::ServoInput input;
  input.now_s = now_s;
  input.dt_s = dt_s;
  if (process.scene) input.scene = &*process.scene;
  input.hand = std::exchange(process.hand, std::nullopt);
  const std::optional<double> heard_s = link_.controller_heard_s();
  input.silence_s = heard_s ? now_s - *heard_s : kNeverHeard_s;
  input.is_wanted = process.switches.is_wanted;
  input.is_reset = process.switches.is_reset;
  input.is_stylet_in = process.switches.is_stylet_in;
  add(process.servo.step(input));
  const std::int64_t now_ns = to_ns(now_s);
  process.statistics.add(now_ns, now_ns, now_ns, 0);
}

void SimulatedServer::run_jobs(double now_s) {
  while (!process_->jobs.empty() && process_->jobs.front().due_s <= now_s) {
    const Job job = std::move(process_->jobs.front());
    process_->jobs.pop_front();
    link_.send_reply(job.session, perform(job));
  }
}

link::Reply SimulatedServer::perform(const Job& job) {
  Process& process = *process_;
  if (std::holds_alternative<link::ServerCommand>(job.what)) {
    const Status opened = process.device.reconnect();
    if (opened) process.servo.resume();
    return {job.request, opened.has_value(), opened ? "it is open again" : opened.error().text()};
  }
  const auto* load = std::get_if<link::LoadScene>(&job.what);
  const Result<server::ServoScene> made =
      load != nullptr ? process.builder.load(*load) : process.builder.change(std::get<link::SetParameters>(job.what));
  if (!made) return {job.request, false, made.error().text()};
  process.scene = *made;
  link::Reply reply{job.request, true, load != nullptr ? "the scene is loaded" : "the scene has changed parameters"};
  reply.scene = made->number;
  reply.options = haptics::option_texts(*made->scene);
  reply.tissues_toml = process.builder.tissues().to_toml();
  return reply;
}

void SimulatedServer::add(const server::ServoRecord& record) {
  link::StateBatch& batch = process_->batch;
  const bool is_next = record.tick == batch.first_tick + batch.samples.size() && record.scene == batch.scene;
  if (!batch.samples.empty() && !is_next) flush();
  if (batch.samples.empty()) batch.first_tick = record.tick;
  batch.scene = record.scene;
  batch.samples.push_back(record.sample);
  if (record.shape) batch.shape = record.shape;
  process_->newest = record;
}

void SimulatedServer::flush() {
  link::StateBatch& batch = process_->batch;
  if (batch.samples.empty() && !batch.status) return;
  link_.send_batch(batch);
  batch.samples.clear();
  batch.shape.reset();
  batch.status.reset();
}

link::ServerStatus SimulatedServer::status(double now_s) const {
  const Process& process = *process_;
  link::ServerStatus status;
  status.server_time_s = now_s;
  status.gate_mode = process.newest.sample.gate_mode;
  status.fault = process.newest.sample.gate_fault;
  status.grant = "simulated";
  const bool is_loading = !process.jobs.empty() && std::holds_alternative<link::LoadScene>(process.jobs.front().what);
  status.loading = is_loading ? 0.5 : 0.0;
  status.loop = process.statistics.summary();
  return status;
}

link::Welcome SimulatedServer::welcome() const {
  const stylus::DevicePreset& preset = process_->device.preset();
  link::Welcome welcome;
  welcome.server = "trocar-hapticd, simulated";
  welcome.tool = options_.tool;
  welcome.device.name = process_->device.name();
  welcome.device.title = preset.title;
  return welcome;
}

}  // namespace trocar::servers_test
