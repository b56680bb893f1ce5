#include "service_lab.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core/testing/source_dir.h"
#include "results/accounts.h"
#include "results/attempts.h"
#include "signing/password.h"

namespace trocar::web::testing {
namespace {

const Moment kOpened{std::chrono::steady_clock::time_point{std::chrono::hours(1000)},
                     std::chrono::sys_seconds{std::chrono::seconds(1'790'000'000)}};

const std::string& hash_of_password() {
  static const std::string hash = signing::hash_password(kPassword, kQuickWork).value();
  return hash;
}

}  // namespace

ServiceLab::ServiceLab(bool is_secure, bool is_behind_proxy)
    : now(kOpened), is_secure_(is_secure), is_behind_proxy_(is_behind_proxy) {
  std::filesystem::create_directories(folder_ / "web/assets");
  std::ofstream(folder_ / "web/index.html") << "<!doctype html>";
  std::ofstream(folder_ / "web/assets/index-1.js") << "code";
  auto opened = results::Repository::open({folder_ / "results.sqlite", {}});
  EXPECT_TRUE(opened) << opened.error().text();
  repository_.emplace(*std::move(opened));
  EXPECT_TRUE(results::add_account(*repository_, kAdmin, results::Role::kAdmin, hash_of_password(), kOpened.utc));
  EXPECT_TRUE(
      results::add_account(*repository_, kInstructor, results::Role::kInstructor, hash_of_password(), kOpened.utc));
  open_service();
}

void ServiceLab::restart() {
  service_.reset();
  open_service();
}

void ServiceLab::open_service() {
  ServiceOptions options;
  options.database = {folder_ / "results.sqlite", {}};
  options.data_folder = trocar::testing::source_dir() / "data";
  options.page_folder = folder_ / "web";
  options.is_secure = is_secure_;
  options.is_behind_proxy = is_behind_proxy_;
  options.password_work = kQuickWork;
  options.now = [this] { return now; };
  auto service = Service::open(std::move(options));
  EXPECT_TRUE(service) << service.error().text();
  service_.emplace(*std::move(service));
}

HttpRequest ServiceLab::request(const std::string& method, const std::string& target, const Json& body) const {
  HttpRequest request;
  request.method = method;
  const std::size_t question = target.find('?');
  request.path = target.substr(0, question);
  std::string rest = question == std::string::npos ? std::string() : target.substr(question + 1);
  while (!rest.empty()) {
    const std::string pair = rest.substr(0, rest.find('&'));
    rest = pair.size() == rest.size() ? std::string() : rest.substr(pair.size() + 1);
    const std::size_t equals = pair.find('=');
    request.query.emplace_back(pair.substr(0, equals), pair.substr(equals + 1));
  }
  request.address = address;
  request.headers = {{"Host", "localhost:8080"}};
  if (!cookie.empty()) request.headers.emplace_back("Cookie", cookie);
  if (method != "GET" && method != "HEAD") {
    request.headers.emplace_back("Content-Type", "application/json");
    request.headers.emplace_back("Origin", "http://localhost:8080");
    request.headers.emplace_back("Sec-Fetch-Site", "same-origin");
    if (!csrf.empty()) request.headers.emplace_back("X-CSRF-Token", csrf);
  }
  if (!body.is_null()) request.body = config::json_text(body, -1);
  return request;
}

HttpAnswer ServiceLab::log_in(const std::string& name, const std::string& password) {
  const HttpAnswer answer = post("/api/login", {{"name", name}, {"password", password}});
  const std::string set = header_of(answer, "Set-Cookie");
  if (answer.status != 200) return answer;
  cookie = set.substr(0, set.find(';'));
  csrf = json_of(answer).at("csrf").get<std::string>();
  return answer;
}

results::Person ServiceLab::add_person(const std::string& name, results::Group group) {
  const auto person = results::add_person(*repository_, {name, group}, now.utc);
  EXPECT_TRUE(person) << person.error().text();
  return person.value_or(results::Person{});
}

std::string ServiceLab::add_attempt(const results::Person& person, std::optional<double> score) {
  results::AttemptRecord record;
  record.attempt.id = results::make_id();
  record.attempt.person_id = person.id;
  record.attempt.the_case = {"liver-biopsy", "biopsy-1", 1, "hash", 1};
  record.attempt.started = now.utc;
  record.attempt.state = results::State::kFinished;
  record.attempt.score = score;
  record.attempt.is_passed = score.value_or(0.0) >= 75.0;
  record.attempt.duration_s = 60.0;
  if (score) {
    record.measures = {{"path_length", "mm", 200.0 - *score}};
    record.parts = {{"target", 0.6 * *score, 60.0}, {"time", 0.4 * *score, 40.0}};
    record.hints = {{"hold the needle steady", 12.5}};
  }
  record.trace.time_s = {0.0, 0.04, 0.08};
  record.trace.tip_mm = {{{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}, {7.0, 8.0, 9.0}}};
  record.trace.depth_mm = {0.0, 1.0, 2.0};
  record.trace.force_n = {0.0, -0.5, -1.0};
  record.trace.tissue = {0, 0, 1};
  record.trace.tissues = {"skin", "liver"};
  const auto recorded = results::record_attempt(*repository_, record, "the session file");
  EXPECT_TRUE(recorded) << recorded.error().text();
  return record.attempt.id;
}

void ServiceLab::pass(std::chrono::seconds time) {
  now.steady += time;
  now.utc += time;
}

Json json_of(const HttpAnswer& answer) {
  return config::parse_json(body_of(answer), "answer").value_or(Json());
}

std::string header_of(const HttpAnswer& answer, const std::string& name) {
  for (const auto& [key, value] : answer.headers)
    if (key == name) return value;
  return {};
}

std::string body_of(const HttpAnswer& answer) {
  if (!answer.source) return answer.body ? *answer.body : std::string();
  std::string all;
  while (true) {
    const Result<std::string> piece = answer.source();
    EXPECT_TRUE(piece) << piece.error().text();
    if (!piece || piece->empty()) return all;
    all += *piece;
  }
}

}  // namespace trocar::web::testing
