#include "bench/harness.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <thread>

#include "config/json.h"
#include "core/version.h"
#include "phantom/phantom.h"

namespace trocar::bench {
namespace {

std::string cpu_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (!line.starts_with("model name")) continue;
    const auto start = line.find_first_not_of(" \t", line.find(':') + 1);
    return start == std::string::npos ? std::string{} : line.substr(start);
  }
  return {};
}

config::Json number_or_null(const std::optional<double>& value) {
  return value ? config::Json(*value) : config::Json(nullptr);
}

config::Json to_json(const CaseResult& result) {
  config::Json json;
  json["case"] = result.name;
  json["unit"] = result.unit;
  json["median"] = number_or_null(result.figures.median);
  json["p99"] = number_or_null(result.figures.p99);
  json["p999"] = number_or_null(result.figures.p999);
  json["max"] = number_or_null(result.figures.max);
  json["peer"] = nullptr;
  if (result.peer)
    json["peer"] = {{"name", result.peer->name}, {"median", result.peer->median}, {"ratio", result.peer->ratio}};
  json["note"] = result.note;
  json["values"] = config::Json::object();
  for (const auto& [name, value] : result.values) json["values"][name] = value;
  return json;
}

}  // namespace

Figures time_ms(int warm_up, int rounds, const std::function<void()>& work) {
  for (int n = 0; n < warm_up; ++n) work();
  std::vector<double> times_ms;
  times_ms.reserve(static_cast<std::size_t>(std::max(rounds, 0)));
  for (int n = 0; n < rounds; ++n) {
    const auto start = std::chrono::steady_clock::now();
    work();
    times_ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  }
  return figures_of(std::move(times_ms));
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Result<std::shared_ptr<const anatomy::VirtualPatient>> patient_of(const Options& options) {
  if (options.patient) return options.patient;
  TROCAR_TRY(anatomy::VirtualPatient generated, phantom::generate_phantom("abdomen", 1, {}, options.progress));
  return std::make_shared<const anatomy::VirtualPatient>(std::move(generated));
}

config::Json machine_json() {
#ifdef NDEBUG
  constexpr const char* kBuild = "release";
#else
  constexpr const char* kBuild = "debug";
#endif
  config::Json json;
  json["cpu"] = cpu_name();
  json["cores"] = std::thread::hardware_concurrency();
#ifdef __clang__
  json["compiler"] = fmt::format("clang {}", __clang_version__);
#else
  json["compiler"] = fmt::format("gcc {}", __VERSION__);
#endif
  json["build"] = kBuild;
  json["version"] = kVersion;
  return json;
}

config::Json to_json(std::string_view bench, const std::vector<CaseResult>& results) {
  config::Json json;
  json["bench"] = bench;
  json["machine"] = machine_json();
  json["results"] = config::Json::array();
  for (const CaseResult& result : results) json["results"].push_back(to_json(result));
  return json;
}

}  // namespace trocar::bench
