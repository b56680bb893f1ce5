// The server of `trocar serve` with 100,000 simulated attempts: every page once with empty caches, then 200 readers at
// the same time on kept connections, then exports beside one reader, in this process and on the same cores.

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "bench/benchmarks.h"
#include "bench/processor_time.h"
#include "bench/training/http_reader.h"
#include "bench/training/simulated_results.h"
#include "core/files/folders.h"
#include "results/accounts.h"
#include "signing/password.h"
#include "web/service.h"
#include "web/transport/http_server.h"

namespace trocar::bench {
namespace {

using Clock = std::chrono::steady_clock;
using Milliseconds = std::chrono::duration<double, std::milli>;

constexpr std::size_t kAttempts = 100'000;
constexpr int kReaders = 200;
constexpr const char* kPassword = "grinding copper lids";
constexpr std::chrono::milliseconds kThinking{1000};

struct Page {
  std::string name, target;
};

std::vector<Page> pages_of(const SimulatedResults& filled, std::size_t n) {
  const std::string& person = filled.people[n % filled.people.size()];
  const std::string& attempt = filled.attempts[n % filled.attempts.size()];
  const std::string& task = filled.tasks[n % filled.tasks.size()];
  return {{"overview", "/api/overview"},
          {"overview of a course", "/api/overview?course=Course%201"},
          {"person", "/api/people/" + person},
          {"attempts", "/api/people/" + person + "/attempts"},
          {"curve", "/api/people/" + person + "/curve?task=" + task},
          {"metrics", "/api/metrics?task=" + task},
          {"score", "/api/metrics/score?task=" + task},
          {"path length", "/api/metrics/path_length?task=" + task},
          {"attempt", "/api/attempts/" + attempt},
          {"trace", "/api/attempts/" + attempt + "/trace"},
          {"validity", "/api/validity?task=" + task},
          {"forms", "/api/forms"},
          {"page", "/"}};
}

/// The header line with the cookie of a login.
Result<std::string> log_in(int port) {
  HttpReader reader(port);
  const auto answer = reader.send("POST", "/api/login", "Content-Type: application/json\r\n",
                                  fmt::format(R"({{"name":"bench","password":"{}"}})", kPassword));
  constexpr std::string_view kCookie = "\r\nSet-Cookie: ";
  const std::size_t at = answer ? answer->header.find(kCookie) : std::string::npos;
  if (at == std::string::npos) return fail("the login failed", "trocar bench serve", "report this as a bug");
  const std::size_t begin = at + kCookie.size();
  return "Cookie: " + answer->header.substr(begin, answer->header.find(';', begin) - begin) + "\r\n";
}

Result<std::vector<CaseResult>> time_pages(int port, const std::string& cookie, const SimulatedResults& filled,
                                           std::size_t n) {
  HttpReader reader(port);
  std::vector<CaseResult> results;
  for (const Page& page : pages_of(filled, n)) {
    const auto start = Clock::now();
    const double processor_start_ms = processor_time_ms();
    const auto answer = reader.send("GET", page.target, cookie);
    const double time_ms = Milliseconds(Clock::now() - start).count();
    const double processor_ms = processor_time_ms() - processor_start_ms;
    if (!answer || answer->status != 200)
      return fail(fmt::format("no answer, status {}", answer ? answer->status : 0), page.target,
                  "report this as a bug");
    results.push_back({"serve/first/" + page.name,
                       "ms",
                       figure_of(time_ms),
                       {},
                       fmt::format("{} KiB, {:.1f} ms of a processor", answer->body.size() / 1024, processor_ms)});
  }
  return results;
}

struct Readings {
  std::vector<double> times_ms;
  std::size_t errors = 0, bytes = 0;
};

/// All readers for `seconds`; each waits `thinking` between two pages.
Readings read_all(int port, const std::string& cookie, const SimulatedResults& filled, double seconds,
                  std::chrono::milliseconds thinking) {
  std::vector<Readings> readings(kReaders);
  std::vector<std::thread> threads;
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  for (std::size_t n = 0; n < readings.size(); ++n)
    threads.emplace_back([&, n] {
      HttpReader reader(port);
      std::this_thread::sleep_for(thinking * n / kReaders);
      for (std::size_t round = n; Clock::now() < end; ++round) {
        const std::vector<Page> pages = pages_of(filled, round / 13);
        const auto start = Clock::now();
        const auto answer = reader.send("GET", pages[round % pages.size()].target, cookie);
        readings[n].times_ms.push_back(Milliseconds(Clock::now() - start).count());
        if (!answer || answer->status != 200) ++readings[n].errors;
        if (answer) readings[n].bytes += answer->body.size();
        std::this_thread::sleep_for(thinking);
      }
    });
  for (std::thread& thread : threads) thread.join();
  Readings all;
  for (const Readings& one : readings) {
    all.times_ms.insert(all.times_ms.end(), one.times_ms.begin(), one.times_ms.end());
    all.errors += one.errors;
    all.bytes += one.bytes;
  }
  return all;
}

constexpr int kExports = 8;

/// Lists of attempts on one connection, while so many others export all attempts. The addresses differ: each list is
/// made, none comes from a cache.
Result<std::vector<CaseResult>> time_exports(int port, const std::string& cookie, const SimulatedResults& filled) {
  std::atomic<int> running{kExports};
  std::atomic<std::size_t> bytes{0}, errors{0};
  std::vector<double> exports_s(kExports), pages_ms;
  std::vector<std::thread> threads;
  const auto start = Clock::now();
  for (std::size_t n = 0; n < exports_s.size(); ++n)
    threads.emplace_back([&, n] {
      HttpReader reader(port);
      const auto answer = reader.send("GET", "/api/export/attempts.csv", cookie);
      exports_s[n] = std::chrono::duration<double>(Clock::now() - start).count();
      if (!answer || answer->status != 200) ++errors;
      if (answer) bytes += answer->bytes;
      --running;
    });
  HttpReader reader(port);
  for (std::size_t n = 0; running > 0; ++n) {
    const auto asked = Clock::now();
    const std::string& person = filled.people[n % filled.people.size()];
    const auto answer =
        reader.send("GET", fmt::format("/api/people/{}/attempts?before={}", person, 10 * kAttempts + n), cookie);
    pages_ms.push_back(Milliseconds(Clock::now() - asked).count());
    if (!answer || answer->status != 200) ++errors;
  }
  for (std::thread& thread : threads) thread.join();
  if (errors > 0) return fail(fmt::format("{} requests failed", errors.load()), "exports", "report this as a bug");
  CaseResult pages{fmt::format("serve/a page beside {} exports", kExports), "ms", figures_of(pages_ms), {}, {}};
  CaseResult all{fmt::format("serve/{} exports at once", kExports), "s", figures_of(exports_s), {}, {}};
  all.note = fmt::format("{} MiB each", bytes / kExports / (1024 * 1024));
  return std::vector{pages, all};
}

CaseResult reading_case(const std::string& name, const Readings& readings, double seconds) {
  const double count = static_cast<double>(readings.times_ms.size());
  CaseResult result{name, "ms", figures_of(readings.times_ms), {}, {}};
  result.note = fmt::format("{:.0f} answers/s, {:.1f} MiB/s, {} errors", count / seconds,
                            static_cast<double>(readings.bytes) / seconds / (1024.0 * 1024.0), readings.errors);
  return result;
}

}  // namespace

Result<std::vector<CaseResult>> run_serve_benchmark(const Options& options) {
  const TemporaryFolder folder;
  const database::DatabaseUrl url{(options.out.empty() ? folder.path() : options.out) / "results.sqlite", {}};
  const auto fill_start = Clock::now();
  TROCAR_TRY(const SimulatedResults filled, fill_with_simulated_results(url, kAttempts));
  const double fill_s = std::chrono::duration<double>(Clock::now() - fill_start).count();
  {
    TROCAR_TRY(results::Repository repository, results::Repository::open(url));
    TROCAR_TRY(const std::string hash, signing::hash_password(kPassword));
    TROCAR_TRY_STATUS(results::add_account(repository, "bench", results::Role::kAdmin, hash, {}));
  }
  web::ServiceOptions service_options;
  service_options.database = url;
  TROCAR_TRY(service_options.data_folder, checked_data_dir());
  service_options.page_folder = service_options.data_folder / "web";
  TROCAR_TRY(web::Service service, web::Service::open(std::move(service_options)));
  web::ServerOptions server_options;
  server_options.listen.port = 0;
  TROCAR_TRY(web::HttpServer server,
             web::HttpServer::start(server_options, [&](const web::HttpRequest& r) { return service.answer(r); }));
  TROCAR_TRY(const std::string cookie, log_in(server.port()));

  TROCAR_TRY(std::vector<CaseResult> results, time_pages(server.port(), cookie, filled, 0));
  results.push_back({"serve/fill", "s", figure_of(fill_s), {}, fmt::format("{} attempts into SQLite", kAttempts)});
  // A running server: the statistics of every task were shown before.
  for (std::size_t n = 1; n < filled.tasks.size(); ++n) TROCAR_TRY_STATUS(time_pages(server.port(), cookie, filled, n));
  const Readings calm = read_all(server.port(), cookie, filled, options.seconds, kThinking);
  results.push_back(reading_case(fmt::format("serve/{} readers, a page a second", kReaders), calm, options.seconds));
  const Readings busy = read_all(server.port(), cookie, filled, options.seconds, {});
  results.push_back(reading_case(fmt::format("serve/{} readers without a pause", kReaders), busy, options.seconds));
  TROCAR_TRY(const std::vector<CaseResult> exports, time_exports(server.port(), cookie, filled));
  results.insert(results.end(), exports.begin(), exports.end());
  if (calm.errors + busy.errors > 0)
    return fail(fmt::format("{} requests failed", calm.errors + busy.errors), "trocar bench serve",
                "report this as a bug");
  return results;
}

}  // namespace trocar::bench
