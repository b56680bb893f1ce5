// The interface over a database: shapes of answers, bad input, deletion, questionnaires.
#include <gtest/gtest.h>

#include "results/questionnaires.h"
#include "service_lab.h"

namespace trocar::web {
namespace {

using namespace std::chrono_literals;
using namespace testing;

const std::string kHostile = "<script>alert(1)</script>'; DROP TABLE people; --";

class Interface : public ::testing::Test {
 protected:
  void SetUp() override { lab_.log_in(); }
  Json get(const std::string& target, int status = 200) {
    const HttpAnswer answer = lab_.get(target);
    EXPECT_EQ(answer.status, status) << target << " " << body_of(answer);
    return json_of(answer);
  }
  ServiceLab lab_;
};

TEST_F(Interface, OverviewSumsUpEveryPerson) {
  const auto person = lab_.add_person(kHostile), idle = lab_.add_person("Idle");
  for (const double score : {50.0, 60.0, 90.0}) lab_.add_attempt(person, score);
  lab_.add_attempt(person, std::nullopt);
  const Json overview = get("/api/overview");
  EXPECT_EQ(overview["tasks"], Json::array({{{"id", "liver-biopsy"}, {"title", "Liver biopsy"}}})) << overview["tasks"];
  ASSERT_EQ(overview["people"].size(), 2U);
  const Json& first = overview["people"][0];
  EXPECT_EQ(first["name"], kHostile);
  EXPECT_EQ(first["course"], nullptr);
  EXPECT_EQ(first["simulated"], false);
  const Json& task = first["tasks"]["liver-biopsy"];
  EXPECT_EQ(task["attempts"], 4);
  EXPECT_EQ(task["scored"], 3);
  EXPECT_EQ(task["passed"], 1);
  EXPECT_EQ(task["last_score"], 90.0);
  EXPECT_EQ(task["best_score"], 90.0);
  EXPECT_NEAR(task["recent_mean"].get<double>(), 200.0 / 3, 1e-9);
  EXPECT_TRUE(overview["people"][1]["tasks"].empty());
  EXPECT_EQ(first["has_pin"], false);
  EXPECT_EQ(get("/api/people/" + person.id)["person"], first);
  EXPECT_EQ(get("/api/people/" + person.id)["courses"], overview["courses"]);
  EXPECT_EQ(get("/api/overview?course=nobody's")["people"].size(), 0U);
}

TEST_F(Interface, ListsAttemptsInPages) {
  const auto person = lab_.add_person("Anna");
  std::vector<std::string> ids;
  for (int n = 0; n < 5; ++n) ids.push_back(lab_.add_attempt(person, 10.0 * n));
  const std::string base = "/api/people/" + person.id + "/attempts?limit=2";
  Json page = get(base);
  EXPECT_EQ(page["attempts"][0]["id"], ids[4]);
  EXPECT_EQ(page["attempts"][1]["id"], ids[3]);
  std::size_t seen = 2;
  while (!page["next"].is_null()) {
    page = get(base + "&before=" + std::to_string(page["next"].get<int>()));
    seen += page["attempts"].size();
  }
  EXPECT_EQ(seen, 5U);
  EXPECT_EQ(get(base + "&task=lumbar-puncture")["attempts"].size(), 0U);
  for (const char* bad : {"&before=x", "&before=-1", "&limit=", "&limit=0", "&task=a b", "&before=1e9"})
    get("/api/people/" + person.id + "/attempts?a=b" + bad, bad == std::string("&limit=") ? 200 : 400);
}

TEST_F(Interface, CurveFollowsTheOrderOfRecording) {
  const auto person = lab_.add_person("Anna");
  lab_.add_attempt(person, 40.0);
  lab_.now.utc -= 24h;  // the clock of the station is set back
  lab_.add_attempt(person, 80.0);
  lab_.now.utc += 24h;
  lab_.add_attempt(lab_.add_person("Expert", results::Group::kExpert), 95.0);
  const Json curve = get("/api/people/" + person.id + "/curve?task=liver-biopsy");
  ASSERT_EQ(curve["points"].size(), 2U);
  EXPECT_EQ(curve["points"][1]["n"], 2);
  EXPECT_EQ(curve["points"][1]["score"], 80.0);
  EXPECT_EQ(curve["points"][1]["moving_mean"], 60.0);
  EXPECT_EQ(curve["cusum"]["values"].size(), 2U);
  EXPECT_EQ(curve["experts"]["mean"], 95.0);
  get("/api/people/" + person.id + "/curve", 400);
}

TEST_F(Interface, AttemptShowsItsValuesBesideExpertValues) {
  const auto person = lab_.add_person("Anna"), expert = lab_.add_person("Expert", results::Group::kExpert);
  const std::string id = lab_.add_attempt(person, 50.0);
  lab_.add_attempt(expert, 90.0);
  const Json attempt = get("/api/attempts/" + id);
  EXPECT_EQ(attempt["attempt"]["person"]["name"], "Anna");
  EXPECT_EQ(attempt["attempt"]["hints"][0]["at_s"], 12.5);
  EXPECT_EQ(attempt["parts"][0]["max_points"], 60.0);
  ASSERT_EQ(attempt["metrics"].size(), 1U);
  EXPECT_EQ(attempt["metrics"][0]["value"], 150.0);
  EXPECT_EQ(attempt["metrics"][0]["expert_median"], 110.0);
  EXPECT_EQ(attempt["metrics"][0]["better"], "lower");
  const Json trace = get("/api/attempts/" + id + "/trace");
  EXPECT_EQ(trace["tip_x_mm"], (Json{1.0, 2.0, 3.0}));
  EXPECT_EQ(trace["force_n"][2], -1.0);
  EXPECT_EQ(trace["expert"]["time_s"].size(), 3U);
  EXPECT_FALSE(trace["expert"].contains("expert"));
}

TEST_F(Interface, ComparesAnAttemptWithEachOtherExpertOnce) {
  const auto person = lab_.add_person("Anna"), first = lab_.add_person("Expert 1", results::Group::kExpert),
             second = lab_.add_person("Expert 2", results::Group::kExpert);
  const std::string of_person = lab_.add_attempt(person, 50.0), of_first = lab_.add_attempt(first, 90.0);
  for (int n = 0; n < 9; ++n) lab_.add_attempt(second, 70.0);
  const auto median = [this](const std::string& id) {
    return get("/api/attempts/" + id)["metrics"][0]["expert_median"];
  };
  EXPECT_EQ(median(of_person), 120.0) << "of 110 and 130";
  EXPECT_EQ(median(of_first), 130.0) << "without oneself";
}

TEST_F(Interface, AttemptsWithoutAResultAreNotPassed) {
  const auto person = lab_.add_person("Anna");
  for (int n = 0; n < 2; ++n) lab_.add_attempt(person, 90.0);
  for (int n = 0; n < 4; ++n) lab_.add_attempt(person, std::nullopt);
  const Json task = get("/api/overview")["people"][0]["tasks"]["liver-biopsy"];
  EXPECT_EQ(task["attempts"], 6);
  EXPECT_EQ(task["passed"], 2);
  EXPECT_EQ(task["unscored"], 4);
  EXPECT_EQ(task["counts_text"], "6 attempts counted (4 ended without a result)");
  const Json curve = get("/api/people/" + person.id + "/curve?task=liver-biopsy");
  ASSERT_EQ(curve["points"].size(), 6U);
  EXPECT_EQ(curve["points"][5]["passed"], false);
  EXPECT_GT(curve["cusum"]["values"][5].get<double>(), 2.0);
  EXPECT_EQ(get("/api/people/" + person.id + "/attempts")["attempts"][0]["passed"], false);
}

TEST_F(Interface, ProficiencyCountsPeopleBelowTheCriterion) {
  const auto anna = lab_.add_person("Anna"), ben = lab_.add_person("Ben");
  for (const double score : {50.0, 85.0, 90.0, 95.0}) lab_.add_attempt(anna, score);
  for (int n = 0; n < 5; ++n) lab_.add_attempt(ben, std::nullopt);
  const Json json = get("/api/proficiency?task=liver-biopsy");
  EXPECT_EQ(json["passes_in_a_row"], 3);
  EXPECT_EQ(json["patients"], Json::array({"biopsy-1"}));
  ASSERT_EQ(json["groups"].size(), 1U);
  const Json& group = json["groups"][0];
  EXPECT_EQ(group["median"], 4.0);
  EXPECT_EQ(group["not_yet"], 1);
  EXPECT_EQ(group["people"][0]["trials"], 4.0);
  EXPECT_EQ(group["people"][1]["trials"], nullptr);
  EXPECT_EQ(group["people"][1]["attempts"], 5);
  EXPECT_NE(group["instructor"].get<std::string>().find("none entered"), std::string::npos);
  EXPECT_TRUE(get("/api/proficiency?task=liver-biopsy&patient=biopsy-9")["groups"].empty());
  get("/api/proficiency?task=liver-biopsy&level=hard", 400);
  get("/api/proficiency", 400);
}

TEST_F(Interface, FiltersValidityByCaseAndLevel) {
  lab_.add_attempt(lab_.add_person("Anna"), 50.0);
  EXPECT_EQ(get("/api/validity?task=liver-biopsy&patient=biopsy-1")["novices"], 1);
  EXPECT_EQ(get("/api/validity?task=liver-biopsy&patient=biopsy-2")["novices"], 0);
  EXPECT_EQ(get("/api/validity?task=liver-biopsy&level=exam")["novices"], 0);
  EXPECT_EQ(get("/api/validity?task=liver-biopsy")["patients"], Json::array({"biopsy-1"}));
  get("/api/validity?task=liver-biopsy&level=0.05", 400);
}

TEST_F(Interface, ServesARecordingAsAFile) {
  const std::string id = lab_.add_attempt(lab_.add_person("Anna"), 50.0);
  const HttpAnswer answer = lab_.get("/api/attempts/" + id + "/recording");
  EXPECT_EQ(body_of(answer), "the session file");
  EXPECT_EQ(answer.content_type, "application/octet-stream");
  EXPECT_EQ(header_of(answer, "Content-Disposition"), "attachment; filename=\"" + id + ".session\"");
}

TEST_F(Interface, DistributionsCountEveryPersonOnce) {
  const auto trainee = lab_.add_person("Anna"), expert = lab_.add_person("Expert", results::Group::kExpert);
  for (int n = 0; n <= 10; ++n) lab_.add_attempt(trainee, 5.0 * n);
  lab_.add_attempt(trainee, std::nullopt);
  lab_.add_attempt(lab_.add_person("Ben"), 45.0);
  lab_.add_attempt(expert, 100.0);
  const Json metrics = get("/api/metrics?task=liver-biopsy")["metrics"];
  EXPECT_EQ(metrics[0]["name"], "score");
  EXPECT_EQ(metrics[1]["title"], "Path length of the tip");
  for (const char* name : {"score", "path_length"}) {
    const Json json = get("/api/metrics/" + std::string(name) + "?task=liver-biopsy");
    EXPECT_EQ(json["edges"].size(), 21U);
    std::int64_t counted = 0;
    for (const Json& group : json["groups"]) {
      EXPECT_EQ(group["counts"].size(), 20U);
      for (const Json& count : group["counts"]) counted += count.get<std::int64_t>();
    }
    EXPECT_EQ(counted, 3);
    EXPECT_EQ(json["auc"]["value"], 1.0);
  }
  const Json score = get("/api/metrics/score?task=liver-biopsy");
  EXPECT_EQ(score["groups"][0]["group"], "trainee");
  EXPECT_EQ(score["groups"][0]["n"], 2);
  EXPECT_EQ(score["groups"][0]["attempts"], 12);
  EXPECT_EQ(score["groups"][0]["median"], 35.0) << "of 25 and 45";
  get("/api/metrics/unknown?task=liver-biopsy", 404);
}

TEST_F(Interface, ExcludesSimulatedPeopleFromMetricValidity) {
  lab_.add_attempt(lab_.add_person("Expert", results::Group::kExpert), 90.0);
  lab_.add_attempt(lab_.add_person("Novice"), 50.0);
  const auto robot =
      results::add_person(lab_.repository(), {"Robot", results::Group::kTrainee, {}, true}, lab_.now.utc);
  lab_.add_attempt(*robot, 100.0);
  const Json score = get("/api/metrics/score?task=liver-biopsy");
  EXPECT_EQ(score["auc"]["value"], 1.0);
  EXPECT_EQ(score["groups"].size(), 3U) << "but they are shown";
}

TEST_F(Interface, GivesAReasonForTooFewData) {
  lab_.add_attempt(lab_.add_person("Anna"), 50.0);
  const Json distribution = get("/api/metrics/score?task=liver-biopsy");
  EXPECT_EQ(distribution["auc"], nullptr);
  EXPECT_TRUE(distribution["reason"].is_string());
  const Json validity = get("/api/validity?task=liver-biopsy");
  EXPECT_EQ(validity["experts"], 0);
  EXPECT_EQ(validity["novices"], 1);
  for (const char* part : {"alpha", "pass_mark", "discriminating"})
    EXPECT_TRUE(validity[part]["reason"].is_string()) << part;
  EXPECT_TRUE(validity["metrics"][0]["reason"].is_string());
}

TEST_F(Interface, ComputesValidityOfTwoGroups) {
  for (int n = 0; n < 6; ++n)
    lab_.add_attempt(lab_.add_person("Expert " + std::to_string(n), results::Group::kExpert), 80.0 + n);
  for (int n = 0; n < 6; ++n) lab_.add_attempt(lab_.add_person("Novice " + std::to_string(n)), 30.0 + n);
  const Json validity = get("/api/validity?task=liver-biopsy");
  EXPECT_EQ(validity["experts"], 6);
  EXPECT_EQ(validity["metrics"][0]["auc"], 1.0);
  EXPECT_EQ(validity["metrics"][0]["discriminates"], true);
  EXPECT_EQ(validity["metrics"][0]["better"], "lower");
  EXPECT_EQ(validity["discriminating"]["share"], 1.0);
  EXPECT_EQ(validity["discriminating"]["uncorrected"], 1);
  EXPECT_GT(validity["pass_mark"]["value"], 35.0);
  EXPECT_LT(validity["pass_mark"]["value"], 80.0);
}

TEST_F(Interface, ExportIsSafeForSpreadsheets) {
  lab_.add_attempt(lab_.add_person("=HYPERLINK(\"http://evil.example\")"), 50.0);
  const HttpAnswer csv = lab_.get("/api/export/attempts.csv");
  EXPECT_EQ(csv.content_type, "text/csv; charset=utf-8");
  const std::string text = body_of(csv);
  EXPECT_EQ(text.find("\n=HYPERLINK"), std::string::npos);
  EXPECT_EQ(text.find(",=HYPERLINK"), std::string::npos);
  EXPECT_NE(text.find("\"'=HYPERLINK"), std::string::npos) << text;
}

TEST_F(Interface, UnknownIdsAreNotFound) {
  for (const std::string& id : {std::string(32, '0'), std::string("x"), std::string("../../etc/passwd"), kHostile,
                                std::string("' OR 1=1"), std::string(32, 'G'), std::string(1000, '0')}) {
    for (const char* pattern : {"/api/people/*", "/api/people/*/attempts", "/api/people/*/curve?task=a",
                                "/api/attempts/*", "/api/attempts/*/trace", "/api/attempts/*/recording",
                                "/api/forms/*/summary", "/api/forms/*/answers.csv", "/api/public/forms/*"}) {
      std::string target = pattern;
      target.replace(target.find('*'), 1, id);
      EXPECT_EQ(lab_.get(target).status, 404) << target;
    }
  }
}

TEST_F(Interface, RefusesUnknownMethodsAndPaths) {
  const HttpAnswer method = lab_.send(lab_.request("DELETE", "/api/overview"));
  EXPECT_EQ(method.status, 405);
  EXPECT_EQ(header_of(method, "Allow"), "GET");
  EXPECT_EQ(lab_.post("/", {}).status, 405);
  for (const char* target :
       {"/api", "/api/", "/api/nothing", "/api/overview/", "/api//overview", "/API/overview/x.js", "/api/people/"})
    EXPECT_EQ(lab_.get(target).status, 404) << target;
  EXPECT_EQ(lab_.send(lab_.request("HEAD", "/api/overview")).status, 200);
  HttpRequest bad = lab_.request("GET", "/api/overview");
  bad.path = "/api/people/\xff";
  EXPECT_EQ(lab_.send(bad).status, 400);
  bad = lab_.request("GET", "/api/overview?course=\xff");
  EXPECT_EQ(lab_.send(bad).status, 400);
}

TEST_F(Interface, ErrorsHideInternals) {
  for (const HttpAnswer& answer : {lab_.get("/api/people/x"), lab_.get("/api/validity"),
                                   lab_.get("/api/metrics/x?task=y"), lab_.post("/api/forms", {{"items", 1}}),
                                   lab_.get("/api/export/attempts.csv?course=" + std::string(200, 'x'))}) {
    EXPECT_GE(answer.status, 400);
    for (const char* inside : {"SELECT", "sqlite", "/tmp", "soci", ".cpp", "people p"})
      EXPECT_EQ(body_of(answer).find(inside), std::string::npos) << body_of(answer);
    EXPECT_TRUE(json_of(answer)["advice"].is_string());
  }
}

TEST_F(Interface, DeletingAPersonRequiresTheNameAndTakesEffectAtOnce) {
  const auto person = lab_.add_person("Anna");
  const std::string id = lab_.add_attempt(person, 50.0), target = "/api/people/" + person.id;
  get("/api/overview");
  get("/api/attempts/" + id);
  for (const Json& body : {Json::object(), Json{{"confirm", "anna"}}, Json{{"confirm", ""}}, Json{{"confirm", true}}})
    EXPECT_EQ(lab_.send(lab_.request("DELETE", target, body)).status, 400) << body;
  EXPECT_EQ(lab_.send(lab_.request("DELETE", target, {{"confirm", "Anna"}})).status, 204);
  EXPECT_EQ(get("/api/overview")["people"].size(), 0U);
  get("/api/attempts/" + id, 404);
  get("/api/attempts/" + id + "/recording", 404);
  get(target, 404);
}

TEST_F(Interface, HostHeaderOfAnotherNameIsRefused) {
  HttpRequest request = lab_.request("GET", "/api/me");
  request.headers[0].second = "evil.example";
  EXPECT_EQ(lab_.send(request).status, 421);
  request.path = "/";
  EXPECT_EQ(lab_.send(request).status, 421) << "the page, too";
}

TEST_F(Interface, RequestsOfOneAddressAreLimited) {
  lab_.address = "192.0.2.77";
  int answered = 0;
  while (answered < 2000 && lab_.get("/api/health").status == 204) ++answered;
  EXPECT_EQ(answered, 600);
  EXPECT_EQ(header_of(lab_.get("/api/health"), "Retry-After"), "1");
  lab_.address = "192.0.2.78";
  EXPECT_EQ(lab_.get("/api/health").status, 204);
}

class Questionnaire : public Interface {
 protected:
  Json add_form() {
    const HttpAnswer answer = lab_.post("/api/forms", {{"title", kHostile}});
    EXPECT_EQ(answer.status, 201) << body_of(answer);
    return json_of(answer);
  }
  int submit(const Json& form, const Json& answers) {
    HttpRequest request = lab_.request("POST", "/api/public/forms/" + form["token"].get<std::string>() + "/answers",
                                       {{"answers", answers}});
    std::erase_if(request.headers, [](const auto& h) { return h.first == "Cookie" || h.first == "X-CSRF-Token"; });
    return lab_.send(request).status;
  }
};

TEST_F(Questionnaire, StandardFormUsesThePageLanguage) {
  const Json english = json_of(lab_.post("/api/forms", Json::object()));
  EXPECT_EQ(json_of(lab_.post("/api/forms", {{"language", "en"}}))["title"], english["title"]);
  const Json german = json_of(lab_.post("/api/forms", {{"language", "de"}}));
  EXPECT_EQ(german["title"], "Ihre Meinung zum Punktionssimulator");
  ASSERT_EQ(german["items"].size(), english["items"].size());
  EXPECT_NE(german["intro"], english["intro"]);
  for (std::size_t n = 0; n < german["items"].size(); ++n)
    EXPECT_NE(german["items"][n]["text"], english["items"][n]["text"]);
  EXPECT_EQ(lab_.post("/api/forms", {{"language", "xx"}}).status, 400);
  EXPECT_EQ(lab_.post("/api/forms", {{"language", "../de"}}).status, 400);
}

TEST_F(Questionnaire, AcceptsAnswersWithoutALogin) {
  const Json form = add_form();
  ASSERT_EQ(form["items"].size(), 5U) << "the default: four statements and a free text";
  const std::string token = form["token"].get<std::string>();
  ServiceLab* lab = &lab_;
  const std::string cookie = std::exchange(lab->cookie, "");
  const Json shown = get("/api/public/forms/" + token);
  lab->cookie = cookie;
  EXPECT_EQ(shown["title"], kHostile);
  EXPECT_FALSE(shown.contains("id"));
  EXPECT_FALSE(shown.contains("responses"));
  Json answers = Json::object();
  for (const Json& item : shown["items"])
    answers[item["id"].get<std::string>()] = item["kind"] == "scale" ? Json(1) : Json(kHostile);
  EXPECT_EQ(submit(form, answers), 201);
  for (auto& [item, value] : answers.items())
    if (value.is_number()) value = 4;
  EXPECT_EQ(submit(form, answers), 201);
  const Json summary = get("/api/forms/" + form["id"].get<std::string>() + "/summary");
  EXPECT_EQ(summary["responses"], 2);
  EXPECT_EQ(summary["items"][0]["mean"], 2.5);
  EXPECT_EQ(summary["items"][0]["counts"], (Json{1, 0, 0, 1, 0, 0}));
  EXPECT_EQ(summary["items"][4]["comments"][0]["text"], kHostile);
}

TEST_F(Questionnaire, BadAnswersNameTheItem) {
  const Json form = add_form();
  Json answers = Json::object();
  for (const Json& item : form["items"])
    if (item["kind"] == "scale") answers[item["id"].get<std::string>()] = 3;
  const std::string first = form["items"][0]["id"].get<std::string>();
  for (const Json& bad :
       {Json(0), Json(7), Json(-1), Json(2.5), Json("3"), Json(true), Json::array({3}), Json(1e300)}) {
    Json with_bad = answers;
    with_bad[first] = bad;
    EXPECT_EQ(submit(form, with_bad), 400) << bad;
  }
  Json unknown = answers;
  unknown["nonsense"] = 3;
  EXPECT_EQ(submit(form, unknown), 400);
  Json long_text = answers;
  long_text[form["items"][4]["id"].get<std::string>()] = std::string(2001, 'x');
  EXPECT_EQ(submit(form, long_text), 400);
  EXPECT_EQ(submit(form, Json::array()), 400);
  EXPECT_EQ(get("/api/forms/" + form["id"].get<std::string>() + "/summary")["responses"], 0);
  EXPECT_EQ(submit(form, answers), 201);
}

TEST_F(Questionnaire, MisspeltFieldsAreRefusedAndNamed) {
  const Json item = {{"kind", "scale"}, {"text", "Useful?"}, {"is_required", true}};
  Json misspelt = item;
  misspelt["required"] = true;
  for (const Json& body : {Json{{"titel", "x"}}, Json{{"title", "x"}, {"lang", "en"}},
                           Json{{"items", Json::array({misspelt})}}, Json{{"items", Json::array({Json::array()})}}}) {
    const HttpAnswer answer = lab_.post("/api/forms", body);
    EXPECT_EQ(answer.status, 400) << body;
  }
  EXPECT_NE(body_of(lab_.post("/api/forms", {{"titel", "x"}})).find("titel"), std::string::npos);
  EXPECT_EQ(lab_.post("/api/forms", {{"items", Json::array({item})}}).status, 201);
}

/// The limits of the page's fields are those of the server, in characters of any script.
TEST_F(Questionnaire, LimitsTheIntroductionLikeThePage) {
  const auto of = [](std::size_t characters) {
    std::string text;
    while (characters-- > 0) text += "\xe9\x87\x9d";
    return text;
  };
  EXPECT_EQ(lab_.post("/api/forms", {{"intro", of(2000)}}).status, 201);
  EXPECT_EQ(lab_.post("/api/forms", {{"intro", of(2001)}}).status, 400);
}

TEST_F(Questionnaire, AnswersAlikeWhenClosedOrUnknown) {
  const Json form = add_form();
  const std::string id = form["id"].get<std::string>(),
                    address = "/api/public/forms/" + form["token"].get<std::string>();
  EXPECT_EQ(lab_.send(lab_.request("PUT", "/api/forms/" + id, {{"is_open", false}})).status, 200);
  EXPECT_EQ(lab_.get(address).status, 404);
  EXPECT_EQ(body_of(lab_.get(address)), body_of(lab_.get("/api/public/forms/unknown")));
  EXPECT_EQ(submit(form, Json::object()), 404);
  EXPECT_EQ(lab_.send(lab_.request("DELETE", "/api/forms/" + id)).status, 204);
  EXPECT_EQ(lab_.send(lab_.request("DELETE", "/api/forms/" + id)).status, 404);
}

TEST_F(Questionnaire, AnswersOfOneAddressAreLimited) {
  const Json form = add_form();
  int answered = 0;
  while (answered < 1000 && submit(form, Json::object()) != 429) ++answered;
  EXPECT_EQ(answered, 60);
}

}  // namespace
}  // namespace trocar::web
