// People, courses, PINs, notes and passwords of others are changed over the interface.
#include <gtest/gtest.h>

#include <utility>

#include "results/accounts.h"
#include "results/notes.h"
#include "service_lab.h"

namespace trocar::web {
namespace {

using namespace testing;

class PeopleChange : public ::testing::Test {
 protected:
  void SetUp() override { lab_.log_in(kInstructor); }
  HttpAnswer send(const std::string& method, const std::string& target, const Json& body) {
    return lab_.send(lab_.request(method, target, body));
  }
  Json person(const std::string& name) {
    const Json overview = json_of(lab_.get("/api/overview"));
    for (const Json& one : overview["people"])
      if (one["name"] == name) return one;
    return {};
  }
  ServiceLab lab_;
};

TEST_F(PeopleChange, AddsRenamesAndMovesAPersonAtOnce) {
  const HttpAnswer added =
      lab_.post("/api/people", {{"name", " Anna  Meier "}, {"group", "trainee"}, {"course", "Spring"}});
  ASSERT_EQ(added.status, 201) << body_of(added);
  EXPECT_EQ(json_of(added)["name"], "Anna Meier");
  const std::string id = json_of(added)["id"].get<std::string>(), target = "/api/people/" + id;
  EXPECT_EQ(person("Anna Meier")["course"], "Spring");
  EXPECT_EQ(lab_.post("/api/people", {{"name", "ANNA Meier"}, {"group", "trainee"}}).status, 409);
  EXPECT_EQ(send("PUT", target, {{"name", "Anna Huber"}, {"group", "expert"}, {"course", "Autumn"}}).status, 200);
  const Json changed = person("Anna Huber");
  EXPECT_EQ(changed["group"], "expert");
  EXPECT_EQ(changed["course"], "Autumn");
  EXPECT_EQ(changed["id"], id);
  EXPECT_EQ(send("PUT", target, {{"course", ""}}).status, 200);
  EXPECT_EQ(person("Anna Huber")["course"], nullptr);
  EXPECT_EQ(person("Anna Huber")["group"], "expert") << "what is not named stays";
}

TEST_F(PeopleChange, IsAtomic) {
  const auto anna = lab_.add_person("Anna");
  lab_.add_person("Ben");
  const std::string target = "/api/people/" + anna.id;
  EXPECT_EQ(send("PUT", target, {{"name", "ben"}, {"group", "expert"}}).status, 409);
  EXPECT_EQ(send("PUT", target, {{"name", "Cleo"}, {"course", "a\nb"}}).status, 400);
  EXPECT_EQ(send("PUT", target, {{"group", "professor"}}).status, 400);
  EXPECT_EQ(send("PUT", target, {{"simulated", true}}).status, 400);
  EXPECT_EQ(person("Anna")["group"], "trainee");
  EXPECT_EQ(person("Anna")["course"], nullptr);
  EXPECT_EQ(send("PUT", "/api/people/" + std::string(32, '0'), {{"name", "Nobody"}}).status, 404);
  EXPECT_EQ(send("PUT", "/api/people/x", {{"name", "Nobody"}}).status, 404);
  for (const Json& bad : {Json{{"name", ""}, {"group", "trainee"}}, Json{{"name", "Dora"}}, Json{{"group", "expert"}},
                          Json{{"name", "Dora"}, {"group", "trainee"}, {"course", "x\ty"}}})
    EXPECT_EQ(lab_.post("/api/people", bad).status, 400) << bad;
}

TEST_F(PeopleChange, GroupChangeUpdatesStatisticsOfOthersAtOnce) {
  const auto anna = lab_.add_person("Anna"), ben = lab_.add_person("Ben");
  lab_.add_attempt(anna, 90.0);
  lab_.add_attempt(ben, 50.0);
  const std::string curve = "/api/people/" + ben.id + "/curve?task=liver-biopsy";
  EXPECT_EQ(json_of(lab_.get(curve))["peers"]["n"], 1);
  EXPECT_EQ(send("PUT", "/api/people/" + anna.id, {{"group", "expert"}}).status, 200);
  EXPECT_EQ(json_of(lab_.get(curve))["peers"]["n"], 0);
  EXPECT_EQ(json_of(lab_.get(curve))["experts"]["n"], 1);
}

TEST_F(PeopleChange, MovesSeveralPeopleAtomically) {
  const auto anna = lab_.add_person("Anna"), ben = lab_.add_person("Ben");
  const auto move = [&](const Json& people) {
    return lab_.post("/api/people/move", {{"people", people}, {"course", "Spring"}}).status;
  };
  EXPECT_EQ(move({anna.id, std::string(32, '0')}), 400);
  EXPECT_EQ(person("Anna")["course"], nullptr);
  for (const Json& bad : {Json::array(), Json("x"), Json{1}, Json{"x"}, Json(nullptr)})
    EXPECT_EQ(move(bad), 400) << bad;
  EXPECT_EQ(move({anna.id, ben.id}), 204);
  EXPECT_EQ(person("Anna")["course"], "Spring");
  EXPECT_EQ(person("Ben")["course"], "Spring");
}

TEST_F(PeopleChange, RenamesCoursesAndRemovesEmptyOnes) {
  const auto anna = lab_.add_person("Anna"), ben = lab_.add_person("Ben");
  EXPECT_EQ(send("PUT", "/api/people/" + anna.id, {{"course", "Spring/2026 1.0"}}).status, 200);
  EXPECT_EQ(send("PUT", "/api/people/" + ben.id, {{"course", "Autumn"}}).status, 200);
  EXPECT_EQ(send("PUT", "/api/courses", {{"name", "Spring/2026 1.0"}, {"new_name", "autumn"}}).status, 400);
  EXPECT_EQ(send("PUT", "/api/courses", {{"name", "Winter"}, {"new_name", "W"}}).status, 400);
  EXPECT_EQ(send("PUT", "/api/courses", {{"name", "spring/2026 1.0"}, {"new_name", "Spring"}}).status, 204);
  EXPECT_EQ(person("Anna")["course"], "Spring");
  EXPECT_EQ(send("DELETE", "/api/courses", {{"name", "Spring"}}).status, 400) << "Anna is in it";
  EXPECT_EQ(send("PUT", "/api/people/" + anna.id, {{"course", "Autumn"}}).status, 200);
  EXPECT_EQ(send("DELETE", "/api/courses", {{"name", "Spring"}}).status, 204);
  const Json courses = json_of(lab_.get("/api/overview"))["courses"];
  ASSERT_EQ(courses.size(), 1U) << courses;
  EXPECT_EQ(courses[0]["name"], "Autumn");
}

TEST_F(PeopleChange, SetsAndRemovesAPinWithoutSendingIt) {
  const auto anna = lab_.add_person("Anna");
  const std::string target = "/api/people/" + anna.id + "/pin";
  for (const char* bad : {"123", "12a4", "1234567890123"})
    EXPECT_EQ(send("PUT", target, {{"pin", bad}}).status, 400) << bad;
  EXPECT_EQ(person("Anna")["has_pin"], false);
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(send("PUT", target, {{"pin", "4711"}}).status, 204);
  const std::string log = ::testing::internal::GetCapturedStderr();
  EXPECT_EQ(log.find("4711"), std::string::npos) << log;
  EXPECT_EQ(log.find("Anna"), std::string::npos) << log;
  EXPECT_EQ(person("Anna")["has_pin"], true);
  EXPECT_EQ(results::check_pin(lab_.repository(), anna.id, "4711", lab_.now.utc), results::PinCheck::kRight);
  EXPECT_EQ(send("PUT", target, {{"pin", ""}}).status, 204);
  EXPECT_EQ(person("Anna")["has_pin"], false);
  EXPECT_EQ(send("PUT", "/api/people/" + std::string(32, '0') + "/pin", {{"pin", "4711"}}).status, 404);
}

TEST_F(PeopleChange, OnlyAdminsCanRequirePins) {
  EXPECT_EQ(json_of(lab_.get("/api/pins"))["required"], false);
  EXPECT_EQ(send("PUT", "/api/pins", {{"required", true}}).status, 403);
  lab_.cookie.clear();
  lab_.csrf.clear();
  lab_.log_in();
  EXPECT_EQ(send("PUT", "/api/pins", {{"required", 1}}).status, 400);
  EXPECT_EQ(send("PUT", "/api/pins", {{"required", true}}).status, 200);
  EXPECT_EQ(results::are_pins_required(lab_.repository()), true);
}

TEST_F(PeopleChange, NotesHaveAnAuthorATimeAndDeleteRights) {
  const auto anna = lab_.add_person("Anna");
  const std::string attempt = lab_.add_attempt(anna, 50.0), target = "/api/attempts/" + attempt;
  EXPECT_EQ(json_of(lab_.get(target))["notes"], Json::array());
  const std::string text = "Held the probe <b>too steep</b>.\nRepeat with ä.";
  const HttpAnswer added = lab_.post(target + "/notes", {{"text", "  " + text + "\n"}});
  ASSERT_EQ(added.status, 201) << body_of(added);
  const Json notes = json_of(lab_.get(target))["notes"];
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(notes[0]["text"], text);
  EXPECT_EQ(notes[0]["author"], kInstructor);
  EXPECT_EQ(notes[0]["written_s"], lab_.now.utc.time_since_epoch().count());
  EXPECT_EQ(json_of(lab_.get("/api/people/" + anna.id + "/attempts"))["attempts"][0]["notes"], 1);
  std::string longest;
  for (int n = 0; n < 2000; ++n) longest += "\xe9\x87\x9d";
  EXPECT_EQ(lab_.post(target + "/notes", {{"text", longest}}).status, 201) << "of any script";
  for (const std::string& bad : {std::string(), std::string(" \n"), longest + "x", std::string("a\x01")})
    EXPECT_EQ(lab_.post(target + "/notes", {{"text", bad}}).status, 400);
  EXPECT_EQ(lab_.post("/api/attempts/" + std::string(32, '0') + "/notes", {{"text", "x"}}).status, 404);

  const std::string csv = body_of(lab_.get("/api/export/notes.csv"));
  EXPECT_NE(csv.find(attempt), std::string::npos) << csv;
  EXPECT_NE(csv.find("too steep"), std::string::npos);

  const auto by_another = results::add_note(lab_.repository(), attempt, kAdmin, "mine", lab_.now.utc);
  EXPECT_EQ(send("DELETE", "/api/notes/" + by_another->id, {}).status, 403) << "of another account";
  EXPECT_EQ(send("DELETE", "/api/notes/" + notes[0]["id"].get<std::string>(), {}).status, 204);
  EXPECT_EQ(send("DELETE", "/api/notes/" + std::string(32, '0'), {}).status, 404);
  EXPECT_EQ(json_of(lab_.get(target))["notes"].size(), 2U);
  EXPECT_EQ(body_of(lab_.get("/api/export/notes.csv?course=nobody's")).find(attempt), std::string::npos);
}

TEST_F(PeopleChange, ListShowsWhyAnAttemptDidNotPass) {
  const auto anna = lab_.add_person("Anna");
  lab_.add_attempt(anna, 90.0);
  results::AttemptRecord record;
  record.attempt.id = results::make_id();
  record.attempt.person_id = anna.id;
  record.attempt.the_case = {"liver-biopsy", "biopsy-1", 1, "hash", 1};
  record.attempt.state = results::State::kFinished;
  record.attempt.score = 71.0;
  record.fails = {"the needle went 12 mm into the colon"};
  ASSERT_TRUE(results::record_attempt(lab_.repository(), record, {}));
  record.attempt.id = results::make_id();
  record.attempt.score.reset();
  record.fails.clear();
  record.not_scored = "the gun was not fired";
  record.measures = {{"skin_punctures", "1", 1.0}};
  ASSERT_TRUE(results::record_attempt(lab_.repository(), record, {}));
  const Json list = json_of(lab_.get("/api/people/" + anna.id + "/attempts"))["attempts"];
  ASSERT_EQ(list.size(), 3U);
  EXPECT_EQ(list[0]["not_scored"], "the gun was not fired");
  EXPECT_EQ(list[1]["fails"], Json::array({"the needle went 12 mm into the colon"}));
  EXPECT_EQ(list[1]["score"], 71.0);
  EXPECT_EQ(list[2]["fails"], Json::array());
  EXPECT_EQ(list[2]["not_scored"], nullptr);
}

TEST(Password, AdminResetsAnotherAccountsPassword) {
  ServiceLab lab;
  lab.log_in(kInstructor);
  const std::string cookie = std::exchange(lab.cookie, ""), csrf = std::exchange(lab.csrf, "");
  lab.log_in();
  const auto reset = [&](const std::string& name, const std::string& password) {
    return lab.send(lab.request("PUT", "/api/accounts/" + name + "/password", {{"password", password}})).status;
  };
  EXPECT_EQ(reset("nobody", "seven quiet otters"), 404);
  EXPECT_EQ(reset("hub%65", "seven quiet otters"), 404);
  EXPECT_EQ(reset("hub%2", "seven quiet otters"), 400) << "malformed";
  EXPECT_EQ(reset("huber", "short"), 400);
  EXPECT_EQ(reset("huber", "Huber Huber Huber"), 400);
  EXPECT_EQ(reset("Dr. Weber", "seven quiet otters"), 400) << "the own one needs the current password";
  EXPECT_EQ(reset("%68uber", "seven quiet otters"), 204) << "the name is decoded";
  const std::string admin_cookie = std::exchange(lab.cookie, cookie), admin_csrf = std::exchange(lab.csrf, csrf);
  EXPECT_EQ(lab.get("/api/me").status, 401) << "the logins of the account end at once";
  lab.cookie = admin_cookie;
  EXPECT_EQ(lab.get("/api/me").status, 200);
  lab.cookie.clear();
  lab.csrf.clear();
  EXPECT_EQ(lab.log_in(kInstructor).status, 401);
  EXPECT_EQ(lab.log_in(kInstructor, "seven quiet otters").status, 200);
}

}  // namespace
}  // namespace trocar::web
